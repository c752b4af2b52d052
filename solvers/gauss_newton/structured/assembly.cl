// J^T J and J^T r out of the contributions of the instances: each node gathers its own in a fixed order.
// Terms of constraints that couple the axes (COUPLED) are never put into a matrix but for their diagonal
// blocks.

// Block row `node` of M from one kind of instances.
static inline void add_block_row(int node, const int k, Instances kind, global const ushort* places,
                                 global float16* row, float16* diagonal) {
  for (int e = kind.starts[node]; e < kind.starts[node + 1]; ++e) {
    const int first = kind.entries[e] / SLOTS * k;
    const float weight = kind.contributions[kind.entries[e] / SLOTS].w;
    if (weight == 0) continue;
    const float16 left = TILED(weight * kind.lever_arms[first + kind.entries[e] % SLOTS]);
    for (int slot = 0; slot < k; ++slot) {
      const float16 product = SPREAD(kind.lever_arms[first + slot]) * left;
      const int place = places[e * k + slot];
      if (place == 0)
        *diagonal += product;
      else
        row[place] += product;
    }
  }
}

// Adds what an entry of a node's list contributes to its J^T r.
static inline float16 add_contribution(Instances kind, const int k, uint entry,
                                       global const float4* contributions, float16 sum) {
  const uint instance = entry / SLOTS;
  return sum + SPREAD(contributions[instance]) * TILED(kind.lever_arms[instance * k + entry % SLOTS]);
}

// J^T r of one node, as (row x, y, z, nothing), added to `gradient`.
static inline float16 add_contributions(int node, const int k, Instances kind,
                                        global const float4* contributions, float16 gradient) {
  const int end = kind.starts[node + 1];
  float16 others = 0;  // two sums, because one would wait for itself
  for (int e = kind.starts[node]; e < end; e += 2) {
    gradient = add_contribution(kind, k, kind.entries[e], contributions, gradient);
    if (e + 1 < end) others = add_contribution(kind, k, kind.entries[e + 1], contributions, others);
  }
  return gradient + others;
}

// What the rows of by_node move an instance by.
static inline float3 moved_by(int instance, const int k, Instances kind, global const float16* by_node) {
  float16 products = 0;
  for (int slot = k * instance; slot < k * (instance + 1); ++slot)
    products += TILED(kind.lever_arms[slot]) * by_node[kind.nodes[slot]];
  return ((products.s048c + products.s159d) + (products.s26ae + products.s37bf)).xyz;
}

// M and J^T r of all that separates: each node gathers its own in a fixed order.
kernel void assemble(global const int* status, int padded, ARGUMENTS_OF_INSTANCES(edges),
                     global const ushort* places_edges, ARGUMENTS_OF_INSTANCES(constraints),
                     global const ushort* places_constraints, global const int* row_starts, global float16* M,
                     global float16* gradient) {
  const int node = get_global_id(0);
  if (status[0] || node >= padded) return;
  const Instances edges = INSTANCES(edges), constraints = INSTANCES(constraints);
  global float16* row = M + row_starts[node];
  for (int place = 1; place < row_starts[node + 1] - row_starts[node]; ++place) row[place] = 0;
  float16 diagonal = 0;
  add_block_row(node, 2, edges, places_edges, row, &diagonal);
  add_block_row(node, K, constraints, places_constraints, row, &diagonal);
  row[0] = diagonal;
  const float16 sum = add_contributions(node, 2, edges, edges.contributions, 0);
  gradient[node] = add_contributions(node, K, constraints, constraints.contributions, sum);
}

#if COUPLED
// The diagonal blocks and J^T r of the rows that couple the axes, batch by batch.
kernel void assemble_coupled(global const int* status, int batches, ARGUMENTS_OF_INSTANCES(constraints),
                             global const float8* point_hessians, global const float4* coupled_contributions,
                             global float16* C, global float16* coupled_gradient) {
  const int batch = get_global_id(0);
  if (status[0] || batch >= batches) return;
  const Instances kind = INSTANCES(constraints);
  float16 products[6][16], contributions[16];
  for (int n = 0; n < 16; ++n) {
    const int node = 16 * batch + n;
    float16 sum[6] = {0, 0, 0, 0, 0, 0};
    for (int e = kind.starts[node]; e < kind.starts[node + 1]; ++e) {
      const int instance = kind.entries[e] / SLOTS;
      const float4 lever_arm = kind.lever_arms[instance * K + kind.entries[e] % SLOTS];
      const float16 square = SPREAD(lever_arm) * TILED(lever_arm);
      const float8 W = point_hessians[instance];
      sum[0] += W.s0 * square;
      sum[1] += W.s1 * square;
      sum[2] += W.s2 * square;
      sum[3] += W.s3 * square;
      sum[4] += W.s4 * square;
      sum[5] += W.s5 * square;
    }
    for (int pair = 0; pair < 6; ++pair) products[pair][n] = sum[pair];
    contributions[n] = add_contributions(node, K, kind, coupled_contributions, 0);
  }
  int pair = 0;
  for (int b = 0; b < 3; ++b)
    for (int a = b; a < 3; ++a, ++pair) {
      transpose(products[pair]);
      for (int c = 0; c < 4; ++c)
        for (int d = 0; d < 4; ++d)
          if (a > b || c >= d) C[78 * batch + AT(4 * a + c, 4 * b + d)] = products[pair][4 * d + c];
    }
  transpose(contributions);
  for (int entry = 0; entry < 12; ++entry) coupled_gradient[12 * batch + entry] = contributions[entry];
}

#endif
