// Gathers J^T J ("MM") and J^T r ("MV") [thesis 4.6]. Each 12x12 block, and each node's part of the
// gradient, belongs to one work-item that walks its list of contributions in order: no atomics, the same
// bits every time. Unknown 3 c + a of a node: column c (c = 3: t) along axis a.

kernel void clear(global const int* status, int count, global float* values) {
  const int i = get_global_id(0);
  if (status[0] || i >= count) return;
  values[i] = 0;
}

// entries: per contribution the edge and which end of it is the block's row and column (0 from, 1 to).
kernel void mm_edges(global const int* status, int pair_count, int residuals, global const int* starts,
                     global const int* entries, global const float* rows, global float* blocks) {
  const int pair = get_global_id(0);
  if (status[0] || pair >= pair_count) return;
  if (starts[pair] == starts[pair + 1]) return;
  float4 sum[36];
  for (int entry = 0; entry < 36; ++entry) sum[entry] = vload4(36 * pair + entry, blocks);
  for (int entry = starts[pair]; entry < starts[pair + 1]; ++entry) {
    global const float* J = rows + entries[3 * entry] * residuals * 25;
    for (int row = 0; row < residuals; ++row) {
      global const float* left = J + 24 * row + 12 * entries[3 * entry + 1];
      global const float* right = J + 24 * row + 12 * entries[3 * entry + 2];
      const float4 r0 = vload4(0, right), r1 = vload4(1, right), r2 = vload4(2, right);
      for (int a = 0; a < 12; ++a) {
        sum[3 * a] += left[a] * r0;
        sum[3 * a + 1] += left[a] * r1;
        sum[3 * a + 2] += left[a] * r2;
      }
    }
  }
  for (int entry = 0; entry < 36; ++entry) vstore4(sum[entry], 36 * pair + entry, blocks);
}

// entries: per contribution the edge and which end of it is the node.
kernel void mv_edges(global const int* status, int node_count, int residuals, global const int* starts,
                     global const int* entries, global const float* rows, global float* gradient) {
  const int node = get_global_id(0);
  if (status[0] || node >= node_count) return;
  for (int entry = starts[node]; entry < starts[node + 1]; ++entry) {
    global const float* J = rows + entries[2 * entry] * residuals * 25;
    for (int row = 0; row < residuals; ++row) {
      const float r = J[24 * residuals + row];
      for (int a = 0; a < 12; ++a)
        gradient[12 * node + a] += J[24 * row + 12 * entries[2 * entry + 1] + a] * r;
    }
  }
}

// A constraint's part of block (a, b) is w_a w_b (v_a v_b^T) (x) W with v = (p - g, 1): the sixteen
// products v_a v_b^T are one vector, and W has six distinct entries.
// entries: per contribution the constraint and its slots for the block's row and column.
kernel void mm_constraints(global const int* status, int pair_count, global const int* starts,
                           global const int* entries, global const float* normal, global const float* points,
                           int per_point, global const int* nodes, global const float* weights,
                           global const float* node_points, global float* blocks) {
  const int pair = get_global_id(0);
  if (status[0] || pair >= pair_count) return;
  if (starts[pair] == starts[pair + 1]) return;
  float16 sum[6];
  for (int entry = 0; entry < 6; ++entry) sum[entry] = 0;
  for (int entry = starts[pair]; entry < starts[pair + 1]; ++entry) {
    const int i = entries[3 * entry];
    const int slot_a = i * per_point + entries[3 * entry + 1];
    const int slot_b = i * per_point + entries[3 * entry + 2];
    const float3 p = vload3(i, points);
    const float4 v_a = weights[slot_a] * (float4)(p - vload3(nodes[slot_a], node_points), 1);
    const float4 v_b = weights[slot_b] * (float4)(p - vload3(nodes[slot_b], node_points), 1);
    const float16 products = v_a.xxxxyyyyzzzzwwww * v_b.xyzwxyzwxyzwxyzw;
    for (int w = 0; w < 6; ++w) sum[w] += normal[9 * i + w] * products;
  }
  const int place[9] = {0, 1, 2, 1, 3, 4, 2, 4, 5};
  for (int axis_a = 0; axis_a < 3; ++axis_a)
    for (int axis_b = 0; axis_b < 3; ++axis_b) {
      float products[16];
      vstore16(sum[place[3 * axis_a + axis_b]], 0, products);
      for (int c = 0; c < 4; ++c)
        for (int d = 0; d < 4; ++d)
          blocks[144 * pair + 12 * (3 * c + axis_a) + 3 * d + axis_b] += products[4 * c + d];
    }
}

// entries: per contribution the constraint and its slot for the node.
kernel void mv_constraints(global const int* status, int node_count, global const int* starts,
                           global const int* entries, global const float* normal, global const float* points,
                           int per_point, global const float* weights, global const float* node_points,
                           global float* gradient) {
  const int node = get_global_id(0);
  if (status[0] || node >= node_count) return;
  float3 sum[4];
  for (int c = 0; c < 4; ++c) sum[c] = vload3(4 * node + c, gradient);
  const float3 g = vload3(node, node_points);
  for (int entry = starts[node]; entry < starts[node + 1]; ++entry) {
    const int i = entries[2 * entry];
    const float3 force = weights[i * per_point + entries[2 * entry + 1]] * vload3(0, normal + 9 * i + 6);
    const float3 arm = vload3(i, points) - g;
    sum[0] += arm.x * force;
    sum[1] += arm.y * force;
    sum[2] += arm.z * force;
    sum[3] += force;
  }
  for (int c = 0; c < 4; ++c) vstore3(sum[c], 4 * node + c, gradient);
}
