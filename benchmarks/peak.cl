// What the machine can do at most: multiply-adds out of registers, and a sum of two streams from memory.

#define CHAINS 16

// 2 * 16 * CHAINS operations a turn and work-item.
kernel void multiply_adds(int turns, float factor, global float* out) {
  float16 sum[CHAINS];
#pragma unroll
  for (int chain = 0; chain < CHAINS; ++chain) sum[chain] = (float16)(chain + get_global_id(0));
  for (int turn = 0; turn < turns; ++turn) {
#pragma unroll
    for (int chain = 0; chain < CHAINS; ++chain) sum[chain] = sum[chain] * factor + factor;
  }
  float16 all = 0;
#pragma unroll
  for (int chain = 0; chain < CHAINS; ++chain) all += sum[chain];
  vstore16(all, get_global_id(0), out);
}

// Twelve bytes an element.
kernel void add_streams(int length, global const float16* a, global const float16* b, global float16* c) {
  const int first = get_global_id(0) * length;
  for (int i = first; i < first + length; ++i) c[i] = a[i] + b[i];
}
