// Arms of constraints: how far each slot's node moves the point, w (p - g, 1). Slots beyond `per_point`, up
// to `per_instance`, are empty.
kernel void lever_arms_of_constraints(global const float* points, int count, int per_point,
                                      global const int* nodes, global const float* weights,
                                      global const float* node_points, int first, int per_instance,
                                      global float4* lever_arms) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const float3 p = vload3(i, points);
  for (int slot = 0; slot < per_instance; ++slot) {
    float4 lever_arm = 0;
    if (slot < per_point) {
      const int at = i * per_point + slot;
      lever_arm = weights[at] * (float4)(p - vload3(nodes[at], node_points), 1);
    }
    lever_arms[(first + i) * per_instance + slot] = lever_arm;
  }
}
