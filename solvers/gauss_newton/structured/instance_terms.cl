// One energy per edge or per constraint, over slots: an instance looks at K nodes, and each of
// its three values is the sum over slots of lever arm . (row of the node's [D | t]). Compiled once per
// energy, behind lanes.cl and its equation.h over float16, for sixteen instances at once; KERNEL(x) names the
// kernels after the energy.
//
// Of an axis-separable energy without a robust loss (SEPARABLE) `contributions` keeps per instance J^T r
// along x, y, z and J^T J (the same for each axis, 0 between them); of others `contributions` keeps J^T r and
// `point_hessians` J^T J (xx xy xz yy yz zz). LOSS_VALUE and LOSS_WEIGHT are the loss of the squared
// residual.

#define CHUNK 64  // instances per work-item: partial sums of the energy in order, no atomics

// Instance `lane` of those from `begin` on; where there are no more before `end`, the last one again.
#define INSTANCE(lane) min(begin + (lane), end - 1)

// 1 for the lanes that hold an instance, else 0.
float16 occupied(int begin, int end) {
  const int16 lanes = (int16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  return select((float16)0, (float16)1, lanes < end - begin);
}

// By how much forms (columns of D, then t) move the instances along x, y, z.
void displacements(int first, int begin, int end, global const int* nodes, global const float4* lever_arms,
                   global const float* forms, float16* u) {
  float16 m[16];
  for (int lane = 0; lane < 16; ++lane) {
    float16 sum = 0;
    const int slots = K * (first + INSTANCE(lane));
    for (int slot = slots; slot < slots + K; ++slot) {
      global const float* form = forms + 12 * nodes[slot];
      sum += lever_arms[slot].xxxyyyzzzwwwwwww * (float16)(vload8(0, form), vload4(2, form), (float4)0);
    }
    m[lane] = sum;
  }
  transpose(m);
  for (int axis = 0; axis < 3; ++axis) u[axis] = (m[axis] + m[3 + axis]) + (m[6 + axis] + m[9 + axis]);
}

#if PER_EDGE
// g_to - g_from of edges.
void load_given(int first, int begin, int end, global const int* nodes, global const float* node_points,
                float16* given) {
  float16 m[16];
  for (int lane = 0; lane < 16; ++lane) {
    const int slot = 2 * (first + INSTANCE(lane));
    const float3 e = vload3(nodes[slot + 1], node_points) - vload3(nodes[slot], node_points);
    m[lane] = (float16)(e, 0, (float4)0, (float8)0);
  }
  transpose(m);
  for (int axis = 0; axis < 3; ++axis) given[axis] = m[axis];
}

kernel void KERNEL(lever_arms)(global const float* node_points, int count, global const int* nodes, int first,
                               global float4* lever_arms) {
  const int begin = get_global_id(0) * 16;
  const int end = min(begin + 16, count);
  if (begin >= count) return;
  float16 data[3], row[16];
  load_given(first, begin, end, nodes, node_points, data);
  NAME_ROW(data, row);
  for (int entry = 8; entry < 16; ++entry) row[entry] = 0;
  transpose(row);
  for (int i = begin; i < end; ++i) {
    lever_arms[2 * (first + i)] = row[i - begin].lo.lo;
    lever_arms[2 * (first + i) + 1] = row[i - begin].lo.hi;
  }
}
#else
// q - p and the normal of constraints; returns their confidence.
float16 load_given(int begin, int end, global const float* data, global const float* confidence,
                   float16* given) {
  float16 m[16];
  for (int lane = 0; lane < 16; ++lane) {
    const int i = INSTANCE(lane);
    global const float* own = data + 6 * i;
    m[lane] = (float16)(vload4(0, own), vload2(2, own), confidence[i], 0, (float8)0);
  }
  transpose(m);
  for (int entry = 0; entry < 6; ++entry) given[entry] = m[entry];
  return m[6];
}
#endif

float16 squared(const float16* r) {
  float16 sum = 0;
  for (int row = 0; row < RESIDUALS; ++row) sum += r[row] * r[row];
  return sum;
}

kernel void KERNEL(evaluate)(global const int* status, int count, float weight, float loss_scale,
                             global const float* unknowns, int first, global const int* nodes,
                             global const float4* lever_arms, global const float* node_points,
                             global const float* data, global const float* confidence, int add,
                             global float4* contributions, global float8* point_hessians, int first_partial,
                             global float* partials) {
  const int chunk = get_global_id(0) * CHUNK;
  const int end = min(chunk + CHUNK, count);
  if (status[0] || chunk >= count) return;
  float16 energy = 0;
  for (int begin = chunk; begin < end; begin += 16) {
    float16 u[3], r[RESIDUALS], out[16];  // contribution, then point Hessian
    displacements(first, begin, end, nodes, lever_arms, unknowns, u);
    for (int entry = 0; entry < 16; ++entry) out[entry] = 0;
#if PER_EDGE
    float16 given[3], rest[24];
    load_given(first, begin, end, nodes, node_points, given);
    for (int entry = 0; entry < 24; ++entry) rest[entry] = 0;
    NAME_RESIDUAL(rest, given, r);
    const float16 factor = weight * occupied(begin, end);
    for (int axis = 0; axis < 3; ++axis) {
      r[axis] += u[axis];
      out[axis] = factor * r[axis];
    }
    out[3] = factor;
    energy += factor * squared(r);
#else
    float16 given[6];
    const float16 factor = weight * occupied(begin, end) * load_given(begin, end, data, confidence, given);
    const int16 active = factor > 0;  // else what stands in data may be anything
    NAME_RESIDUAL(u, given, r);
    const float16 sum = squared(r);
    energy += select((float16)0, factor * LOSS_VALUE(sum, (float16)loss_scale), active);
#if SEPARABLE
    NAME_ROW(given, out + 3);
    for (int axis = 0; axis < 3; ++axis) out[axis] = factor * out[3] * r[axis];
    out[3] = factor * out[3] * out[3];
#else
    const float16 scale = factor * LOSS_WEIGHT(sum, (float16)loss_scale);
    float16 J[3 * RESIDUALS];
    NAME_JACOBIAN(u, given, J);
    for (int row = 0; row < RESIDUALS; ++row) {
      int entry = 4;
      for (int a = 0; a < 3; ++a) {
        const float16 scaled = scale * J[3 * row + a];
        out[a] += scaled * r[row];
        for (int b = a; b < 3; ++b) out[entry++] += scaled * J[3 * row + b];
      }
    }
#endif
    for (int entry = 0; entry < 10; ++entry) out[entry] = select((float16)0, out[entry], active);
#endif
    transpose(out);
    for (int i = begin; i < min(begin + 16, end); ++i) {
      const float16 own = out[i - begin];
      contributions[first + i] = add ? contributions[first + i] + own.lo.lo : own.lo.lo;
#if !PER_EDGE && !SEPARABLE
      const float8 hessian = own.s456789ab;
      point_hessians[first + i] = add ? point_hessians[first + i] + hessian : hessian;
#endif
    }
  }
  partials[first_partial + get_global_id(0)] = sum16(energy);
}

#if !PER_EDGE && !SEPARABLE
// What `step` changes the energy by, without losing the digits of a small difference.
kernel void KERNEL(change)(global const int* status, int count, float weight, float loss_scale,
                           global const float* unknowns, global const float* step, int first,
                           global const int* nodes, global const float4* lever_arms, global const float* data,
                           global const float* confidence, int first_change, global float* changes) {
  const int chunk = get_global_id(0) * CHUNK;
  const int end = min(chunk + CHUNK, count);
  if (status[0] || chunk >= count) return;
  float16 sum = 0;
  for (int begin = chunk; begin < end; begin += 16) {
    float16 u[3], v[3], given[6], before[RESIDUALS], after[RESIDUALS];
    const float16 factor = weight * occupied(begin, end) * load_given(begin, end, data, confidence, given);
    displacements(first, begin, end, nodes, lever_arms, unknowns, u);
    displacements(first, begin, end, nodes, lever_arms, step, v);
    for (int axis = 0; axis < 3; ++axis) v[axis] += u[axis];
    NAME_RESIDUAL(u, given, before);
    NAME_RESIDUAL(v, given, after);
    float16 gain = 0;
    for (int row = 0; row < RESIDUALS; ++row) gain += (after[row] - before[row]) * (after[row] + before[row]);
#if ROBUST
    const float16 scale = loss_scale;
    const float16 start = squared(before);
    const float16 slope = gain * LOSS_WEIGHT(start + 0.5f * gain, scale);
    const float16 difference = LOSS_VALUE(fmax(start + gain, (float16)0), scale) - LOSS_VALUE(start, scale);
    gain = select(difference, slope, fabs(gain) < 0.01f * start);
#endif
    sum += select((float16)0, factor * gain, factor > 0);
  }
  changes[first_change + get_global_id(0)] = sum16(sum);
}
#endif
