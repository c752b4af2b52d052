// How the unknowns, the matrix and the instances of a problem lie in memory; see docs/structured-solver.md.
//
// J^T J = M (x) I_3 + (12x12 per node) + (3x3 per constraint that couples the axes, in its displacement).
//
// A node's unknowns are the rows of [D | t]: number 4 axis + c, c = 3 being t; the caller's order (columns of
// D, then t: 3 c + axis) is met only at the borders. All arrays run over `padded` nodes, a multiple of 16,
// and vectors lie in batches of sixteen nodes: unknown m of a batch's nodes is one float16, number
// 12 batch + m. What neighbours look at is kept a second time node by node, as (float16)(row x, y, z, 0).
//
// A 4x4 block of M is one float16, entry 4 d + c = M[c][d]: with a row x of [D | t] spread as
// xxxxyyyyzzzzwwww the lanes hold M[c][d] x[d], to be added up over d once per block row. The nodes' own
// 12x12 blocks are kept as packed lower triangles (packed.cl), sixteen nodes at a time.
//
// Compiled behind lanes.cl, reductions.cl and the terms per node.

#define SPREAD(row) (row).xxxxyyyyzzzzwwww
#define TILED(row) (row).xyzwxyzwxyzwxyzw

float4 fold(float16 v) { return (v.lo.lo + v.lo.hi) + (v.hi.lo + v.hi.hi); }

// One kind of instances, edges or constraints, each over `k` slots (see instance_terms.cl and structure.h).
typedef struct {
  int count;
  global const int* nodes;
  global const int* starts;
  global const int* entries;
  global const float4* lever_arms;
  global float4* contributions;
} Instances;
#define ARGUMENTS_OF_INSTANCES(x)                                                                          \
  int count_##x, global const int *nodes_##x, global const int *starts_##x, global const int *entries_##x, \
      global const float4 *lever_arms_##x, global float4 *contributions_##x
#define INSTANCES(x) \
  { count_##x, nodes_##x, starts_##x, entries_##x, lever_arms_##x, contributions_##x }

// Everything that a sweep over the nodes looks at.
typedef struct {
  int node_count, batches, max_iterations;
  float tolerance, least_damping;
  global const float* node_weights;
  global const int* row_starts;
  global const int* columns;
  global const float16* M;
  global float16* D;          // diagonal blocks of what is solved: M + energies per node, damped
  global float16* P;          // the same with what is coupled, factored
  global float16* x;          // unknowns, in batches, like all that follow
  global float16* summed_at;  // x where the gradient was last summed over the instances
  global float16* gradient;   // half the gradient of what separates
  global float16* step;
  global float16* residual;  // of the linear system
  global float16* direction;
  global float16* product;
  global float16* by_node;  // what is multiplied by M, node by node
  Instances edges, constraints;
#if COUPLED
  global const float8* point_hessians;  // J^T J per constraint: xx xy xz yy yz zz, zeros
  global float4* hessian_products;      // J^T J (displacement) per constraint
  global const float16* C;              // diagonal blocks
  global const float16* coupled_gradient;
#endif
} System;

// The arguments that all kernels of the minimiser share.
#define SYSTEM_ARGUMENTS                                                                             \
  int node_count, int batches, int max_iterations, float tolerance, float least_damping,             \
      global const float *node_weights, global const int *row_starts, global const int *columns,     \
      global const float16 *M, global float16 *D, global float16 *P, global float16 *vectors,        \
      ARGUMENTS_OF_INSTANCES(edges), ARGUMENTS_OF_INSTANCES(constraints),                            \
      global const float8 *point_hessians, global float4 *hessian_products, global const float16 *C, \
      global const float16 *coupled_gradient
#if COUPLED
#define COUPLED_MEMBERS , point_hessians, hessian_products, C, coupled_gradient
#else
#define COUPLED_MEMBERS
#endif
#define MAKE_SYSTEM                                                                                         \
  {                                                                                                         \
    node_count, batches, max_iterations, tolerance, least_damping, node_weights, row_starts, columns, M, D, \
        P, vectors, vectors + 12 * batches, vectors + 24 * batches, vectors + 36 * batches,                 \
        vectors + 48 * batches, vectors + 60 * batches, vectors + 72 * batches, vectors + 84 * batches,     \
        INSTANCES(edges), INSTANCES(constraints) COUPLED_MEMBERS                                            \
  }

// Writes a batch node by node.
static inline void store_by_node(const float16* values, int batch, global float16* rows) {
  float16 m[16];
  for (int entry = 0; entry < 12; ++entry) m[entry] = values[entry];
  for (int entry = 12; entry < 16; ++entry) m[entry] = 0;
  transpose(m);
  for (int n = 0; n < 16; ++n) rows[16 * batch + n] = m[n];
}

float16 inside(int batch, int node_count) {
  const float16 lanes = (float16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  return select((float16)(0), (float16)(1), lanes + 16 * batch < (float)node_count);
}

// A vector in the order of the caller.
static inline void store_columnwise(const System* s, global const float16* from, global float* to) {
  FOR_EACH(batch, s->batches) {
    float16 m[16];
    for (int entry = 0; entry < 12; ++entry) m[COLUMNWISE(entry)] = from[12 * batch + entry];
    for (int entry = 12; entry < 16; ++entry) m[entry] = 0;
    transpose(m);
    for (int n = 0; n < 16 && 16 * batch + n < s->node_count; ++n) {
      vstore8(m[n].lo, 0, to + 12 * (16 * batch + n));
      vstore4(m[n].hi.lo, 2, to + 12 * (16 * batch + n));
    }
  }
}
