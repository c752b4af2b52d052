// Draws a deformed view as depth. Compiled behind surface_map.cl. `points`: x y z per pixel of the window,
// row by row, (0, 0, 0) where there is none. `camera`: fx, fy, cx, cy. `window`: left, top, width, height.
// `depth`: rows of `stride` values, the first pixel of the window at `first`, as bits: those of depths that
// are not negative are ordered as the depths are, and the least one stays whatever the order of drawing.

kernel void clear_depth(int count, global int* depth) {
  const int i = get_global_id(0);
  if (i < count) depth[i] = as_int(NO_DEPTH);
}

// Twice the area that a, b, c go around, positive when they do as u, then v axis.
float area_of(float2 a, float2 b, float2 c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

// 1 / z is linear over the image of a triangle.
void draw_triangle(float3 a, float3 b, float3 c, int4 window, int stride, int first, global int* depth) {
  const float whole = area_of(a.xy, b.xy, c.xy);
  if (!(whole > 0.0f)) return;
  const float2 low = fmin(a.xy, fmin(b.xy, c.xy)), high = fmax(a.xy, fmax(b.xy, c.xy));
  const int2 begin = max(convert_int2_rtp(low), window.xy);
  const int2 end = min(convert_int2_rtn(high), window.xy + window.zw - 1);
  for (int v = begin.y; v <= end.y; ++v) {
    for (int u = begin.x; u <= end.x; ++u) {
      const float2 p = {u, v};
      const float3 shares = {area_of(b.xy, c.xy, p), area_of(c.xy, a.xy, p), area_of(a.xy, b.xy, p)};
      if (any(shares < 0.0f)) continue;
      const float z = whole / dot(shares, 1.0f / (float3)(a.z, b.z, c.z));
      atomic_min(depth + first + (v - window.y) * stride + u - window.x, as_int(z));
    }
  }
}

// Between four neighbouring points, two triangles, where the surface is not torn there: neighbours whose
// depths differ by more than `steepest` times a pixel's width on the surface belong to different parts of it.
kernel void draw_cells(int4 window, float4 camera, float steepest, int stride, int first,
                       global const float* points, global int* depth) {
  const int column = get_global_id(0) % window.z, row = get_global_id(0) / window.z;
  if (column + 1 >= window.z || row + 1 >= window.w) return;
  const int at = row * window.z + column;
  float3 corners[4];
  float nearest = NO_DEPTH, farthest = 0.0f;
  for (int i = 0; i < 4; ++i) {
    const float3 p = vload3(at + (i & 1) + (i >> 1) * window.z, points);
    if (!(p.z > 0.0f)) return;
    nearest = fmin(nearest, p.z);
    farthest = fmax(farthest, p.z);
    corners[i] = (float3)(camera.x * p.x / p.z + camera.z, camera.y * p.y / p.z + camera.w, p.z);
  }
  if (!(farthest - nearest <= steepest * nearest / camera.x)) return;
  draw_triangle(corners[0], corners[1], corners[2], window, stride, first, depth);
  draw_triangle(corners[3], corners[2], corners[1], window, stride, first, depth);
}
