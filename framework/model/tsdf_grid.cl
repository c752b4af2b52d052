// What kernels over a truncated signed distance field share. Voxel (i, j, k) lies at i + size.x (j + size.y
// k); bricks of BRICK_X x BRICK_Y x BRICK_Z voxels and tiles of TILE x TILE pixels lie alike. `distances`:
// parts of the truncation, STEPS of them, positive before the surface; 0 where nothing was observed.
// `contents` of a brick: OBSERVED when any voxel was, INSIDE when any lies behind the surface. Transforms are
// float16: three rows of x, y, z and what is added. `camera`: fx, fy, cx, cy. `window`: left, top, width and
// height, in pixels.

// Values at some offsets, one a lane. Written out, because drivers for CPUs then gather them at once, from
// and into registers, which they do not where a loop does it.
#if WIDTH == 16
#define GATHER(type, value, at)                                                                           \
  ((type)(value((at).s0), value((at).s1), value((at).s2), value((at).s3), value((at).s4), value((at).s5), \
          value((at).s6), value((at).s7), value((at).s8), value((at).s9), value((at).sa), value((at).sb), \
          value((at).sc), value((at).sd), value((at).se), value((at).sf)))
#else
#define GATHER(type, value, at) value(at)
#endif

#define OBSERVED 1
#define INSIDE 2

typedef struct {
  float3 centre, reach;  // half its size along the camera's axes
} Box;

int3 brick_at(int index, int4 bricks) {
  const int row = index / bricks.x;
  return (int3)(index - row * bricks.x, row % bricks.y, row / bricks.y);
}

// What the voxels of a brick, and `more` voxels around it, take up in the camera's frame.
Box box_of(int3 brick, float more, float16 m) {
  const float3 half_size = 0.5f * (float3)(BRICK_X - 1, BRICK_Y - 1, BRICK_Z - 1);
  const float3 c = convert_float3(brick * (int3)(BRICK_X, BRICK_Y, BRICK_Z)) + half_size;
  const float3 h = half_size + more;
  const float rounding = 0.01f;  // mm
  const Box box = {
      {dot(m.s012, c) + m.s3, dot(m.s456, c) + m.s7, dot(m.s89a, c) + m.sb},
      {dot(fabs(m.s012), h) + rounding, dot(fabs(m.s456), h) + rounding, dot(fabs(m.s89a), h) + rounding}};
  return box;
}

// The tiles of a window that may show the box or pixels beside it: first column and row, last column and row;
// none: the last ones are smaller.
int4 tiles_of(Box box, float4 camera, int4 window) {
  const float near = fmax(box.centre.z - box.reach.z, 1e-3f), far = box.centre.z + box.reach.z;
  if (far <= 1e-3f) return (int4)(0, 0, -1, -1);
  const float2 low = box.centre.xy - box.reach.xy, high = box.centre.xy + box.reach.xy;
  // The side of a box looks farthest from the axis at its near end, and nearest to it at its far one.
  const float2 first = low / select((float2)far, (float2)near, low < 0.0f) * camera.xy + camera.zw - 0.01f;
  const float2 last = high / select((float2)far, (float2)near, high > 0.0f) * camera.xy + camera.zw + 1.01f;
  const float2 begin = convert_float2(window.xy), end = convert_float2(window.xy + window.zw);
  if (any(first >= end) || any(last < begin)) return (int4)(0, 0, -1, -1);
  return (int4)((convert_int2_rtn(clamp(first, begin, end - 1.0f)) - window.xy) / TILE,
                (convert_int2_rtn(clamp(last, begin, end - 1.0f)) - window.xy) / TILE);
}

int2 tiles_over(int4 window) { return (window.zw + TILE - 1) / TILE; }
