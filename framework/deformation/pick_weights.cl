// The weights of some points, one a work-item; `per_point` of each.
kernel void pick_weights(int count, int per_point, global const int* points, global const float* weights,
                         global float* picked) {
  const int i = get_global_id(0);
  if (i < count) picked[i] = weights[points[i / per_point] * per_point + i % per_point];
}
