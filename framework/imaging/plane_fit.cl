// Points and normals [thesis 3.1] by planes fitted to windows; compiled behind depth_map.cl and plane.cl.

// The plane through the points of the window whose depth is near that of the centre, which has depth `z` on
// the rays (ray.x, ray.y, 1); neighbouring rays are `pixel` apart.
Vector window_normal(global const float* centre, int stride, int radius, float depth_step, Lanes z,
                     Lanes ray_x, Lanes ray_y, float2 pixel) {
  Lanes count = 0;
  Vector sum = {0, 0, 0};  // relative to the centre, so that nothing cancels
  Symmetric squares = {0, 0, 0, 0, 0, 0};
  for (int dv = -radius; dv <= radius; ++dv) {
    for (int du = -radius; du <= radius; ++du) {
      const Lanes depth = LOAD(centre + dv * stride + du);
      const Lanes taken = WHERE(fabs(depth - z) < (Lanes)depth_step, (Lanes)1);
      const Lanes dz = taken * (depth - z);
      const Lanes taken_depth = taken * depth;
      const Lanes dx = ray_x * dz + (du * pixel.x) * taken_depth;
      const Lanes dy = ray_y * dz + (dv * pixel.y) * taken_depth;
      count += taken;
      sum.x += dx;
      sum.y += dy;
      sum.z += dz;
      squares.xx += dx * dx;
      squares.xy += dx * dy;
      squares.xz += dx * dz;
      squares.yy += dy * dy;
      squares.yz += dy * dz;
      squares.zz += dz * dz;
    }
  }
  const Vector mean = scaled(sum, 1.0f / count);
  // The scale of a covariance does not change its eigenvectors: these are `count` times its entries.
  const Symmetric spread = {squares.xx - sum.x * mean.x, squares.xy - sum.x * mean.y,
                            squares.xz - sum.x * mean.z, squares.yy - sum.y * mean.y,
                            squares.yz - sum.y * mean.z, squares.zz - sum.z * mean.z};
  return only(count >= (Lanes)FEWEST_POINTS, plane_normal(spread));
}

// Whether a pixel with depth `z` still has no normal, or one that the points of a single line made up.
Truth is_undetermined(Vector normal, Vector ray, Lanes z) {
  return HAS_DEPTH(z) && fabs(inner(normal, ray)) < (Lanes)EDGE_ON;
}

// Points and unit normals, x y z a pixel, without the halo. camera: fx, fy, cx, cy; corner: the pixel of its
// image at which the map begins.
kernel void surface(global const float* depth, int stride, int2 size, int2 corner, float4 camera, int radius,
                    float depth_step, global float* points, global float* normals) {
  const int vectors = (size.x + WIDTH - 1) / WIDTH;
  const int v = get_global_id(0) / vectors;
  const int u = (get_global_id(0) - v * vectors) * WIDTH;
  if (v >= size.y) return;
  global const float* centre = depth + (v + HALO) * stride + u + HALO;
  const Lanes z = LOAD(centre);
  Vector point = {0, 0, 0}, normal = {0, 0, 0};
  if (ANY_DEPTH(z)) {
    const float2 pixel = 1.0f / camera.xy;
    const Vector ray = ray_through(u, v, corner, camera);
    Vector fitted = window_normal(centre, stride, radius, depth_step, z, ray.x, ray.y, pixel);
    Truth is_open = is_undetermined(fitted, ray, z);
    for (int reach = 2 * radius; reach <= WIDEST && ANY(is_open); reach *= 2) {
      const Vector wider = window_normal(centre, stride, reach, depth_step, z, ray.x, ray.y, pixel);
      fitted.x = select(fitted.x, wider.x, is_open);
      fitted.y = select(fitted.y, wider.y, is_open);
      fitted.z = select(fitted.z, wider.z, is_open);
      is_open = is_undetermined(fitted, ray, z);
    }
    fitted = only(!is_open, fitted);
    const Lanes sign = select((Lanes)1, (Lanes)-1, inner(fitted, ray) > (Lanes)0);  // faces the camera
    normal = only(HAS_DEPTH(z), scaled(fitted, sign));
    point = only(HAS_DEPTH(z), scaled(ray, z));
  }
  const int out = 3 * (v * size.x + u);
  store_vectors(point, size.x - u, points + out);
  store_vectors(normal, size.x - u, normals + out);
}
