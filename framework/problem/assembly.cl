// Gathers J^T J ("MM") and J^T r ("MV") [thesis 4.6]. Each 12x12 block, and each node's part of the
// gradient, belongs to one work-item that walks its list of contributions in order: no atomics, the same
// bits every time. Unknown 3 c + a of a node: column c (c = 3: t) along axis a.

kernel void clear(global const int* status, int count, global float* values) {
  const int i = get_global_id(0);
  if (status[0] || i >= count) return;
  values[i] = 0;
}

// Entries of the lists name an instance and one of its slots (a node), or two for a block: see structure.h.
#define SPREAD(v) (v).xxxxyyyyzzzzwwww
#define TILED(v) (v).xyzwxyzwxyzwxyzw

// A slot of an edge is one of its ends. Nine 4x4 products make a 12x12 one.
kernel void mm_edges(global const int* status, int block_count, int residuals, global const int* starts,
                     global const uint* entries, global const float* rows, global float4* blocks) {
  const int block = get_global_id(0);
  if (status[0] || block >= block_count || starts[block] == starts[block + 1]) return;
  float16 sum[9] = {0, 0, 0, 0, 0, 0, 0, 0, 0};
  for (int e = starts[block]; e < starts[block + 1]; ++e) {
    global const float* J = rows + entries[e] / (SLOTS * SLOTS) * residuals * 25;
    global const float* left = J + 12 * (entries[e] / SLOTS % SLOTS);
    global const float* right = J + 12 * (entries[e] % SLOTS);
    for (int row = 0; row < residuals; ++row, left += 24, right += 24) {
      const float16 r0 = TILED(vload4(0, right)), r1 = TILED(vload4(1, right)), r2 = TILED(vload4(2, right));
#pragma unroll
      for (int g = 0; g < 3; ++g) {
        const float16 l = SPREAD(vload4(g, left));
        sum[3 * g] += l * r0;
        sum[3 * g + 1] += l * r1;
        sum[3 * g + 2] += l * r2;
      }
    }
  }
  global float4* out = blocks + 36 * block;
#pragma unroll
  for (int g = 0; g < 3; ++g)
#pragma unroll
    for (int h = 0; h < 3; ++h) {
      const float16 m = sum[3 * g + h];
      out[12 * g + h] += m.lo.lo;
      out[12 * g + 3 + h] += m.lo.hi;
      out[12 * g + 6 + h] += m.hi.lo;
      out[12 * g + 9 + h] += m.hi.hi;
    }
}

kernel void mv_edges(global const int* status, int node_count, int residuals, global const int* starts,
                     global const uint* entries, global const float* rows, global float* gradient) {
  const int node = get_global_id(0);
  if (status[0] || node >= node_count) return;
  for (int e = starts[node]; e < starts[node + 1]; ++e) {
    global const float* J = rows + entries[e] / SLOTS * residuals * 25;
    for (int row = 0; row < residuals; ++row) {
      const float r = J[24 * residuals + row];
      for (int a = 0; a < 12; ++a) gradient[12 * node + a] += J[24 * row + 12 * (entries[e] % SLOTS) + a] * r;
    }
  }
}

// A constraint's part of block (a, b) is (v_a v_b^T) (x) W with the lever_arms v of its slots: the sixteen
// products v_a v_b^T are one vector, and W has six distinct entries.
kernel void mm_constraints(global const int* status, int block_count, int per_point, global const int* starts,
                           global const uint* entries, global const float* normal,
                           global const float4* lever_arms, global float* blocks) {
  const int block = get_global_id(0);
  if (status[0] || block >= block_count || starts[block] == starts[block + 1]) return;
  float16 xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  for (int e = starts[block]; e < starts[block + 1]; ++e) {
    const uint i = entries[e] / (SLOTS * SLOTS);
    const float4 row = lever_arms[i * per_point + entries[e] / SLOTS % SLOTS];
    const float16 products = SPREAD(row) * TILED(lever_arms[i * per_point + entries[e] % SLOTS]);
    xx += normal[9 * i] * products;
    xy += normal[9 * i + 1] * products;
    xz += normal[9 * i + 2] * products;
    yy += normal[9 * i + 3] * products;
    yz += normal[9 * i + 4] * products;
    zz += normal[9 * i + 5] * products;
  }
  // Row 3 c + axis of the block takes turns through the axes of its columns.
  const float16 sums[9] = {xx, xy, xz, xy, yy, yz, xz, yz, zz};
#pragma unroll
  for (int axis = 0; axis < 3; ++axis) {
    const float16 x = sums[3 * axis], y = sums[3 * axis + 1], z = sums[3 * axis + 2];
    const float4 parts[12] = {x.lo.lo, y.lo.lo, z.lo.lo, x.lo.hi, y.lo.hi, z.lo.hi,
                              x.hi.lo, y.hi.lo, z.hi.lo, x.hi.hi, y.hi.hi, z.hi.hi};
#pragma unroll
    for (int c = 0; c < 4; ++c) {
      const float16 mixed =
          ((float16)(parts[3 * c], parts[3 * c + 1], parts[3 * c + 2], (float4)(0))).s04815926a37bcdef;
      global float* out = blocks + 144 * block + 12 * (3 * c + axis);
      vstore4(vload4(0, out) + mixed.lo.lo, 0, out);
      vstore4(vload4(1, out) + mixed.lo.hi, 1, out);
      vstore4(vload4(2, out) + mixed.hi.lo, 2, out);
    }
  }
}

kernel void mv_constraints(global const int* status, int node_count, int per_point, global const int* starts,
                           global const uint* entries, global const float* normal,
                           global const float4* lever_arms, global float* gradient) {
  const int node = get_global_id(0);
  if (status[0] || node >= node_count) return;
  float3 sum[4];
  for (int c = 0; c < 4; ++c) sum[c] = vload3(4 * node + c, gradient);
  for (int e = starts[node]; e < starts[node + 1]; ++e) {
    const uint i = entries[e] / SLOTS;
    const float4 lever_arm = lever_arms[i * per_point + entries[e] % SLOTS];
    const float3 force = vload3(0, normal + 9 * i + 6);
    sum[0] += lever_arm.x * force;
    sum[1] += lever_arm.y * force;
    sum[2] += lever_arm.z * force;
    sum[3] += lever_arm.w * force;
  }
  for (int c = 0; c < 4; ++c) vstore3(sum[c], 4 * node + c, gradient);
}
