// Compaction in three steps. A work-item of the first and the last owns the same CHUNK flags.

#define CHUNK 256

kernel void count_flags(int count, global const int* flags, global int* counts) {
  const int first = get_global_id(0) * CHUNK;
  if (first >= count) return;
  int raised = 0;
  for (int i = first; i < min(first + CHUNK, count); ++i) raised += flags[i] != 0;
  counts[get_global_id(0)] = raised;
}

// starts[0]: how many there are in all; starts[1 + c]: how many there are before chunk c.
kernel void scan_counts(int chunks, global const int* counts, global int* starts) {
  int total = 0;
  for (int c = 0; c < chunks; ++c) {
    starts[1 + c] = total;
    total += counts[c];
  }
  starts[0] = total;
}

kernel void gather_raised(int count, global const int* flags, global const int* starts, global int* indices) {
  const int first = get_global_id(0) * CHUNK;
  if (first >= count) return;
  int place = starts[1 + get_global_id(0)];
  for (int i = first; i < min(first + CHUNK, count); ++i)
    if (flags[i] != 0) indices[place++] = i;
}
