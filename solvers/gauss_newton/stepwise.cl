// The state of a Gauss-Newton minimisation, kept on the device, which decides by it.
// Words of status: see StatusWord in linear_solver.h. Single work-items; the work is a few numbers.

kernel void begin(global int* status, global const float* partials, int count, float damping) {
  const float energy = ordered_sum(partials, count);
  status[3] = as_int(damping);
  status[4] = as_int(energy);
  status[8] = as_int(energy);
  if (!isfinite(energy)) {
    status[0] = 1;
    status[7] = 4;
  }
}

kernel void try_step(global const int* status, int count, global const float* unknowns,
                     global const float* step, global float* trial) {
  const int i = get_global_id(0);
  if (status[0] || i >= count) return;
  trial[i] = unknowns[i] + step[i];
}

// Accepts a step that lowers the energy; otherwise damps [thesis 4.6, OPEN]. Ends the solve when the
// energy has stopped changing (1 converged), after the last iteration (2) or when no damping helps (3).
kernel void decide(global int* status, global const float* partials, int count, int max_iterations,
                   float tolerance, float least_damping) {
  if (status[0]) return;
  const float energy = as_float(status[4]);
  const float trial = status[1] ? INFINITY : ordered_sum(partials, count);
  const float damping = as_float(status[3]);
  const int accepted = trial <= energy;  // false for NaN
  const int settled = fabs(energy - trial) <= tolerance * energy;
  status[5] = as_int(trial);
  status[6] = accepted;
  if (accepted) {
    status[4] = as_int(trial);
    status[3] = as_int(fmax(damping * 0.1f, least_damping));
  } else {
    status[3] = as_int(fmax(damping, 1e-6f) * 10);
  }
  status[16 + status[2]] = status[4];
  status[2] += 1;
  if (settled)
    status[7] = 1;
  else if (status[2] >= max_iterations)
    status[7] = 2;
  else if (as_float(status[3]) > 1e6f)
    status[7] = 3;
}

kernel void accept(global const int* status, int count, global const float* trial, global float* unknowns) {
  const int i = get_global_id(0);
  if (status[0] || !status[6] || i >= count) return;
  unknowns[i] = trial[i];
}

// Only after `accept` has run may the following kernels be skipped.
kernel void end_iteration(global int* status) {
  if (status[7]) status[0] = 1;
}
