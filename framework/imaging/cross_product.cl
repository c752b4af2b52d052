// Normals as cross products of differences between neighbouring points; compiled behind depth_map.cl.

// Of a neighbour `reach` pixels away along a direction, 1 where it is on the surface of the centre, else 0.
Lanes is_near(Lanes neighbour, Lanes z, float depth_change) {
  return WHERE(fabs(neighbour - z) <= depth_change * z, (Lanes)1);
}

// From one neighbour to the other, both on the rays centre -+ step.
Vector difference(global const float* centre, int offset, float2 step, Vector ray, Lanes z, float change) {
  const Lanes before = LOAD(centre - offset), after = LOAD(centre + offset);
  const Lanes has_before = is_near(before, z, change), has_after = is_near(after, z, change);
  const Lanes from = select(z, before, has_before > (Lanes)0), to = select(z, after, has_after > (Lanes)0);
  const Lanes along = has_after * to + has_before * from;
  const Vector step_taken = {ray.x * (to - from) + step.x * along, ray.y * (to - from) + step.y * along,
                             to - from};
  return step_taken;
}

kernel void cross_product(global const float* depth, int stride, int2 size, int2 corner, float4 camera,
                          int reach, float depth_change, global float* points, global float* normals) {
  const int vectors = (size.x + WIDTH - 1) / WIDTH;
  const int v = get_global_id(0) / vectors;
  const int u = (get_global_id(0) - v * vectors) * WIDTH;
  if (v >= size.y) return;
  global const float* centre = depth + (v + HALO) * stride + u + HALO;
  const Lanes z = LOAD(centre);
  const Truth has_depth = HAS_DEPTH(z);
  const Vector ray = ray_through(u, v, corner, camera);
  const float2 step = reach / camera.xy;
  const Vector along_row = difference(centre, reach, (float2)(step.x, 0), ray, z, reach * depth_change);
  const Vector along_column =
      difference(centre, reach * stride, (float2)(0, step.y), ray, z, reach * depth_change);
  const Vector normal = outer(along_column, along_row);  // against the ray
  const Lanes square = inner(normal, normal);
  const int out = 3 * (v * size.x + u);
  store_vectors(only(has_depth, scaled(ray, z)), size.x - u, points + out);
  store_vectors(only(has_depth && square > (Lanes)0, scaled(normal, 1.0f / sqrt(square))), size.x - u,
                normals + out);
}
