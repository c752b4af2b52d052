// Gauss-Newton on J^T J = M (x) I_3 + (12x12 per node) + (rows that couple the axes, never assembled).
//
// A node's unknowns are the rows of [D | t]: number 4 axis + c, c = 3 being t; the caller's order (columns of
// D, then t: 3 c + axis) is met only at the borders. All arrays run over `padded` nodes, a multiple of 16.
//
// A 4x4 block of M is one float16, entry 4 d + c = M[c][d]: with a row x of [D | t] spread as
// xxxxyyyyzzzzwwww the lanes hold M[c][d] x[d], to be added up over d once per block row. A 12x12 block is
// nine of these, number 3 a + b for the rows of axis a and the columns of axis b.
//
// `solve` runs the whole course in one work-group of LANES work-items: launches and waits would cost more
// than a second core gains. The order of every sum is fixed.

#ifndef CG_SPREAD
#define CG_SPREAD 10
#define CG_SHARE 0.1f
#define LEAST_SHARE 0.1f
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

// The order 4 axis + c of sixteen nodes' rows against lanes: transposes a 16x16 matrix in place.
void transpose(float16* m) {
  float16 other[16];
  for (int round = 0; round < 2; ++round) {
    for (int i = 0; i < 8; ++i) {
      other[2 * i].even = m[i].lo;
      other[2 * i].odd = m[i + 8].lo;
      other[2 * i + 1].even = m[i].hi;
      other[2 * i + 1].odd = m[i + 8].hi;
    }
    for (int i = 0; i < 8; ++i) {
      m[2 * i].even = other[i].lo;
      m[2 * i].odd = other[i + 8].lo;
      m[2 * i + 1].even = other[i].hi;
      m[2 * i + 1].odd = other[i + 8].hi;
    }
  }
}

// Unknowns of nodes 16 chunk and on, as the equations want them: column by column, a node a lane.
void load_forms(global const float* x, int chunk, float16* u) {
  float16 m[16];
  for (int n = 0; n < 16; ++n) m[n] = vload16(0, x + 12 * (16 * chunk + n));
  transpose(m);
  for (int c = 0; c < 4; ++c)
    for (int axis = 0; axis < 3; ++axis) u[3 * c + axis] = m[4 * axis + c];
}

float16 inside(int chunk, int node_count) {
  const float16 lanes = (float16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  return select((float16)(0), (float16)(1), lanes + 16 * chunk < (float)node_count);
}

float total(float4 part, local float* scratch) {
#if LANES == 1
  return sum4(part);
#else
  scratch[get_local_id(0)] = sum4(part);
  for (int half_count = LANES / 2; half_count > 0; half_count /= 2) {
    barrier(CLK_LOCAL_MEM_FENCE);
    if (get_local_id(0) < half_count) scratch[get_local_id(0)] += scratch[get_local_id(0) + half_count];
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  const float sum = scratch[0];
  barrier(CLK_LOCAL_MEM_FENCE);
  return sum;
#endif
}

#define AT(m, n) ((m) * ((m) + 1) / 2 + (n))

// Inverse of a symmetric positive semi-definite 12x12 matrix (packed lower triangle), a node a lane, by the
// sweep operator on the matrix scaled to a diagonal of ones. What nothing determines gets zeros: there the
// preconditioner does not move.
void invert(float16* packed) {
  float16 scale[12];
  for (int m = 0; m < 12; ++m) {
    const float16 d = packed[AT(m, m)];
    scale[m] = select((float16)(0), rsqrt(d), d > 1e-30f);
  }
  for (int m = 0; m < 12; ++m)
    for (int n = 0; n <= m; ++n) packed[AT(m, n)] *= scale[m] * scale[n];
  for (int pivot = 0; pivot < 12; ++pivot) {
    const float16 d = packed[AT(pivot, pivot)];
    const float16 inverse = select((float16)(0), 1 / d, d > 1e-5f);
    float16 column[12];
    for (int m = 0; m < pivot; ++m) column[m] = packed[AT(pivot, m)];
    column[pivot] = 0;
    for (int m = pivot + 1; m < 12; ++m) column[m] = packed[AT(m, pivot)];
    for (int m = 0; m < 12; ++m) {
      const float16 factor = column[m] * inverse;
      for (int n = 0; n <= m; ++n) packed[AT(m, n)] -= factor * column[n];
    }
    for (int m = 0; m < pivot; ++m) packed[AT(pivot, m)] = column[m] * inverse;
    for (int m = pivot + 1; m < 12; ++m) packed[AT(m, pivot)] = column[m] * inverse;
    packed[AT(pivot, pivot)] = -inverse;
  }
  for (int m = 0; m < 12; ++m)
    for (int n = 0; n <= m; ++n) packed[AT(m, n)] *= -scale[m] * scale[n];
}

void store_blocks(const float16* packed, int chunk, global float16* blocks) {
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) {
      float16 m[16];
      for (int d = 0; d < 4; ++d)
        for (int c = 0; c < 4; ++c) {
          const int row = 4 * a + c, column = 4 * b + d;
          m[4 * d + c] = packed[row >= column ? AT(row, column) : AT(column, row)];
        }
      transpose(m);
      for (int n = 0; n < 16; ++n) blocks[9 * (16 * chunk + n) + 3 * a + b] = m[n];
    }
}

// y += block * x for one 12x12 block, the sums over d still open.
void multiply_block(global const float16* block, const float4* x, float16* y) {
  const float16 x0 = SPREAD(x[0]), x1 = SPREAD(x[1]), x2 = SPREAD(x[2]);
  for (int a = 0; a < 3; ++a) y[a] += block[3 * a] * x0 + block[3 * a + 1] * x1 + block[3 * a + 2] * x2;
}

// y += row of M (from its place `first` on) * x, likewise.
void multiply_row(int node, int first, global const int* rows, global const int* columns,
                  global const float16* M, global const float4* x, float16* y) {
  for (int block = rows[node] + first; block < rows[node + 1]; ++block) {
    const float16 m = M[block];
    global const float4* other = x + 3 * columns[block];
    y[0] += m * SPREAD(other[0]);
    y[1] += m * SPREAD(other[1]);
    y[2] += m * SPREAD(other[2]);
  }
}

// -------------------------------------------------------------------------------------- Gauss-Newton itself

// Everything that a sweep over the nodes looks at.
typedef struct {
  int node_count, padded;
  global const float* node_weights;
  global const int* rows;
  global const int* columns;
  global const float16* M;
  global float16* D;        // diagonal blocks of what is solved: M + energies per node, damped
  global float16* P;        // inverses of the diagonal blocks
  global float4* x;         // unknowns, three rows a node, like all that follow
  global float4* gradient;  // half the gradient of what separates
  global float4* step;
  global float4* residual;  // of the linear system
  global float4* direction;
  global float4* product;
} System;

// Builds D, P and the right-hand side of sixteen nodes; returns the energy of the terms per node.
float4 prepare(const System* s, int chunk, float damping) {
  float16 u[12], packed[78], force[12], m[16];
  load_forms((global const float*)s->x, chunk, u);
  for (int entry = 0; entry < 78; ++entry) packed[entry] = 0;
  for (int entry = 0; entry < 12; ++entry) force[entry] = 0;
  const float16 energy = add_node_terms(u, inside(chunk, s->node_count), s->node_weights, packed, force);

  for (int n = 0; n < 16; ++n) m[n] = s->M[s->rows[16 * chunk + n]];
  transpose(m);
  for (int axis = 0; axis < 3; ++axis)
    for (int c = 0; c < 4; ++c)
      for (int d = 0; d <= c; ++d) packed[AT(4 * axis + c, 4 * axis + d)] += m[4 * d + c];
  for (int entry = 0; entry < 12; ++entry) packed[AT(entry, entry)] *= 1 + damping;
  store_blocks(packed, chunk, s->D);
  invert(packed);
  store_blocks(packed, chunk, s->P);

  for (int entry = 0; entry < 12; ++entry) m[entry] = force[entry];
  for (int entry = 12; entry < 16; ++entry) m[entry] = 0;
  transpose(m);
  for (int n = 0; n < 16; ++n) {
    const int node = 16 * chunk + n;
    s->residual[3 * node] = -(s->gradient[3 * node] + m[n].lo.lo);
    s->residual[3 * node + 1] = -(s->gradient[3 * node + 1] + m[n].lo.hi);
    s->residual[3 * node + 2] = -(s->gradient[3 * node + 2] + m[n].hi.lo);
  }
  return fold(energy);
}

// direction = P residual; returns residual . P residual.
float4 precondition(const System* s, int node, float4* z) {
  const float4 r[3] = {s->residual[3 * node], s->residual[3 * node + 1], s->residual[3 * node + 2]};
  float16 y[3] = {0, 0, 0};
  multiply_block(s->P + 9 * node, r, y);
  float4 part = 0;
  for (int axis = 0; axis < 3; ++axis) {
    z[axis] = fold(y[axis]);
    part += z[axis] * r[axis];
  }
  return part;
}

// Solves for the step until a further iteration would lower the energy by less than `least`, or by less
// than a share of what has been gained. Returns the number of iterations.
int conjugate_gradients(const System* s, float least, int most_iterations, local float* scratch) {
  float4 part = 0;
  FOR_EACH(node, s->padded) {
    float4 z[3];
    part += precondition(s, node, z);
    for (int axis = 0; axis < 3; ++axis) {
      s->direction[3 * node + axis] = z[axis];
      s->step[3 * node + axis] = 0;
    }
  }
  float rz = total(part, scratch);
  float gained = 0;
  int iteration = 0;
  // rz bounds from below, within the spread of the preconditioned spectrum, what is left to gain
  while (iteration < most_iterations && rz > least) {
    SYNC;
    part = 0;
    FOR_EACH(node, s->padded) {
      const float4 p[3] = {s->direction[3 * node], s->direction[3 * node + 1], s->direction[3 * node + 2]};
      float16 y[3] = {0, 0, 0};
      multiply_block(s->D + 9 * node, p, y);
      multiply_row(node, 1, s->rows, s->columns, s->M, s->direction, y);
      for (int axis = 0; axis < 3; ++axis) {
        const float4 q = fold(y[axis]);
        s->product[3 * node + axis] = q;
        part += q * p[axis];
      }
    }
    const float curvature = total(part, scratch);
    if (!(curvature > 0)) break;
    ++iteration;
    const float alpha = rz / curvature;
    const float gain = alpha * rz;
    gained += gain;
    const int last = gain * CG_SPREAD < max(CG_SHARE * gained, least);
    part = 0;
    SYNC;
    FOR_EACH(node, s->padded) {
      for (int axis = 0; axis < 3; ++axis) {
        s->step[3 * node + axis] += alpha * s->direction[3 * node + axis];
        s->residual[3 * node + axis] -= alpha * s->product[3 * node + axis];
      }
      if (last) continue;
      float4 z[3];
      part += precondition(s, node, z);
      for (int axis = 0; axis < 3; ++axis) s->product[3 * node + axis] = z[axis];
    }
    if (last) break;
    const float next = total(part, scratch);
    const float beta = next / rz;
    rz = next;
    SYNC;
    FOR_EACH(entry, 3 * s->padded) s->direction[entry] = s->product[entry] + beta * s->direction[entry];
  }
  SYNC;
  return iteration;
}

// What the step changes the energy by: exactly so for what is quadratic, as a difference per node for the
// rest. Leaves M * step in `product`.
float try_step(const System* s, local float* scratch) {
  float4 part = 0;
  FOR_EACH(node, s->padded) {
    float16 y[3] = {0, 0, 0};
    multiply_row(node, 0, s->rows, s->columns, s->M, s->step, y);
    for (int axis = 0; axis < 3; ++axis) {
      const int row = 3 * node + axis;
      const float4 q = fold(y[axis]);
      s->product[row] = q;
      part += s->step[row] * (q + 2 * s->gradient[row]);
    }
  }
  const float quadratic = total(part, scratch);
  part = 0;
  FOR_EACH(chunk, s->padded / 16) {
    float16 u[12], v[12];
    load_forms((global const float*)s->x, chunk, u);
    load_forms((global const float*)s->step, chunk, v);
    for (int entry = 0; entry < 12; ++entry) v[entry] += u[entry];
    part += fold(change_of_node_terms(u, v, inside(chunk, s->node_count), s->node_weights));
  }
  return quadratic + total(part, scratch);
}

float energy_per_node(const System* s, local float* scratch) {
  float4 part = 0;
  FOR_EACH(chunk, s->padded / 16) {
    float16 u[12];
    load_forms((global const float*)s->x, chunk, u);
    part += fold(energy_of_node_terms(u, inside(chunk, s->node_count), s->node_weights));
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
    global int* status, int node_count, int padded, int max_iterations, float tolerance, float least_damping,
    global const float* node_weights, global const int* rows, global const int* columns,
    global const float16* M, global float16* D, global float16* P, global float4* vectors,
    global float4* gradient, int partial_count, global float* partials, global float* unknowns) {
  local float scratch[LANES];
  System s = {node_count, padded, node_weights, rows, columns, M, D, P, vectors, gradient};
  s.step = vectors + 3 * padded + 4;
  s.residual = s.step + 3 * padded + 4;
  s.direction = s.residual + 3 * padded + 4;
  s.product = s.direction + 3 * padded + 4;

  FOR_EACH(node, padded) for (int axis = 0; axis < 3; ++axis) {
    global const float* form = unknowns + 12 * node + axis;
    s.x[3 * node + axis] = node < node_count ? (float4)(form[0], form[3], form[6], form[9]) : (float4)(0);
  }
  SYNC;
  float damping = least_damping;
  float energy = ordered_sum(partials, partial_count) + energy_per_node(&s, scratch);
  const float negligible = 1e-6f * energy;  // of the start: digits that single precision does not have
  const float initial = energy;
  int iteration = 0, linear_iterations = 0;
  int termination = isfinite(energy) ? 0 : 4;
  while (termination == 0) {
    FOR_EACH(chunk, padded / 16) prepare(&s, chunk, damping);
    SYNC;
    const float least = tolerance * max(energy, negligible);
    const int used = conjugate_gradients(&s, LEAST_SHARE * least, 12 * node_count + 1, scratch);
    linear_iterations += used;
    if (used == 0) {  // nothing left to gain
      termination = 1;
      break;
    }
    const float change = try_step(&s, scratch);
    const int accepted = change <= 0;  // false for NaN
    SYNC;
    if (accepted) {
      energy += change;
      damping = fmax(damping * 0.1f, least_damping);
      FOR_EACH(row, 3 * padded) {
        s.x[row] += s.step[row];
        s.gradient[row] += s.product[row];
      }
    } else {
      damping = fmax(damping, 1e-6f) * 10;
    }
    if (get_local_id(0) == 0) status[16 + iteration] = as_int(accepted ? change : 0.0f);
    ++iteration;
    if (fabs(change) <= least)
      termination = 1;
    else if (iteration >= max_iterations)
      termination = 2;
    else if (damping > 1e6f)
      termination = 3;
    SYNC;
  }
  FOR_EACH(node, node_count) for (int axis = 0; axis < 3; ++axis) {
    const float4 row = s.x[3 * node + axis];
    global float* form = unknowns + 12 * node + axis;
    form[0] = row.x;
    form[3] = row.y;
    form[6] = row.z;
    form[9] = row.w;
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
