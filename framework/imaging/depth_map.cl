// Kernels over depth maps. A map is an image of floats in rows of `stride`, ringed by a HALO of pixels
// without depth, so that a window around any pixel is read without a bounds check. Where there is no depth
// stands NO_DEPTH, so far away that no neighbour within reach of a surface is ever mixed with it. Work-items
// are written over vectors of WIDTH pixels of a row; compiled behind lanes.cl.

#define HAS_DEPTH(depth) ((depth) < (Lanes)NO_DEPTH)
#define ANY_DEPTH(depth) ANY(HAS_DEPTH(depth))

// --- Bilateral filter [Eq. 3.1] ---

// exp2 for 0 >= x, relative error below 2e-5: vectors of the driver's own exp2 are many times slower.
Lanes exp2_of_negative(Lanes x) {
#if WIDTH == 1
  return native_exp2(x);
#else
  const Lanes shift = 12582912.0f;  // 1.5 * 2^23: adding it rounds to whole numbers, left in the low bits
  const Lanes clamped = fmax(x, (Lanes)-126.0f);
  const Lanes shifted = clamped + shift;
  const Lanes f = clamped - (shifted - shift);  // -1/2 .. 1/2
  const Lanes power = 1.0f + f * (0.6931472f + f * (0.2402265f + f * (0.05550411f + f * 0.009618129f)));
  return as_float16(as_int16(power) + (as_int16(shifted) << 23));
#endif
}

// `steps`: -log2 of the spatial weight of each pixel of the window, row by row. `sharpness`:
// log2(e) / (2 sigma_c^2). Writes the whole map, halo included.
kernel void bilateral(global const float* depth, int stride, int2 size, int radius, constant float* steps,
                      float sharpness, global float* filtered) {
  const int start = get_global_id(0) * WIDTH;
  if (start >= stride * (size.y + 2 * HALO)) return;
  const Lanes centre = LOAD(depth + start);
  if (!ANY_DEPTH(centre)) {
    STORE(centre, filtered + start);
    return;
  }
  Lanes sum = 0, weights = 0;
  for (int dv = -radius; dv <= radius; ++dv) {
    global const float* row = depth + start + dv * stride;
    constant float* row_steps = steps + (dv + radius) * (2 * radius + 1) + radius;
    for (int du = -radius; du <= radius; ++du) {
      const Lanes difference = LOAD(row + du) - centre;
      const Lanes weight = exp2_of_negative(-row_steps[du] - sharpness * difference * difference);
      sum += weight * difference;
      weights += weight;
    }
  }
  STORE(select(centre, centre + sum / weights, HAS_DEPTH(centre)), filtered + start);
}

// --- Points and normals [thesis 3.1] ---

typedef struct {
  Lanes xx, xy, xz, yy, yz, zz;
} Symmetric;

Vector times(Symmetric a, Vector v) {
  const Vector product = {a.xx * v.x + a.xy * v.y + a.xz * v.z, a.xy * v.x + a.yy * v.y + a.yz * v.z,
                          a.xz * v.x + a.yz * v.y + a.zz * v.z};
  return product;
}

Symmetric adjugate(Symmetric a) {
  const Symmetric adj = {a.yy * a.zz - a.yz * a.yz, a.xz * a.yz - a.xy * a.zz, a.xy * a.yz - a.xz * a.yy,
                         a.xx * a.zz - a.xz * a.xz, a.xy * a.xz - a.xx * a.yz, a.xx * a.yy - a.xy * a.xy};
  return adj;
}

// The smallest root of r^3 - r^2 + c1 r - c0, all of whose roots are real and not negative: Laguerre's
// iteration climbs to it from 0 and never passes it.
Lanes smallest_root(Lanes c1, Lanes c0) {
  Lanes root = 0;
  for (int round = 0; round < 4; ++round) {
    const Lanes value = ((root - 1.0f) * root + c1) * root - c0;
    const Lanes slope = (3.0f * root - 2.0f) * root + c1;
    const Lanes bend = 6.0f * root - 2.0f;
    const Lanes spread = sqrt(fmax(4.0f * slope * slope - 6.0f * value * bend, (Lanes)0));
    root -= 3.0f * fmin(value, (Lanes)0) / fmax(slope + spread, (Lanes)1e-20f);
  }
  return root;
}

// A vector along the eigenvector of `a` whose eigenvalue is nearest to `value`, by inverse iteration: the
// column of the adjugate of a - value I that has the largest entry on the diagonal.
Vector eigenvector_near(Symmetric a, Lanes value) {
  a.xx -= value;
  a.yy -= value;
  a.zz -= value;
  const Symmetric adj = adjugate(a);
  const Lanes x = fabs(adj.xx), y = fabs(adj.yy), z = fabs(adj.zz), larger = fmax(x, y);
  const Vector column = {select(select(adj.xx, adj.xy, y > x), adj.xz, z > larger),
                         select(select(adj.xy, adj.yy, y > x), adj.yz, z > larger),
                         select(select(adj.xz, adj.yz, y > x), adj.zz, z > larger)};
  return column;
}

// Unit normal of the plane through points with this covariance; (0, 0, 0) where they lie on a line.
Vector plane_normal(Symmetric covariance) {
  const Lanes scale = 1.0f / fmax(covariance.xx + covariance.yy + covariance.zz, (Lanes)1e-30f);
  const Symmetric a = {covariance.xx * scale, covariance.xy * scale, covariance.xz * scale,
                       covariance.yy * scale, covariance.yz * scale, covariance.zz * scale};
  const Symmetric adj = adjugate(a);
  const Lanes minors = adj.xx + adj.yy + adj.zz;
  const Lanes determinant = a.xx * adj.xx + a.xy * adj.xy + a.xz * adj.xz;
  const Vector rough = eigenvector_near(a, smallest_root(minors, determinant));
  // Rounding of the determinant blurs the root of elongated windows; the Rayleigh quotient does not.
  const Lanes quotient = inner(rough, times(a, rough)) / fmax(inner(rough, rough), (Lanes)1e-30f);
  const Vector normal = eigenvector_near(a, quotient);
  const Lanes length = sqrt(inner(normal, normal));
  return only(minors > (Lanes)FLATTEST && length > (Lanes)0, scaled(normal, 1.0f / length));
}

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
    const Lanes ray_x = ((Lanes)(corner.x + u - camera.z) + LANE_OFFSETS) * pixel.x;
    const Lanes ray_y = (corner.y + v - camera.w) * pixel.y;
    const Vector ray = {ray_x, ray_y, 1};
    Vector fitted = window_normal(centre, stride, radius, depth_step, z, ray_x, ray_y, pixel);
    Truth is_open = is_undetermined(fitted, ray, z);
    for (int reach = 2 * radius; reach <= WIDEST && ANY(is_open); reach *= 2) {
      const Vector wider = window_normal(centre, stride, reach, depth_step, z, ray_x, ray_y, pixel);
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
