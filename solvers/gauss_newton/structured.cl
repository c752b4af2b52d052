// Gauss-Newton on J^T J = M (x) I_3 + (12x12 per node).
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
// `solve` runs the whole course in one work-group of LANES work-items: launches and waits would cost more
// than a second core gains. The order of every sum is fixed.

#ifndef CG_SPREAD
#define CG_SPREAD 10
#define CG_SHARE 0.1f
#define LEAST_SHARE 0.1f
#define ROUNDING 3.6e-15f  // the square of the relative rounding error of single precision
#endif

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

// ---------------------------------------------------------------------------------------------- assembly

// One kind of instances as `assemble` sees it (see rows.cl and structure.h).
#define KIND_ARGUMENTS(x)                                                                       \
  global const int *starts_##x, global const int *entries_##x, global const ushort *places_##x, \
      global const float4 *arms_##x, global const float4 *forces_##x
#define FORCE_ARGUMENTS(x)                                                                    \
  global const int *starts_##x, global const int *entries_##x, global const float4 *arms_##x, \
      global float4 *forces_##x
#define FORCES(x) starts_##x, entries_##x, arms_##x, forces_##x
#define KIND(x) starts_##x, entries_##x, places_##x, arms_##x, forces_##x

static inline void add_rows(int node, const int k, KIND_ARGUMENTS(), global float16* row, float16* diagonal,
                            float4* gradient) {
  for (int e = starts_[node]; e < starts_[node + 1]; ++e) {
    const int instance = entries_[e] / SLOTS;
    const float4 arm = arms_[instance * k + entries_[e] % SLOTS];
    const float4 force = forces_[instance];
    gradient[0] += force.x * arm;
    gradient[1] += force.y * arm;
    gradient[2] += force.z * arm;
    const float16 left = TILE(force.w * arm);
    for (int slot = 0; slot < k; ++slot) {
      const float16 product = SPREAD(arms_[instance * k + slot]) * left;
      const int place = places_[e * k + slot];
      if (place == 0)
        *diagonal += product;
      else
        row[place] += product;
    }
  }
}

// Row `node` of M, and its part of J^T r of all that separates: each node gathers in a fixed order.
kernel void assemble(global const int* status, int padded, KIND_ARGUMENTS(edges), KIND_ARGUMENTS(constraints),
                     global const int* rows, global float16* M, global float4* gradient) {
  const int node = get_global_id(0);
  if (status[0] || node >= padded) return;
  global float16* row = M + rows[node];
  for (int place = 1; place < rows[node + 1] - rows[node]; ++place) row[place] = 0;
  float16 diagonal = 0;
  float4 sum[3] = {0, 0, 0};
  add_rows(node, 2, KIND(edges), row, &diagonal, sum);
  add_rows(node, K, KIND(constraints), row, &diagonal, sum);
  row[0] = diagonal;
  for (int axis = 0; axis < 3; ++axis) gradient[3 * node + axis] = sum[axis];
}

// ------------------------------------------------------------------------------------------- vector tools

// Transposes a 16x16 matrix in place.
static inline void transpose(float16* m) {
  float16 other[16];
#pragma unroll
  for (int round = 0; round < 2; ++round) {
#pragma unroll
    for (int i = 0; i < 8; ++i) {
      other[2 * i].even = m[i].lo;
      other[2 * i].odd = m[i + 8].lo;
      other[2 * i + 1].even = m[i].hi;
      other[2 * i + 1].odd = m[i + 8].hi;
    }
#pragma unroll
    for (int i = 0; i < 8; ++i) {
      m[2 * i].even = other[i].lo;
      m[2 * i].odd = other[i + 8].lo;
      m[2 * i + 1].even = other[i].hi;
      m[2 * i + 1].odd = other[i + 8].hi;
    }
  }
}

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
    barrier(CLK_LOCAL_MEM_FENCE);
    if (get_local_id(0) < others) scratch[get_local_id(0)] += scratch[get_local_id(0) + others];
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  const float all = scratch[0];
  barrier(CLK_LOCAL_MEM_FENCE);
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

// -------------------------------------------------------------------------------------- Gauss-Newton itself

// Everything that a sweep over the nodes looks at.
typedef struct {
  int node_count, chunks;
  global const float* node_weights;
  global const int* rows;
  global const int* columns;
  global const float16* M;
  global float16* D;          // diagonal blocks of what is solved: M + energies per node, damped
  global float16* P;          // their factors
  global float16* x;          // unknowns, in chunks, like all that follow
  global float16* summed_at;  // x where the gradient was last summed over the instances
  global float16* gradient;   // half the gradient of what separates
  global float16* step;
  global float16* residual;  // of the linear system
  global float16* direction;
  global float16* product;
  global float16* by_node;  // what is multiplied by M, node by node
} System;

// M (from place `first` of each row on) times by_node, for one chunk.
static inline void multiply_rows(const System* s, int chunk, int first, float16* result) {
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
  for (int entry = 0; entry < 12; ++entry) packed[AT(entry, entry)] *= 1 + damping;
  for (int entry = 0; entry < 78; ++entry) s->D[78 * chunk + entry] = packed[entry];
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

// Solves for the step until a further iteration would lower the energy by less than `least`, or by less
// than a share of what has been gained. Returns the number of iterations, -1 when there is no solution.
int conjugate_gradients(const System* s, float least, int most_iterations, local float* scratch) {
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
  // rz bounds from below, within the spread of the preconditioned spectrum, what is left to gain
  if (!isfinite(rz)) return -1;
  while (iteration < most_iterations && rz > least) {
    SYNC;
    part = 0;
    FOR_EACH(chunk, s->chunks) {
      float16 p[12], q[12];
      multiply_rows(s, chunk, 1, q);
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
    const int last = gain * CG_SPREAD < max(CG_SHARE * gained, least);
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

// What the step changes the energy by: exactly so for what is quadratic, as a difference per node for the
// rest. Leaves M * step in `product`.
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
    multiply_rows(s, chunk, 0, product);
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

// Moves the forces of one kind of instances from `summed_at` to x; `by_node` holds the difference. Returns
// their energy.
static inline float move_forces(const System* s, const int k, int count, global const int* nodes,
                                global const float4* arms, global float4* forces) {
  float energy = 0;
  FOR_EACH(instance, count) {
    float4 x = 0, y = 0, z = 0;
    for (int slot = k * instance; slot < k * (instance + 1); ++slot) {
      global const float4* moved = (global const float4*)(s->by_node + nodes[slot]);
      x += arms[slot] * moved[0];
      y += arms[slot] * moved[1];
      z += arms[slot] * moved[2];
    }
    float4 force = forces[instance];
    force.xyz += force.w * (float3)(sum4(x), sum4(y), sum4(z));
    forces[instance] = force;
    if (force.w > 0) energy += (force.x * force.x + force.y * force.y + force.z * force.z) / force.w;
  }
  return energy;
}

static inline void add_forces(int node, const int k, FORCE_ARGUMENTS(), float4* gradient) {
  for (int e = starts_[node]; e < starts_[node + 1]; ++e) {
    const int instance = entries_[e] / SLOTS;
    const float4 arm = arms_[instance * k + entries_[e] % SLOTS];
    const float4 force = forces_[instance];
    gradient[0] += force.x * arm;
    gradient[1] += force.y * arm;
    gradient[2] += force.z * arm;
  }
}

// Sums the gradient anew over the instances: updated by M times step after step it gathers rounding errors
// which the worse conditioned a problem is the more weigh. Returns the energy of the instances.
float sum_gradient(const System* s, int edge_count, global const int* edge_nodes, FORCE_ARGUMENTS(edges),
                   int constraint_count, global const int* constraint_nodes, FORCE_ARGUMENTS(constraints),
                   local float* scratch) {
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
  const float16 part =
      (float16)(move_forces(s, 2, edge_count, edge_nodes, arms_edges, forces_edges),
                move_forces(s, K, constraint_count, constraint_nodes, arms_constraints, forces_constraints),
                0, 0, (float4)(0), (float8)(0));
  SYNC;
  FOR_EACH(chunk, s->chunks) {
    float16 m[16];
    for (int n = 0; n < 16; ++n) {
      float4 sum[3] = {0, 0, 0};
      add_forces(16 * chunk + n, 2, FORCES(edges), sum);
      add_forces(16 * chunk + n, K, FORCES(constraints), sum);
      m[n] = (float16)(sum[0], sum[1], sum[2], (float4)(0));
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

// The whole course, from `unknowns` to `unknowns`. `partials`: energy of edges and constraints at the start;
// behind them it leaves the energy per node at the end. Words of status: see StatusWord; the energies it
// leaves are the changes that `conclude` turns into sums.
kernel __attribute__((reqd_work_group_size(LANES, 1, 1))) void solve(
    global int* status, int node_count, int chunks, int max_iterations, float tolerance, float least_damping,
    global const float* node_weights, global const int* rows, global const int* columns,
    global const float16* M, global float16* D, global float16* P, global float16* vectors,
    global const float4* gradient, int edge_count, global const int* edge_nodes, FORCE_ARGUMENTS(edges),
    int constraint_count, global const int* constraint_nodes, FORCE_ARGUMENTS(constraints), int partial_count,
    global float* partials, global float* unknowns) {
  local float scratch[LANES];
  const int length = 12 * chunks;
  System s = {node_count, chunks, node_weights, rows, columns, M, D, P, vectors};
  s.summed_at = s.x + length;
  s.gradient = s.summed_at + length;
  s.step = s.gradient + length;
  s.residual = s.step + length;
  s.direction = s.residual + length;
  s.product = s.direction + length;
  s.by_node = s.product + length;

  FOR_EACH(chunk, chunks) {
    float16 m[16], g[16];
    for (int n = 0; n < 16; ++n) {
      const int node = 16 * chunk + n;
      m[n] = node < node_count
                 ? (float16)(vload8(0, unknowns + 12 * node), vload4(2, unknowns + 12 * node), 0, 0, 0, 0)
                 : 0;
      g[n] = (float16)(gradient[3 * node], gradient[3 * node + 1], gradient[3 * node + 2], (float4)(0));
    }
    transpose(m);
    transpose(g);
    for (int entry = 0; entry < 12; ++entry) {
      s.x[12 * chunk + entry] = s.summed_at[12 * chunk + entry] = m[COLUMNWISE(entry)];
      s.gradient[12 * chunk + entry] = g[entry];
    }
  }
  float damping = least_damping;
  float energy = ordered_sum(partials, partial_count) + energy_per_node(&s, scratch);
  const float initial = energy;
  const float negligible = 1e-9f * initial;
  float summed_energy = energy;  // where the gradient was last summed
  int iteration = 0, linear_iterations = 0, fresh = 1;
  int termination = isfinite(energy) ? 0 : 4;
  while (termination == 0) {
    float16 part = 0;
    FOR_EACH(chunk, chunks) part += prepare(&s, chunk, damping, 4 * summed_energy / node_count);
    const float noise = total(part, scratch);
    const float wanted = tolerance * fmax(energy, negligible);
    const float settled = fmax(wanted, noise);
    const int used = conjugate_gradients(&s, fmax(LEAST_SHARE * wanted, noise), 12 * node_count + 1, scratch);
    linear_iterations += max(used, 0);
    float change = used == 0 ? 0.0f : INFINITY;
    if (used > 0) change = try_step(&s, scratch);
    if (used != 0) {
      const int accepted = change <= 0;  // false for NaN
      if (accepted) {
        energy += change;
        damping = fmax(damping * 0.1f, least_damping);
        FOR_EACH(chunk, chunks) for (int at = 12 * chunk; at < 12 * (chunk + 1); ++at) {
          s.x[at] += s.step[at];
          s.gradient[at] += s.product[at];
        }
      } else {
        damping = fmax(damping, 1e-6f) * 10;
      }
      if (get_local_id(0) == 0) status[16 + iteration] = as_int(accepted ? change : 0.0f);
      ++iteration;
    }
    if (fabs(change) <= settled && (fresh || noise <= wanted))
      termination = 1;
    else if (iteration >= max_iterations)
      termination = 2;
    else if (damping > 1e6f)
      termination = 3;
    fresh = 0;
    if (termination == 0 && fabs(change) <= settled) {
      energy = sum_gradient(&s, edge_count, edge_nodes, FORCES(edges), constraint_count, constraint_nodes,
                            FORCES(constraints), scratch) +
               energy_per_node(&s, scratch);
      summed_energy = energy;
      fresh = 1;
    }
  }
  FOR_EACH(chunk, chunks) {
    float16 m[16];
    for (int entry = 0; entry < 12; ++entry) m[COLUMNWISE(entry)] = s.x[12 * chunk + entry];
    for (int entry = 12; entry < 16; ++entry) m[entry] = 0;
    transpose(m);
    for (int n = 0; n < 16; ++n) {
      const int node = 16 * chunk + n;
      if (node >= node_count) break;
      vstore8(m[n].lo, 0, unknowns + 12 * node);
      vstore4(m[n].hi.lo, 2, unknowns + 12 * node);
    }
  }
  const float per_node = energy_per_node(&s, scratch);
  if (get_local_id(0) == 0) {
    partials[partial_count] = per_node;
    status[2] = iteration;
    status[7] = termination;
    status[8] = as_int(initial);
    status[9] = linear_iterations;
  }
}

// The final energy, summed anew, and from it the energies after each iteration: their changes are small
// and known to many digits, sums of large numbers are not.
kernel void conclude(global int* status, int partial_count, global const float* partials) {
  float energy = ordered_sum(partials, partial_count);
  status[4] = as_int(energy);
  for (int iteration = status[2] - 1; iteration >= 0; --iteration) {
    const float change = as_float(status[16 + iteration]);
    status[16 + iteration] = as_int(energy);
    energy -= change;
  }
  status[0] = 1;
}
