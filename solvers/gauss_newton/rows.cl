// One energy per edge or per constraint, seen as rows over slots: an instance looks at K nodes, and each of
// its three values is sum over slots of arm . (row of the node's [D | t]). Compiled once per energy, after
// its equation.h over float; KERNEL(x) names the kernels after the energy.
//
// Of an axis-separable energy without a robust loss (SEPARABLE) `forces` keeps per instance J^T r along x, y,
// z and J^T J (the same for each axis, 0 between them); of others `forces` keeps J^T r and `couplings` J^T J
// (xx xy xz yy yz zz). LOSS_VALUE and LOSS_WEIGHT are the loss of the squared residual.

#define CHUNK 64  // instances per work-item: partial sums of the energy in order, no atomics

#if PER_EDGE
kernel void KERNEL(arms)(global const float* node_points, int count, global const int* nodes, int first,
                         global float4* arms) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const float3 e =
      vload3(nodes[2 * (first + i) + 1], node_points) - vload3(nodes[2 * (first + i)], node_points);
  const float data[3] = {e.x, e.y, e.z};
  float row[8];
  NAME_ROW(data, row);
  arms[2 * (first + i)] = vload4(0, row);
  arms[2 * (first + i) + 1] = vload4(1, row);
}
#endif

float3 displacement(int instance, global const int* nodes, global const float4* arms,
                    global const float* unknowns) {
  float3 sum = 0;
  for (int slot = K * instance; slot < K * (instance + 1); ++slot) {
    const float4 arm = arms[slot];
    global const float* form = unknowns + 12 * nodes[slot];
    sum +=
        arm.x * vload3(0, form) + arm.y * vload3(1, form) + arm.z * vload3(2, form) + arm.w * vload3(3, form);
  }
  return sum;
}

kernel void KERNEL(evaluate)(global const int* status, int count, float weight, float loss_scale,
                             global const float* unknowns, int first, global const int* nodes,
                             global const float4* arms, global const float* node_points,
                             global const float* data, global const float* confidence, int add,
                             global float4* forces, global float8* couplings, int first_partial,
                             global float* partials) {
  const int begin = get_global_id(0) * CHUNK;
  if (status[0] || begin >= count) return;
  float energy = 0;
  for (int i = begin; i < min(begin + CHUNK, count); ++i) {
    const int instance = first + i;
    float4 force = 0;
    float8 coupling = 0;
    const float3 moved = displacement(instance, nodes, arms, unknowns);
    float r[ROWS];
#if PER_EDGE
    const float factor = weight;
    const float3 e = vload3(nodes[2 * instance + 1], node_points) - vload3(nodes[2 * instance], node_points);
    const float given[3] = {e.x, e.y, e.z};
    const float rest[24] = {0};
    NAME_RESIDUAL(rest, given, r);
    r[0] += moved.x;
    r[1] += moved.y;
    r[2] += moved.z;
    force = factor * (float4)(r[0], r[1], r[2], 1);
    energy += factor * (r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
#else
    float factor = weight * confidence[i];
    if (factor > 0) {  // else not in force: what stands in data may be anything
      const float u[3] = {moved.x, moved.y, moved.z};
      float given[6];
      for (int entry = 0; entry < 6; ++entry) given[entry] = data[6 * i + entry];
      NAME_RESIDUAL(u, given, r);
      float sum = 0;
      for (int row = 0; row < ROWS; ++row) sum += r[row] * r[row];
      energy += factor * LOSS_VALUE(sum, loss_scale);
#if SEPARABLE
      float scale;
      NAME_ROW(given, &scale);
      force = factor * scale * (float4)(r[0], r[1], r[2], scale);
#else
      factor *= LOSS_WEIGHT(sum, loss_scale);
      float J[3 * ROWS];
      NAME_JACOBIAN(u, given, J);
      for (int row = 0; row < ROWS; ++row) {
        const float3 gradient = vload3(row, J);
        force.xyz += factor * r[row] * gradient;
        coupling +=
            factor * (float8)(gradient.x * gradient, gradient.y * gradient.yz, gradient.z * gradient.z, 0, 0);
      }
#endif
    }
#endif
    forces[instance] = add ? forces[instance] + force : force;
#if !PER_EDGE && !SEPARABLE
    couplings[instance] = add ? couplings[instance] + coupling : coupling;
#endif
  }
  partials[first_partial + get_global_id(0)] = energy;
}

#if !PER_EDGE && !SEPARABLE
// What `step` changes the energy by, without losing the digits of a small difference.
kernel void KERNEL(change)(global const int* status, int count, float weight, float loss_scale,
                           global const float* unknowns, global const float* step, int first,
                           global const int* nodes, global const float4* arms, global const float* data,
                           global const float* confidence, int first_change, global float* changes) {
  const int begin = get_global_id(0) * CHUNK;
  if (status[0] || begin >= count) return;
  float sum = 0;
  for (int i = begin; i < min(begin + CHUNK, count); ++i) {
    const float factor = weight * confidence[i];
    if (!(factor > 0)) continue;
    const float3 moved = displacement(first + i, nodes, arms, unknowns);
    const float3 way = displacement(first + i, nodes, arms, step);
    const float u[3] = {moved.x, moved.y, moved.z};
    const float v[3] = {moved.x + way.x, moved.y + way.y, moved.z + way.z};
    float given[6], before[ROWS], after[ROWS];
    for (int entry = 0; entry < 6; ++entry) given[entry] = data[6 * i + entry];
    NAME_RESIDUAL(u, given, before);
    NAME_RESIDUAL(v, given, after);
    float squared = 0, gain = 0;
    for (int row = 0; row < ROWS; ++row) {
      squared += before[row] * before[row];
      gain += (after[row] - before[row]) * (after[row] + before[row]);
    }
#if ROBUST
    if (fabs(gain) < 0.01f * squared)
      gain *= LOSS_WEIGHT(squared + 0.5f * gain, loss_scale);
    else
      gain = LOSS_VALUE(fmax(squared + gain, 0.0f), loss_scale) - LOSS_VALUE(squared, loss_scale);
#endif
    sum += factor * gain;
  }
  changes[first_change + get_global_id(0)] = sum;
}
#endif
