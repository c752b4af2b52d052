// One mask of [thesis 4.5] a work-item: decides which of its points are constrained. Pixels are those of the
// map of points, whose corner lies at pixel `corner` of the image; masks tile the image. Mask (0, 0) is the
// one that the corner lies in. The flag of a point that is constrained is how many are in its mask, else 0.
kernel void choose(int2 masks, int step, global const int* spread_rows, float threshold, int2 corner,
                   int2 size, global const int* points, global const int* is_centre,
                   global const float* residuals, global int* flags) {
  const int mask = get_global_id(0);
  if (mask >= masks.x * masks.y) return;
  const int2 origin = (int2)(mask % masks.x, mask / masks.x) * step - corner % step;
  const int2 lowest = max(origin, (int2)(0));  // not max(origin, 0): Oclgrind 21.10 reads past a scalar there
  const int2 highest = min(origin + step, size);

  float sum = 0, known = 0;
  for (int v = lowest.y; v < highest.y; ++v)
    for (int u = lowest.x; u < highest.x; ++u) {
      const int point = points[v * size.x + u];
      if (point >= 0 && residuals[point] >= 0) {
        sum += residuals[point];
        known += 1;
      }
    }

  const int wants_all = sum > threshold * known;
  const int wants_some = known > 0 && sum >= 0.5f * threshold * known;
  int chosen = 0;
  for (int v = lowest.y; v < highest.y; ++v)
    for (int u = lowest.x; u < highest.x; ++u) {
      const int point = points[v * size.x + u];
      if (point < 0) continue;
      const int2 place = (int2)(u, v) - origin;
      const int is_spread = place.y == spread_rows[place.x];
      flags[point] = wants_all || (wants_some ? is_spread : is_centre[point]);
      chosen += flags[point];
    }
  for (int v = lowest.y; v < highest.y; ++v)
    for (int u = lowest.x; u < highest.x; ++u) {
      const int point = points[v * size.x + u];
      if (point >= 0) flags[point] *= chosen;
    }
}
