// The affine forms of nodes (see warp.h of framework/deformation) as a rotation of the axes, given by its
// rows, makes them: D' = Q D Q^T, t' = Q t.
kernel void turn_forms(int count, float4 row_x, float4 row_y, float4 row_z, global const float* affine,
                       global float* turned) {
  const int node = get_global_id(0);
  if (node >= count) return;
  float3 q[4];
  for (int column = 0; column < 4; ++column) {
    const float3 c = vload3(4 * node + column, affine);
    q[column] = (float3)(dot(row_x.xyz, c), dot(row_y.xyz, c), dot(row_z.xyz, c));
  }
  vstore3(row_x.x * q[0] + row_x.y * q[1] + row_x.z * q[2], 4 * node, turned);
  vstore3(row_y.x * q[0] + row_y.y * q[1] + row_y.z * q[2], 4 * node + 1, turned);
  vstore3(row_z.x * q[0] + row_z.y * q[1] + row_z.z * q[2], 4 * node + 2, turned);
  vstore3(q[3], 4 * node + 3, turned);
}

// What is wrong with where points move to is taken from where they come from; x y z of each in turn.
kernel void step_back(int count, global const float* wanted, global const float* moved, global float* rest) {
  const int i = get_global_id(0);
  if (i < count) rest[i] += wanted[i] - moved[i];
}
