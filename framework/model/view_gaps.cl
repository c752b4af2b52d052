// Maps of points, (0, 0, 0) where there is none.

#define IS_NONE(p) ((p).x == 0.0f && (p).y == 0.0f && (p).z == 0.0f)
#define BLOCK 16

// Puts a point where there is none, so that what is asked about each is found fast: one of the same BLOCK, or
// `elsewhere` (x y z) where that has none.
kernel void fill_gaps(int count, global const float* points, global const float* elsewhere,
                      global float* filled) {
  const int first = get_global_id(0) * BLOCK, last = min(first + BLOCK, count);
  float3 stand_in = vload3(0, elsewhere);
  for (int i = last - 1; i >= first; --i) {
    const float3 p = vload3(i, points);
    if (!IS_NONE(p)) stand_in = p;
  }
  for (int i = first; i < last; ++i) {
    const float3 p = vload3(i, points);
    vstore3(IS_NONE(p) ? stand_in : p, i, filled);
  }
}

// Takes away what has come of no point.
kernel void empty_gaps(int count, global const float* points, global float* moved_points,
                       global float* moved_normals) {
  const int i = get_global_id(0);
  if (i >= count || !IS_NONE(vload3(i, points))) return;
  vstore3((float3)(0), i, moved_points);
  vstore3((float3)(0), i, moved_normals);
}
