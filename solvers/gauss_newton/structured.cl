// Gauss-Newton on J^T J = M (x) I_3 + (12x12 per node) + (rows that couple the axes).
//
// A node's unknowns are the rows of [D | t]: number 4 axis + c, c = 3 being t; the caller's order (columns of
// D, then t: 3 c + axis) is met only at the borders. All arrays run over `padded` nodes, a multiple of 16,
// and vectors lie in chunks of sixteen nodes: unknown m of a chunk's nodes is one float16, number
// 12 chunk + m. What neighbours look at is kept a second time node by node, as (float16)(row x, y, z, 0).
//
// A 4x4 block of M is one float16, entry 4 d + c = M[c][d]: with a row x of [D | t] spread as
// xxxxyyyyzzzzwwww the lanes hold M[c][d] x[d], to be added up over d once per block row. The nodes' own
// 12x12 blocks are kept as packed lower triangles, sixteen nodes at a time.
//
// Terms of constraints that couple the axes (COUPLED) are never put into a matrix: a constraint's J^T J is
// 3x3 in the displacement of its point, and conjugate gradients apply it point by point.
//
// The course runs in one work-group of LANES work-items, whole in one kernel (`solve`) unless something has
// to be evaluated between its steps: launches and waits would cost more than a second core gains. The order
// of every sum is fixed. Compiled behind lanes.cl.

#define ROUNDING 3.6e-15f  // the square of the relative rounding error of single precision

#if LANES == 1
#define SYNC
#else
#define SYNC barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE)
#endif
#define FOR_EACH(i, count) for (int i = get_local_id(0); i < (count); i += LANES)

#define SPREAD(row) (row).xxxxyyyyzzzzwwww
#define TILE(row) (row).xyzwxyzwxyzwxyzw

float4 fold(float16 v) { return (v.lo.lo + v.lo.hi) + (v.hi.lo + v.hi.hi); }

float sum4(float4 v) { return (v.x + v.y) + (v.z + v.w); }

// ---------------------------------------------------------------------------------------------- instances

// One kind of instances, edges or constraints, each over `k` slots (see rows.cl and structure.h).
typedef struct {
  int count;
  global const int* nodes;
  global const int* starts;
  global const int* entries;
  global const float4* arms;
  global float4* forces;
} Kind;
#define KIND_ARGUMENTS(x)                                                                                  \
  int count_##x, global const int *nodes_##x, global const int *starts_##x, global const int *entries_##x, \
      global const float4 *arms_##x, global float4 *forces_##x
#define KIND(x) \
  { count_##x, nodes_##x, starts_##x, entries_##x, arms_##x, forces_##x }

// Row `node` of M from one kind of instances.
static inline void add_rows(int node, const int k, Kind kind, global const ushort* places,
                            global float16* row, float16* diagonal) {
  for (int e = kind.starts[node]; e < kind.starts[node + 1]; ++e) {
    const int first = kind.entries[e] / SLOTS * k;
    const float weight = kind.forces[kind.entries[e] / SLOTS].w;
    if (weight == 0) continue;
    const float16 left = TILE(weight * kind.arms[first + kind.entries[e] % SLOTS]);
    for (int slot = 0; slot < k; ++slot) {
      const float16 product = SPREAD(kind.arms[first + slot]) * left;
      const int place = places[e * k + slot];
      if (place == 0)
        *diagonal += product;
      else
        row[place] += product;
    }
  }
}

// Adds what an entry of a node's list contributes to its J^T r.
static inline float16 add_force(Kind kind, const int k, uint entry, global const float4* forces,
                                float16 sum) {
  const uint instance = entry / SLOTS;
  return sum + SPREAD(forces[instance]) * TILE(kind.arms[instance * k + entry % SLOTS]);
}

// J^T r of one node, as (row x, y, z, nothing), added to `gradient`.
static inline float16 add_forces(int node, const int k, Kind kind, global const float4* forces,
                                 float16 gradient) {
  const int end = kind.starts[node + 1];
  float16 others = 0;  // two sums, because one would wait for itself
  for (int e = kind.starts[node]; e < end; e += 2) {
    gradient = add_force(kind, k, kind.entries[e], forces, gradient);
    if (e + 1 < end) others = add_force(kind, k, kind.entries[e + 1], forces, others);
  }
  return gradient + others;
}

// What the rows of by_node move an instance by.
static inline float3 moved_by(int instance, const int k, Kind kind, global const float16* by_node) {
  float16 products = 0;
  for (int slot = k * instance; slot < k * (instance + 1); ++slot)
    products += TILE(kind.arms[slot]) * by_node[kind.nodes[slot]];
  return ((products.s048c + products.s159d) + (products.s26ae + products.s37bf)).xyz;
}

// M and J^T r of all that separates: each node gathers its own in a fixed order.
kernel void assemble(global const int* status, int padded, KIND_ARGUMENTS(edges),
                     global const ushort* places_edges, KIND_ARGUMENTS(constraints),
                     global const ushort* places_constraints, global const int* rows, global float16* M,
                     global float16* gradient) {
  const int node = get_global_id(0);
  if (status[0] || node >= padded) return;
  const Kind edges = KIND(edges), constraints = KIND(constraints);
  global float16* row = M + rows[node];
  for (int place = 1; place < rows[node + 1] - rows[node]; ++place) row[place] = 0;
  float16 diagonal = 0;
  add_rows(node, 2, edges, places_edges, row, &diagonal);
  add_rows(node, K, constraints, places_constraints, row, &diagonal);
  row[0] = diagonal;
  const float16 sum = add_forces(node, 2, edges, edges.forces, 0);
  gradient[node] = add_forces(node, K, constraints, constraints.forces, sum);
}

// ------------------------------------------------------------------------------------------- vector tools

// Writes a chunk node by node.
static inline void store_rows(const float16* values, int chunk, global float16* rows) {
  float16 m[16];
  for (int entry = 0; entry < 12; ++entry) m[entry] = values[entry];
  for (int entry = 12; entry < 16; ++entry) m[entry] = 0;
  transpose(m);
  for (int n = 0; n < 16; ++n) rows[16 * chunk + n] = m[n];
}

float16 inside(int chunk, int node_count) {
  const float16 lanes = (float16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  return select((float16)(0), (float16)(1), lanes + 16 * chunk < (float)node_count);
}

float total(float16 part, local float* scratch) {
  const float8 half_part = part.lo + part.hi;
  const float sum = sum4(half_part.lo + half_part.hi);
#if LANES == 1
  return sum;
#else
  scratch[get_local_id(0)] = sum;
  for (int others = LANES / 2; others > 0; others /= 2) {
    SYNC;
    if (get_local_id(0) < others) scratch[get_local_id(0)] += scratch[get_local_id(0) + others];
  }
  SYNC;
  const float all = scratch[0];
  SYNC;
  return all;
#endif
}

#define AT(m, n) ((m) * ((m) + 1) / 2 + (n))

// L D L^T of symmetric positive semi-definite 12x12 matrices (packed lower triangles, a node a lane): leaves
// L below the diagonal and the inverse of D on it. What nothing determines gets zero there: the
// preconditioner does not move it.
static inline void factor(float16* packed) {
  float16 least[12];
  for (int m = 0; m < 12; ++m) least[m] = 1e-5f * packed[AT(m, m)];
  for (int pivot = 0; pivot < 12; ++pivot) {
    const float16 d = packed[AT(pivot, pivot)];
    const float16 inverse = select((float16)(0), 1 / d, d > fmax(least[pivot], 1e-30f));
    packed[AT(pivot, pivot)] = inverse;
    for (int m = pivot + 1; m < 12; ++m) {
      const float16 below = packed[AT(m, pivot)];
      const float16 multiplier = below * inverse;
      for (int n = pivot + 1; n < m; ++n) packed[AT(m, n)] -= packed[AT(n, pivot)] * below;
      packed[AT(m, m)] -= multiplier * below;
      packed[AT(m, pivot)] = multiplier;
    }
  }
}

// y += (packed symmetric matrix) x.
static inline void multiply_packed(global const float16* packed, const float16* x, float16* y) {
#pragma unroll
  for (int m = 0; m < 12; ++m) {
#pragma unroll
    for (int n = 0; n < m; ++n) {
      y[m] += packed[AT(m, n)] * x[n];
      y[n] += packed[AT(m, n)] * x[m];
    }
    y[m] += packed[AT(m, m)] * x[m];
  }
}

// Solves L D L^T z = z.
static inline void solve_packed(global const float16* packed, float16* z) {
#pragma unroll
  for (int m = 1; m < 12; ++m)
#pragma unroll
    for (int n = 0; n < m; ++n) z[m] -= packed[AT(m, n)] * z[n];
#pragma unroll
  for (int m = 0; m < 12; ++m) z[m] *= packed[AT(m, m)];
#pragma unroll
  for (int m = 11; m > 0; --m)
#pragma unroll
    for (int n = 0; n < m; ++n) z[n] -= packed[AT(m, n)] * z[m];
}

#if COUPLED
// ------------------------------------------------------------------------------------------ coupled rows

// The diagonal blocks and J^T r of the rows that couple the axes, chunk by chunk.
kernel void assemble_coupled(global const int* status, int chunks, KIND_ARGUMENTS(constraints),
                             global const float8* couplings, global const float4* coupled_forces,
                             global float16* C, global float16* coupled_gradient) {
  const int chunk = get_global_id(0);
  if (status[0] || chunk >= chunks) return;
  const Kind kind = KIND(constraints);
  float16 products[6][16], forces[16];
  for (int n = 0; n < 16; ++n) {
    const int node = 16 * chunk + n;
    float16 sum[6] = {0, 0, 0, 0, 0, 0};
    for (int e = kind.starts[node]; e < kind.starts[node + 1]; ++e) {
      const int instance = kind.entries[e] / SLOTS;
      const float4 arm = kind.arms[instance * K + kind.entries[e] % SLOTS];
      const float16 square = SPREAD(arm) * TILE(arm);
      const float8 W = couplings[instance];
      sum[0] += W.s0 * square;
      sum[1] += W.s1 * square;
      sum[2] += W.s2 * square;
      sum[3] += W.s3 * square;
      sum[4] += W.s4 * square;
      sum[5] += W.s5 * square;
    }
    for (int pair = 0; pair < 6; ++pair) products[pair][n] = sum[pair];
    forces[n] = add_forces(node, K, kind, coupled_forces, 0);
  }
  int pair = 0;
  for (int b = 0; b < 3; ++b)
    for (int a = b; a < 3; ++a, ++pair) {
      transpose(products[pair]);
      for (int c = 0; c < 4; ++c)
        for (int d = 0; d < 4; ++d)
          if (a > b || c >= d) C[78 * chunk + AT(4 * a + c, 4 * b + d)] = products[pair][4 * d + c];
    }
  transpose(forces);
  for (int entry = 0; entry < 12; ++entry) coupled_gradient[12 * chunk + entry] = forces[entry];
}

#endif

// -------------------------------------------------------------------------------------- Gauss-Newton itself

// What a course knows of itself; between kernels it lies in a buffer.
typedef struct {
  float energy, initial_energy;
  float summed_energy;  // where the gradient was last summed over the instances
  float damping;
  float noise;   // changes of the energy that single precision cannot see
  float wanted;  // change of the energy that ends the course
  float change;  // of the energy, by the step in hand; without what is coupled
  int iteration, linear_iterations;
  int used;     // iterations of the linear solver for the step in hand; -1: there was no solution
  int longest;  // most that a step has used
  int fresh;    // the gradient has just been summed
  int termination;
} Course;

// Everything that a sweep over the nodes looks at.
typedef struct {
  int node_count, chunks, max_iterations;
  float tolerance, least_damping;
  global const float* node_weights;
  global const int* rows;
  global const int* columns;
  global const float16* M;
  global float16* D;          // diagonal blocks of what is solved: M + energies per node, damped
  global float16* P;          // the same with what is coupled, factored
  global float16* x;          // unknowns, in chunks, like all that follow
  global float16* summed_at;  // x where the gradient was last summed over the instances
  global float16* gradient;   // half the gradient of what separates
  global float16* step;
  global float16* residual;  // of the linear system
  global float16* direction;
  global float16* product;
  global float16* by_node;  // what is multiplied by M, node by node
  Kind edges, constraints;
#if COUPLED
  global const float8* couplings;  // J^T J per constraint: xx xy xz yy yz zz, zeros
  global float4* pulls;            // J^T J (displacement) per constraint
  global const float16* C;         // diagonal blocks
  global const float16* coupled_gradient;
#endif
} System;

// The arguments that all kernels of the course share.
#define SYSTEM_ARGUMENTS                                                                      \
  int node_count, int chunks, int max_iterations, float tolerance, float least_damping,       \
      global const float *node_weights, global const int *rows, global const int *columns,    \
      global const float16 *M, global float16 *D, global float16 *P, global float16 *vectors, \
      KIND_ARGUMENTS(edges), KIND_ARGUMENTS(constraints), global const float8 *couplings,     \
      global float4 *pulls, global const float16 *C, global const float16 *coupled_gradient
#if COUPLED
#define COUPLED_MEMBERS , couplings, pulls, C, coupled_gradient
#else
#define COUPLED_MEMBERS
#endif
#define MAKE_SYSTEM                                                                                          \
  {                                                                                                          \
    node_count, chunks, max_iterations, tolerance, least_damping, node_weights, rows, columns, M, D, P,      \
        vectors, vectors + 12 * chunks, vectors + 24 * chunks, vectors + 36 * chunks, vectors + 48 * chunks, \
        vectors + 60 * chunks, vectors + 72 * chunks, vectors + 84 * chunks, KIND(edges),                    \
        KIND(constraints) COUPLED_MEMBERS                                                                    \
  }

// result = (M (from place `first` of each row on), and what is coupled if so asked) times by_node, for one
// chunk; what is coupled must lie in `pulls`.
static inline void multiply_rows(const System* s, int chunk, int first, int with_coupled, float16* result) {
  float16 m[16];
  for (int n = 0; n < 16; ++n) {
    float16 x = 0, y = 0, z = 0;
    const int end = s->rows[16 * chunk + n + 1];
    for (int block = s->rows[16 * chunk + n] + first; block < end; ++block) {
      const float16 entries = s->M[block];
      global const float4* other = (global const float4*)(s->by_node + s->columns[block]);
      x += entries * SPREAD(other[0]);
      y += entries * SPREAD(other[1]);
      z += entries * SPREAD(other[2]);
    }
    m[n] = (float16)(fold(x), fold(y), fold(z), (float4)(0));
#if COUPLED
    if (with_coupled) m[n] = add_forces(16 * chunk + n, K, s->constraints, s->pulls, m[n]);
#endif
  }
  transpose(m);
  for (int entry = 0; entry < 12; ++entry) result[entry] = m[entry];
}

// Builds D, its factors and the right-hand side of a chunk. Returns what the preconditioner makes of the
// rounding errors in that right-hand side, which come of energies of the size `mean` a node, and of the way
// since the gradient was last summed: gains below are not to be believed.
static inline float16 prepare(const System* s, int chunk, float damping, float mean) {
  float16 u[12], packed[78], force[12], m[16];
  for (int entry = 0; entry < 12; ++entry) u[COLUMNWISE(entry)] = s->x[12 * chunk + entry];
  for (int entry = 0; entry < 78; ++entry) packed[entry] = 0;
  for (int entry = 0; entry < 12; ++entry) force[entry] = s->gradient[12 * chunk + entry];
  add_node_terms(u, inside(chunk, s->node_count), s->node_weights, packed, force);

  for (int n = 0; n < 16; ++n) m[n] = s->M[s->rows[16 * chunk + n]];
  transpose(m);
  for (int axis = 0; axis < 3; ++axis)
    for (int c = 0; c < 4; ++c)
      for (int d = 0; d <= c; ++d) packed[AT(4 * axis + c, 4 * axis + d)] += m[4 * d + c];
  for (int entry = 0; entry < 12; ++entry) {
    float16 whole = packed[AT(entry, entry)];
#if COUPLED
    whole += s->C[78 * chunk + AT(entry, entry)];
    force[entry] += s->coupled_gradient[12 * chunk + entry];
#endif
    packed[AT(entry, entry)] += damping * whole;
  }
  for (int entry = 0; entry < 78; ++entry) s->D[78 * chunk + entry] = packed[entry];
#if COUPLED
  for (int entry = 0; entry < 78; ++entry) packed[entry] += s->C[78 * chunk + entry];
#endif
  float16 errors[12], size = mean, noise = 0;
  for (int entry = 0; entry < 12; ++entry) {
    const float16 d = packed[AT(entry, entry)];
    const float16 way = s->x[12 * chunk + entry] - s->summed_at[12 * chunk + entry];
    size += d * way * way;
    m[entry] = sqrt(d) * (float16)(1, 1, -1, 1, -1, -1, 1, -1, -1, 1, 1, 1, -1, 1, -1, -1) *
               (entry % 3 == 1 ? -1 : 1);
    errors[entry] = m[entry];
  }
  factor(packed);
  for (int entry = 0; entry < 78; ++entry) s->P[78 * chunk + entry] = packed[entry];
  solve_packed(s->P + 78 * chunk, errors);
  for (int entry = 0; entry < 12; ++entry) {
    noise += m[entry] * errors[entry];
    s->residual[12 * chunk + entry] = -force[entry];
  }
  return ROUNDING * size * noise;
}

#if COUPLED
// J^T J (what by_node moves the point by) of every constraint.
static inline void pull(const System* s) {
  FOR_EACH(instance, s->constraints.count) {
    const float8 W = s->couplings[instance];
    const float3 u = moved_by(instance, K, s->constraints, s->by_node);
    s->pulls[instance] = W.s0127 * u.x + W.s1347 * u.y + W.s2457 * u.z;
  }
  SYNC;
}
#endif

// Solves for the step until the preconditioned residual falls below `least`, or an iteration gains but a
// small share of those before. Returns the number of iterations, -1 when there is no solution.
int conjugate_gradients(const System* s, float least, local float* scratch) {
  float16 part = 0;
  FOR_EACH(chunk, s->chunks) {
    float16 z[12];
    for (int entry = 0; entry < 12; ++entry) z[entry] = s->residual[12 * chunk + entry];
    solve_packed(s->P + 78 * chunk, z);
    for (int entry = 0; entry < 12; ++entry) {
      part += z[entry] * s->residual[12 * chunk + entry];
      s->direction[12 * chunk + entry] = z[entry];
      s->step[12 * chunk + entry] = 0;
    }
    store_rows(z, chunk, s->by_node);
  }
  float rz = total(part, scratch);
  float gained = 0;
  int iteration = 0;
  if (!isfinite(rz)) return -1;
  while (iteration < 12 * s->node_count && rz > least) {
    SYNC;
#if COUPLED
    pull(s);
#endif
    part = 0;
    FOR_EACH(chunk, s->chunks) {
      float16 p[12], q[12];
      multiply_rows(s, chunk, 1, 1, q);
      for (int entry = 0; entry < 12; ++entry) p[entry] = s->direction[12 * chunk + entry];
      multiply_packed(s->D + 78 * chunk, p, q);
      for (int entry = 0; entry < 12; ++entry) {
        part += p[entry] * q[entry];
        s->product[12 * chunk + entry] = q[entry];
      }
    }
    const float curvature = total(part, scratch);
    if (!(curvature > 0)) return iteration > 0 ? iteration : -1;
    ++iteration;
    const float alpha = rz / curvature;
    const float gain = alpha * rz;
    gained += gain;
    const int last = gain * max(iteration, 5) < 0.002f * gained;
    part = 0;
    FOR_EACH(chunk, s->chunks) {
      float16 z[12];
      for (int entry = 0; entry < 12; ++entry) {
        const int at = 12 * chunk + entry;
        s->step[at] += alpha * s->direction[at];
        z[entry] = s->residual[at] - alpha * s->product[at];
        s->residual[at] = z[entry];
      }
      if (last) continue;
      solve_packed(s->P + 78 * chunk, z);
      for (int entry = 0; entry < 12; ++entry) {
        part += z[entry] * s->residual[12 * chunk + entry];
        s->product[12 * chunk + entry] = z[entry];
      }
    }
    if (last) break;
    const float next = total(part, scratch);
    const float beta = next / rz;
    rz = next;
    FOR_EACH(chunk, s->chunks) {
      float16 p[12];
      for (int entry = 0; entry < 12; ++entry) {
        const int at = 12 * chunk + entry;
        p[entry] = s->product[at] + beta * s->direction[at];
        s->direction[at] = p[entry];
      }
      store_rows(p, chunk, s->by_node);
    }
  }
  return iteration;
}

// What the step changes the energy by, without what is coupled: exactly so for what is quadratic, as a
// difference per node for the rest. Leaves M * step in `product`.
float try_step(const System* s, local float* scratch) {
  SYNC;
  FOR_EACH(chunk, s->chunks) {
    float16 step[12];
    for (int entry = 0; entry < 12; ++entry) step[entry] = s->step[12 * chunk + entry];
    store_rows(step, chunk, s->by_node);
  }
  SYNC;
  float16 part = 0;
  FOR_EACH(chunk, s->chunks) {
    float16 product[12], u[12], v[12];
    multiply_rows(s, chunk, 0, 0, product);
    for (int entry = 0; entry < 12; ++entry) {
      const int at = 12 * chunk + entry;
      part += s->step[at] * (product[entry] + 2 * s->gradient[at]);
      s->product[at] = product[entry];
      u[COLUMNWISE(entry)] = s->x[at];
      v[COLUMNWISE(entry)] = s->x[at] + s->step[at];
    }
    part += change_of_node_terms(u, v, inside(chunk, s->node_count), s->node_weights);
  }
  return total(part, scratch);
}

// Moves the forces of one kind of instances from `summed_at` to x; by_node holds the difference. Returns
// their energy.
static inline float move_forces(const System* s, const int k, Kind kind) {
  float energy = 0;
  FOR_EACH(instance, kind.count) {
    float4 force = kind.forces[instance];
    force.xyz += force.w * moved_by(instance, k, kind, s->by_node);
    kind.forces[instance] = force;
    if (force.w > 0) energy += (force.x * force.x + force.y * force.y + force.z * force.z) / force.w;
  }
  return energy;
}

// Sums the gradient anew over the instances: updated by M step after step it gathers rounding errors, which
// weigh the more the worse a problem is conditioned. Returns the energy of the instances.
float sum_gradient(const System* s, local float* scratch) {
  FOR_EACH(chunk, s->chunks) {
    float16 way[12];
    for (int entry = 0; entry < 12; ++entry) {
      const int at = 12 * chunk + entry;
      way[entry] = s->x[at] - s->summed_at[at];
      s->summed_at[at] = s->x[at];
    }
    store_rows(way, chunk, s->by_node);
  }
  SYNC;
  const float16 part = (float16)(move_forces(s, 2, s->edges), move_forces(s, K, s->constraints), 0, 0,
                                 (float4)(0), (float8)(0));
  SYNC;
  FOR_EACH(chunk, s->chunks) {
    float16 m[16];
    for (int n = 0; n < 16; ++n) {
      const float16 sum = add_forces(16 * chunk + n, 2, s->edges, s->edges.forces, 0);
      m[n] = add_forces(16 * chunk + n, K, s->constraints, s->constraints.forces, sum);
    }
    transpose(m);
    for (int entry = 0; entry < 12; ++entry) s->gradient[12 * chunk + entry] = m[entry];
  }
  return total(part, scratch);
}

float energy_per_node(const System* s, local float* scratch) {
  float16 part = 0;
  FOR_EACH(chunk, s->chunks) {
    float16 u[12];
    for (int entry = 0; entry < 12; ++entry) u[COLUMNWISE(entry)] = s->x[12 * chunk + entry];
    part += energy_of_node_terms(u, inside(chunk, s->node_count), s->node_weights);
  }
  return total(part, scratch);
}

float ordered_sum(global const float* values, int count) {
  float sum = 0, lost = 0;
  for (int i = 0; i < count; ++i) {
    const float term = values[i] - lost;
    const float next = sum + term;
    lost = (next - sum) - term;
    sum = next;
  }
  return sum;
}

// `partials`: energy of edges and constraints; gets the energy per node behind them. `assembled`: gradient of
// what separates, node by node.
Course begin_course(const System* s, global const float* unknowns, global const float16* assembled,
                    int partial_count, global float* partials, local float* scratch) {
  FOR_EACH(chunk, s->chunks) {
    float16 m[16], g[16];
    for (int n = 0; n < 16; ++n) {
      const int node = 16 * chunk + n;
      m[n] = 0;
      if (node < s->node_count) {
        m[n].lo = vload8(0, unknowns + 12 * node);
        m[n].hi.lo = vload4(2, unknowns + 12 * node);
      }
      g[n] = assembled[node];
    }
    transpose(m);
    transpose(g);
    for (int entry = 0; entry < 12; ++entry) {
      s->x[12 * chunk + entry] = s->summed_at[12 * chunk + entry] = m[COLUMNWISE(entry)];
      s->gradient[12 * chunk + entry] = g[entry];
    }
  }
  const float per_node = energy_per_node(s, scratch);
  if (get_local_id(0) == 0) partials[partial_count] = per_node;
  SYNC;
  Course course = {0};
  course.energy = ordered_sum(partials, partial_count + 1);  // to the bit what `conclude` would say
  course.initial_energy = course.summed_energy = course.energy;
  course.damping = s->least_damping;
  course.fresh = 1;
  course.termination = isfinite(course.energy) ? 0 : 4;
  return course;
}

void make_step(const System* s, Course* course, local float* scratch) {
  float16 part = 0;
  const float mean = 4 * course->summed_energy / s->node_count;
  FOR_EACH(chunk, s->chunks) part += prepare(s, chunk, course->damping, mean);
  course->noise = total(part, scratch);
  course->wanted = s->tolerance * fmax(course->energy, 1e-9f * course->initial_energy);
  // What is left to gain is the residual times the spread of the spectrum, which the iterations so far tell.
  const float spread = fmax(1.0f, 0.0625f * course->longest * course->longest);
  course->used = conjugate_gradients(s, fmax(0.1f * course->wanted, course->noise) / spread, scratch);
  course->longest = max(course->longest, course->used);
  course->change = course->used > 0 ? try_step(s, scratch) : course->used == 0 ? 0.0f : INFINITY;
}

// Takes a step that lowers the energy; otherwise damps [thesis 4.6, OPEN]. Ends the course when the energy
// has stopped changing (1), after the last iteration (2) or when no damping helps (3). `energies`: the
// changes.
void decide(const System* s, Course* course, global int* energies, local float* scratch) {
  const float change = course->change;
  if (course->used != 0) {
    const int accepted = change <= 0;  // false for NaN
    if (accepted) {
      course->energy += change;
      course->damping = fmax(course->damping * 0.1f, s->least_damping);
      FOR_EACH(chunk, s->chunks) for (int at = 12 * chunk; at < 12 * (chunk + 1); ++at) {
        s->x[at] += s->step[at];
        s->gradient[at] += s->product[at];
      }
    } else {
      course->damping = fmax(course->damping, 1e-6f) * 10;
    }
    if (get_local_id(0) == 0) energies[course->iteration] = as_int(accepted ? change : 0.0f);
    ++course->iteration;
    course->linear_iterations += max(course->used, 0);
  }
  const int settled = fabs(change) <= fmax(course->wanted, course->noise);
  if (settled && (course->fresh || course->noise <= course->wanted))
    course->termination = 1;
  else if (course->iteration >= s->max_iterations)
    course->termination = 2;
  else if (course->damping > 1e6f)
    course->termination = 3;
  course->fresh = 0;
  if (course->termination == 0 && settled) {
    const float energy = sum_gradient(s, scratch) + energy_per_node(s, scratch);
#if !COUPLED
    course->energy = energy;
#endif
    course->summed_energy = course->energy;
    course->fresh = 1;
  }
}

// A vector in the order of the caller.
static inline void store_columnwise(const System* s, global const float16* from, global float* to) {
  FOR_EACH(chunk, s->chunks) {
    float16 m[16];
    for (int entry = 0; entry < 12; ++entry) m[COLUMNWISE(entry)] = from[12 * chunk + entry];
    for (int entry = 12; entry < 16; ++entry) m[entry] = 0;
    transpose(m);
    for (int n = 0; n < 16 && 16 * chunk + n < s->node_count; ++n) {
      vstore8(m[n].lo, 0, to + 12 * (16 * chunk + n));
      vstore4(m[n].hi.lo, 2, to + 12 * (16 * chunk + n));
    }
  }
}

// `partials` gets the energy per node behind those of edges and constraints.
void end_course(const System* s, const Course* course, global int* status, int partial_count,
                global float* partials, global float* unknowns, local float* scratch) {
  store_columnwise(s, s->x, unknowns);
  const float per_node = energy_per_node(s, scratch);
  if (get_local_id(0) == 0) {
    partials[partial_count] = per_node;
    status[0] = 0;
    status[2] = course->iteration;
    status[4] = as_int(course->energy);
    status[7] = course->termination;
    status[8] = as_int(course->initial_energy);
    status[9] = course->linear_iterations;
  }
}

#define COURSE_KERNEL kernel __attribute__((reqd_work_group_size(LANES, 1, 1))) void

#if !COUPLED
// The whole course, from `unknowns` to `unknowns`. Words of status: see StatusWord; the energies it leaves
// are the changes that `conclude` turns into sums.
COURSE_KERNEL solve(global int* status, SYSTEM_ARGUMENTS, global const float16* assembled, int partial_count,
                    global float* partials, global float* unknowns) {
  local float scratch[LANES];
  const System s = MAKE_SYSTEM;
  Course course = begin_course(&s, unknowns, assembled, partial_count, partials, scratch);
  while (course.termination == 0) {
    make_step(&s, &course, scratch);
    decide(&s, &course, status + 16, scratch);
  }
  end_course(&s, &course, status, partial_count, partials, unknowns, scratch);
}
#else
// The same in pieces. While a step is in hand, `trial` holds it in the caller's order.
COURSE_KERNEL begin(global int* status, SYSTEM_ARGUMENTS, global const float16* assembled, int partial_count,
                    global float* partials, global const float* unknowns, global Course* kept) {
  local float scratch[LANES];
  const System s = MAKE_SYSTEM;
  const Course course = begin_course(&s, unknowns, assembled, partial_count, partials, scratch);
  if (get_local_id(0) == 0) {
    *kept = course;
    status[0] = course.termination;
  }
}

COURSE_KERNEL next_step(global const int* status, SYSTEM_ARGUMENTS, global Course* kept,
                        global float* trial) {
  local float scratch[LANES];
  if (status[0]) return;
  const System s = MAKE_SYSTEM;
  Course course = *kept;
  make_step(&s, &course, scratch);
  store_columnwise(&s, s.step, trial);
  if (get_local_id(0) == 0) *kept = course;
}

// `changes`: of the energy of what is coupled, by the step in hand.
COURSE_KERNEL take_step(global int* status, SYSTEM_ARGUMENTS, global Course* kept, int change_count,
                        global const float* changes, global float* unknowns) {
  local float scratch[LANES];
  if (status[0]) return;
  const System s = MAKE_SYSTEM;
  Course course = *kept;
  SYNC;
  if (course.used > 0) course.change += ordered_sum(changes, change_count);
  decide(&s, &course, status + 16, scratch);
  store_columnwise(&s, s.x, unknowns);
  if (get_local_id(0) == 0) {
    *kept = course;
    status[0] = course.termination;
  }
}

COURSE_KERNEL end(global int* status, SYSTEM_ARGUMENTS, global const Course* kept, int partial_count,
                  global float* partials, global float* unknowns) {
  local float scratch[LANES];
  const System s = MAKE_SYSTEM;
  const Course course = *kept;
  end_course(&s, &course, status, partial_count, partials, unknowns, scratch);
}
#endif

// The final energy, summed anew if there are partials, and from it the energies after each iteration: their
// changes are small and known to many digits, sums of large numbers are not.
kernel void conclude(global int* status, int partial_count, global const float* partials) {
  float energy = partial_count > 0 ? ordered_sum(partials, partial_count) : as_float(status[4]);
  status[4] = as_int(energy);
  for (int iteration = status[2] - 1; iteration >= 0; --iteration) {
    const float change = as_float(status[16 + iteration]);
    status[16 + iteration] = as_int(energy);
    energy -= change;
  }
  status[0] = 1;
}
