// Damped Gauss-Newton. It runs in one work-group, whole in one kernel (`solve`) unless something has to be
// evaluated between its steps: launches and waits would cost more than a second core gains. The order of
// every sum is fixed.

#define ROUNDING 3.6e-15f  // the square of the relative rounding error of single precision

// Where a minimisation stands; between kernels it lies in a buffer.
typedef struct {
  float energy, initial_energy;
  float summed_energy;  // where the gradient was last summed over the instances
  float damping;
  float noise;      // changes of the energy that single precision cannot see
  float threshold;  // change of the energy that ends the minimisation
  float change;     // of the energy, by the step in hand; without what is coupled
  int iteration, linear_iterations;
  int cg_iterations;       // iterations of the linear solver for the step in hand; -1: there was no solution
  int most_cg_iterations;  // most that a step has used
  int fresh;               // the gradient has just been summed
  int termination;
} State;

// Builds D, its factors and the right-hand side of a batch. Returns what the preconditioner makes of the
// rounding errors in that right-hand side, which come of energies of the size `mean` a node, and of how far x
// has moved since the gradient was last summed: gains below are not to be believed.
static inline float16 prepare(const System* s, int batch, float damping, float mean) {
  float16 u[12], packed[78], gradient[12], m[16];
  for (int entry = 0; entry < 12; ++entry) u[COLUMNWISE(entry)] = s->x[12 * batch + entry];
  for (int entry = 0; entry < 78; ++entry) packed[entry] = 0;
  for (int entry = 0; entry < 12; ++entry) gradient[entry] = s->gradient[12 * batch + entry];
  add_node_terms(u, inside(batch, s->node_count), s->node_weights, packed, gradient);

  for (int n = 0; n < 16; ++n) m[n] = s->M[s->row_starts[16 * batch + n]];
  transpose(m);
  for (int axis = 0; axis < 3; ++axis)
    for (int c = 0; c < 4; ++c)
      for (int d = 0; d <= c; ++d) packed[AT(4 * axis + c, 4 * axis + d)] += m[4 * d + c];
  for (int entry = 0; entry < 12; ++entry) {
    float16 whole = packed[AT(entry, entry)];
#if COUPLED
    whole += s->C[78 * batch + AT(entry, entry)];
    gradient[entry] += s->coupled_gradient[12 * batch + entry];
#endif
    packed[AT(entry, entry)] += damping * whole;
  }
  for (int entry = 0; entry < 78; ++entry) s->D[78 * batch + entry] = packed[entry];
#if COUPLED
  for (int entry = 0; entry < 78; ++entry) packed[entry] += s->C[78 * batch + entry];
#endif
  float16 errors[12], size = mean, noise = 0;
  for (int entry = 0; entry < 12; ++entry) {
    const float16 d = packed[AT(entry, entry)];
    const float16 moved = s->x[12 * batch + entry] - s->summed_at[12 * batch + entry];
    size += d * moved * moved;
    m[entry] = sqrt(d) * (float16)(1, 1, -1, 1, -1, -1, 1, -1, -1, 1, 1, 1, -1, 1, -1, -1) *
               (entry % 3 == 1 ? -1 : 1);
    errors[entry] = m[entry];
  }
  factor(packed);
  for (int entry = 0; entry < 78; ++entry) s->P[78 * batch + entry] = packed[entry];
  solve_packed(s->P + 78 * batch, errors);
  for (int entry = 0; entry < 12; ++entry) {
    noise += m[entry] * errors[entry];
    s->residual[12 * batch + entry] = -gradient[entry];
  }
  return ROUNDING * size * noise;
}

// What the step changes the energy by, without what is coupled: exactly so for what is quadratic, as a
// difference per node for the rest. Leaves M * step in `product`.
float try_step(const System* s, local float* scratch) {
  SYNC;
  FOR_EACH(batch, s->batches) {
    float16 step[12];
    for (int entry = 0; entry < 12; ++entry) step[entry] = s->step[12 * batch + entry];
    store_by_node(step, batch, s->by_node);
  }
  SYNC;
  float16 part = 0;
  FOR_EACH(batch, s->batches) {
    float16 product[12], u[12], v[12];
    multiply_blocks(s, batch, 0, 0, product);
    for (int entry = 0; entry < 12; ++entry) {
      const int at = 12 * batch + entry;
      part += s->step[at] * (product[entry] + 2 * s->gradient[at]);
      s->product[at] = product[entry];
      u[COLUMNWISE(entry)] = s->x[at];
      v[COLUMNWISE(entry)] = s->x[at] + s->step[at];
    }
    part += change_of_node_terms(u, v, inside(batch, s->node_count), s->node_weights);
  }
  return group_sum(sum16(part), scratch);
}

// Moves the contributions of one kind of instances from `summed_at` to x; by_node holds the difference.
// Returns their energy.
static inline float move_contributions(const System* s, const int k, Instances kind) {
  float energy = 0;
  FOR_EACH(instance, kind.count) {
    float4 contribution = kind.contributions[instance];
    contribution.xyz += contribution.w * moved_by(instance, k, kind, s->by_node);
    kind.contributions[instance] = contribution;
    if (contribution.w > 0)
      energy += (contribution.x * contribution.x + contribution.y * contribution.y +
                 contribution.z * contribution.z) /
                contribution.w;
  }
  return energy;
}

// Sums the gradient anew over the instances: updated by M step after step it gathers rounding errors, which
// weigh the more the worse a problem is conditioned. Returns the energy of the instances.
float sum_gradient(const System* s, local float* scratch) {
  FOR_EACH(batch, s->batches) {
    float16 moved[12];
    for (int entry = 0; entry < 12; ++entry) {
      const int at = 12 * batch + entry;
      moved[entry] = s->x[at] - s->summed_at[at];
      s->summed_at[at] = s->x[at];
    }
    store_by_node(moved, batch, s->by_node);
  }
  SYNC;
  const float16 part = (float16)(move_contributions(s, 2, s->edges), move_contributions(s, K, s->constraints),
                                 0, 0, (float4)(0), (float8)(0));
  SYNC;
  FOR_EACH(batch, s->batches) {
    float16 m[16];
    for (int n = 0; n < 16; ++n) {
      const float16 sum = add_contributions(16 * batch + n, 2, s->edges, s->edges.contributions, 0);
      m[n] = add_contributions(16 * batch + n, K, s->constraints, s->constraints.contributions, sum);
    }
    transpose(m);
    for (int entry = 0; entry < 12; ++entry) s->gradient[12 * batch + entry] = m[entry];
  }
  return group_sum(sum16(part), scratch);
}

float energy_per_node(const System* s, local float* scratch) {
  float16 part = 0;
  FOR_EACH(batch, s->batches) {
    float16 u[12];
    for (int entry = 0; entry < 12; ++entry) u[COLUMNWISE(entry)] = s->x[12 * batch + entry];
    part += energy_of_node_terms(u, inside(batch, s->node_count), s->node_weights);
  }
  return group_sum(sum16(part), scratch);
}

// `partials`: energy of edges and constraints; gets the energy per node behind them. `assembled`: gradient of
// what separates, node by node.
State begin_minimisation(const System* s, global const float* unknowns, global const float16* assembled,
                         int partial_count, global float* partials, local float* scratch) {
  FOR_EACH(batch, s->batches) {
    float16 m[16], g[16];
    for (int n = 0; n < 16; ++n) {
      const int node = 16 * batch + n;
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
      s->x[12 * batch + entry] = s->summed_at[12 * batch + entry] = m[COLUMNWISE(entry)];
      s->gradient[12 * batch + entry] = g[entry];
    }
  }
  const float per_node = energy_per_node(s, scratch);
  if (get_local_id(0) == 0) partials[partial_count] = per_node;
  SYNC;
  State state = {0};
  state.energy = ordered_sum(partials, partial_count + 1);  // to the bit what `conclude` would say
  state.initial_energy = state.summed_energy = state.energy;
  state.damping = s->least_damping;
  state.fresh = 1;
  state.termination = isfinite(state.energy) ? 0 : 4;
  return state;
}

void make_step(const System* s, State* state, local float* scratch) {
  float16 part = 0;
  const float mean = 4 * state->summed_energy / s->node_count;
  FOR_EACH(batch, s->batches) part += prepare(s, batch, state->damping, mean);
  state->noise = group_sum(sum16(part), scratch);
  state->threshold = s->tolerance * fmax(state->energy, 1e-9f * state->initial_energy);
  // What is left to gain is the residual times the spread of the spectrum, which the iterations so far tell.
  const float spread = fmax(1.0f, 0.0625f * state->most_cg_iterations * state->most_cg_iterations);
  state->cg_iterations =
      conjugate_gradients(s, fmax(0.1f * state->threshold, state->noise) / spread, scratch);
  state->most_cg_iterations = max(state->most_cg_iterations, state->cg_iterations);
  state->change = state->cg_iterations > 0    ? try_step(s, scratch)
                  : state->cg_iterations == 0 ? 0.0f
                                              : INFINITY;
}

// Takes a step that lowers the energy; otherwise damps [thesis 4.6, OPEN]. Ends when the energy has
// stopped changing (1), after the last iteration (2) or when no damping helps (3). `energies`: the changes.
void decide(const System* s, State* state, global int* energies, local float* scratch) {
  const float change = state->change;
  if (state->cg_iterations != 0) {
    const int accepted = change <= 0;  // false for NaN
    if (accepted) {
      state->energy += change;
      state->damping = fmax(state->damping * 0.1f, s->least_damping);
      FOR_EACH(batch, s->batches) for (int at = 12 * batch; at < 12 * (batch + 1); ++at) {
        s->x[at] += s->step[at];
        s->gradient[at] += s->product[at];
      }
    } else {
      state->damping = fmax(state->damping, 1e-6f) * 10;
    }
    if (get_local_id(0) == 0) energies[state->iteration] = as_int(accepted ? change : 0.0f);
    ++state->iteration;
    state->linear_iterations += max(state->cg_iterations, 0);
  }
  const int settled = fabs(change) <= fmax(state->threshold, state->noise);
  if (settled && (state->fresh || state->noise <= state->threshold))
    state->termination = 1;
  else if (state->iteration >= s->max_iterations)
    state->termination = 2;
  else if (state->damping > 1e6f)
    state->termination = 3;
  state->fresh = 0;
  if (state->termination == 0 && settled) {
    const float energy = sum_gradient(s, scratch) + energy_per_node(s, scratch);
#if !COUPLED
    state->energy = energy;
#endif
    state->summed_energy = state->energy;
    state->fresh = 1;
  }
}

// `partials` gets the energy per node behind those of edges and constraints.
void end_minimisation(const System* s, const State* state, global int* status, int partial_count,
                      global float* partials, global float* unknowns, local float* scratch) {
  store_columnwise(s, s->x, unknowns);
  const float per_node = energy_per_node(s, scratch);
  if (get_local_id(0) == 0) {
    partials[partial_count] = per_node;
    status[0] = 0;
    status[2] = state->iteration;
    status[4] = as_int(state->energy);
    status[7] = state->termination;
    status[8] = as_int(state->initial_energy);
    status[9] = state->linear_iterations;
  }
}

#define MINIMISER_KERNEL kernel __attribute__((reqd_work_group_size(GROUP_SIZE, 1, 1))) void

#if !COUPLED
// The whole minimisation, from `unknowns` to `unknowns`. Words of status: see StatusWord; the energies it
// leaves are the changes that `conclude` turns into sums.
MINIMISER_KERNEL solve(global int* status, SYSTEM_ARGUMENTS, global const float16* assembled,
                       int partial_count, global float* partials, global float* unknowns) {
  local float scratch[GROUP_SIZE];
  const System s = MAKE_SYSTEM;
  State state = begin_minimisation(&s, unknowns, assembled, partial_count, partials, scratch);
  while (state.termination == 0) {
    make_step(&s, &state, scratch);
    decide(&s, &state, status + 16, scratch);
  }
  end_minimisation(&s, &state, status, partial_count, partials, unknowns, scratch);
}
#else
// The same in pieces. While a step is in hand, `trial` holds it in the caller's order.
MINIMISER_KERNEL begin(global int* status, SYSTEM_ARGUMENTS, global const float16* assembled,
                       int partial_count, global float* partials, global const float* unknowns,
                       global State* kept) {
  local float scratch[GROUP_SIZE];
  const System s = MAKE_SYSTEM;
  const State state = begin_minimisation(&s, unknowns, assembled, partial_count, partials, scratch);
  if (get_local_id(0) == 0) {
    *kept = state;
    status[0] = state.termination;
  }
}

MINIMISER_KERNEL next_step(global const int* status, SYSTEM_ARGUMENTS, global State* kept,
                           global float* trial) {
  local float scratch[GROUP_SIZE];
  if (status[0]) return;
  const System s = MAKE_SYSTEM;
  State state = *kept;
  make_step(&s, &state, scratch);
  store_columnwise(&s, s.step, trial);
  if (get_local_id(0) == 0) *kept = state;
}

// `changes`: of the energy of what is coupled, by the step in hand.
MINIMISER_KERNEL take_step(global int* status, SYSTEM_ARGUMENTS, global State* kept, int change_count,
                           global const float* changes, global float* unknowns) {
  local float scratch[GROUP_SIZE];
  if (status[0]) return;
  const System s = MAKE_SYSTEM;
  State state = *kept;
  SYNC;
  if (state.cg_iterations > 0) state.change += ordered_sum(changes, change_count);
  decide(&s, &state, status + 16, scratch);
  store_columnwise(&s, s.x, unknowns);
  if (get_local_id(0) == 0) {
    *kept = state;
    status[0] = state.termination;
  }
}

MINIMISER_KERNEL end(global int* status, SYSTEM_ARGUMENTS, global const State* kept, int partial_count,
                     global float* partials, global float* unknowns) {
  local float scratch[GROUP_SIZE];
  const System s = MAKE_SYSTEM;
  const State state = *kept;
  end_minimisation(&s, &state, status, partial_count, partials, unknowns, scratch);
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
