// Sums in a fixed order, and what the work-items of the one work-group of a solver, GROUP_SIZE of them,
// share.

#if GROUP_SIZE == 1
#define SYNC
#else
#define SYNC barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE)
#endif
#define FOR_EACH(i, count) for (int i = get_local_id(0); i < (count); i += GROUP_SIZE)

float sum4(float4 v) { return (v.x + v.y) + (v.z + v.w); }

float sum16(float16 v) {
  const float8 half_sum = v.lo + v.hi;
  return sum4(half_sum.lo + half_sum.hi);
}

// The sum over the work-group, known to all of it; `scratch`: GROUP_SIZE numbers.
float group_sum(float own, local float* scratch) {
#if GROUP_SIZE == 1
  return own;
#else
  scratch[get_local_id(0)] = own;
  for (int others = GROUP_SIZE / 2; others > 0; others /= 2) {
    SYNC;
    if (get_local_id(0) < others) scratch[get_local_id(0)] += scratch[get_local_id(0) + others];
  }
  SYNC;
  const float all = scratch[0];
  SYNC;
  return all;
#endif
}

// The sum of partial energies, in order, with compensation: the decrease per iteration is a small difference
// of large sums.
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
