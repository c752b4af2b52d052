kernel void warp(global const float* points, global const float* normals, int point_count,
                 global const int* nodes, global const float* weights, int per_point,
                 global const float* node_points, global const float* affine, global float* moved_points,
                 global float* moved_normals) {
  const int i = get_global_id(0);
  if (i >= point_count) return;
  const float3 p = vload3(i, points);
  float3 displacement = 0;
  float3 c1 = (float3)(1, 0, 0), c2 = (float3)(0, 1, 0), c3 = (float3)(0, 0, 1);
  for (int slot = 0; slot < per_point; ++slot) {
    const int node = nodes[i * per_point + slot];
    const float weight = weights[i * per_point + slot];
    const float3 arm = p - vload3(node, node_points);
    const float3 d1 = vload3(4 * node, affine), d2 = vload3(4 * node + 1, affine);
    const float3 d3 = vload3(4 * node + 2, affine), t = vload3(4 * node + 3, affine);
    displacement += weight * (arm.x * d1 + arm.y * d2 + arm.z * d3 + t);
    c1 += weight * d1;
    c2 += weight * d2;
    c3 += weight * d3;
  }
  vstore3(p + displacement, i, moved_points);

  const float3 n = vload3(i, normals);
  const float3 turned = n.x * cross(c2, c3) + n.y * cross(c3, c1) + n.z * cross(c1, c2);
  const float length_squared = dot(turned, turned);
  vstore3(length_squared > 0 && isfinite(length_squared) ? turned * rsqrt(length_squared) : (float3)(0), i,
          moved_normals);
}
