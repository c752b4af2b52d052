// Normals by integral images over tiles; compiled behind depth_map.cl and plane.cl.
//
// A work-item makes the sums of its tile, and of what windows reach of its surroundings, then the normals.
// Sums are of whole numbers modulo 2^32: the difference of two is exact wherever the sum over a window fits.
// Inverse depth comes in fine steps, and in coarse ones where it is squared.

#if WIDTH == 16
typedef int16 Ints;
#define INTS(value) as_int16(value)
#define FLOATS(value) convert_float16(value)
#define LOAD_INTS(address) vload16(0, address)
#define STORE_INTS(value, address) vstore16(value, 0, address)
#else
typedef int Ints;
#define INTS(value) as_int(value)
#define FLOATS(value) convert_float(value)
#define LOAD_INTS(address) (*(address))
#define STORE_INTS(value, address) (*(address) = (value))
#endif

#if WIDTH == 16
#define INT_OFFSETS ((Ints)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15))
#else
#define INT_OFFSETS 0
#endif

#define SUM_STRIDE (TILE_COLUMNS + 2 * HALO)
#define SUM_ROWS (TILE_ROWS + 2 * MAX_RADIUS + 1)
#define PLANE (SUM_ROWS * SUM_STRIDE)
#define COUNT_BITS 9  // of the number of pixels that windows must not hold

typedef struct {
  Ints q, qu, qv;  // inverse depth, the same times column and row within the tile
  Ints cc;         // square of coarse inverse depth
  Ints ce;         // coarse inverse depth, and below it how many pixels no window may hold
} Sums;

// Sums along the lanes, those before included.
Ints running(Ints x, int before) {
#if WIDTH == 16
  const Ints zero = 0;
  x += (Ints)(0, x.s0123, x.s456789ab, x.scd, x.se);
  x += (Ints)(0, 0, x.s0123, x.s456789ab, x.scd);
  x += (Ints)(zero.s0123, x.s01234567, x.s89ab);
  x += (Ints)(zero.lo, x.lo);
#endif
  return x + before;
}

int last(Ints x) {
#if WIDTH == 16
  return x.sf;
#else
  return x;
#endif
}

Ints steps_of(Lanes depth) {
  const Lanes round = 8388608.0f;  // 2^23: adding it rounds to whole numbers
  const Lanes steps = WHERE(depth >= (Lanes)NEAREST && HAS_DEPTH(depth), STEPS / depth);
  return INTS(steps + round) - INTS(round);
}

// Without `bits`, rounded.
Ints coarse_steps(Ints steps, int bits) { return (steps + (1 << bits >> 1)) >> bits; }

// How many bits of the steps must go so that none in the tile is beyond `most`.
int spare_bits(global const float* depth, int stride, int columns, int rows, float most) {
  Lanes nearest = NO_DEPTH;
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; x += WIDTH) nearest = fmin(nearest, LOAD(depth + y * stride + x));
  Lanes steps = STEPS / fmax(nearest, (Lanes)NEAREST);
  int bits = 0;
  while (ANY(steps > (Lanes)most)) {
    ++bits;
    steps *= 0.5f;
  }
  return bits;
}

// Whether no window may hold a pixel: it has no depth, or the next one lies on another surface.
Ints is_edge(global const float* pixel, int stride, Lanes z, Ints q, float depth_change) {
  const Lanes most = depth_change * z;
  const Truth ends = q == 0 || fabs(LOAD(pixel + 1) - z) > most || fabs(LOAD(pixel + stride) - z) > most;
  return select((Ints)0, (Ints)1, ends);
}

void sum_up(global const float* depth, int stride, int columns, int rows, float depth_change, int coarse_bits,
            local int* sums) {
  for (int i = 0; i < SUM_STRIDE; i += WIDTH)
    for (int plane = 0; plane < 5; ++plane) STORE_INTS((Ints)0, sums + plane * PLANE + i);
  for (int y = 0; y < rows; ++y) {
    int q_before = 0, qu_before = 0, qv_before = 0, cc_before = 0, ce_before = 0;
    for (int x = 0; x < columns; x += WIDTH) {
      global const float* pixel = depth + y * stride + x;
      const Lanes z = LOAD(pixel);
      const Ints q = steps_of(z);
      const Ints coarse = coarse_steps(q, coarse_bits);
      const Ints edge = is_edge(pixel, stride, z, q, depth_change);
      const Ints in_row_q = running(q, q_before);
      const Ints in_row_qu = running(q * (x + INT_OFFSETS), qu_before);
      const Ints in_row_qv = running(q * y, qv_before);
      const Ints in_row_cc = running(coarse * coarse, cc_before);
      const Ints in_row_ce = running((coarse << COUNT_BITS) + edge, ce_before);
      q_before = last(in_row_q);
      qu_before = last(in_row_qu);
      qv_before = last(in_row_qv);
      cc_before = last(in_row_cc);
      ce_before = last(in_row_ce);
      local int* above = sums + y * SUM_STRIDE + x;
      local int* here = above + SUM_STRIDE;
      STORE_INTS(LOAD_INTS(above) + in_row_q, here);
      STORE_INTS(LOAD_INTS(above + PLANE) + in_row_qu, here + PLANE);
      STORE_INTS(LOAD_INTS(above + 2 * PLANE) + in_row_qv, here + 2 * PLANE);
      STORE_INTS(LOAD_INTS(above + 3 * PLANE) + in_row_cc, here + 3 * PLANE);
      STORE_INTS(LOAD_INTS(above + 4 * PLANE) + in_row_ce, here + 4 * PLANE);
    }
  }
}

// `corner`: above and left of the window.
Ints over_window(local const int* corner, int side) {
  const Ints top = LOAD_INTS(corner + side) - LOAD_INTS(corner);
  local const int* bottom = corner + side * SUM_STRIDE;
  return LOAD_INTS(bottom + side) - LOAD_INTS(bottom) - top;
}

// How inverse depth runs over a window, relative to its mean: by column, by row, and what is left.
typedef struct {
  Lanes by_u, by_v;  // per pixel
  Lanes left;        // sum of squares, per sum of squared columns
  Lanes spread;      // mean of squared columns; 0 where there is no window
} Course;

// The course over the largest window around a vector of pixels that holds no edge.
Course course_around(local const int* sums, int x, int y, int radius, Ints coarse, int coarse_bits) {
  Course course = {0, 0, 0, 0};
  for (int r = radius; r > 0; --r) {
    const int side = 2 * r + 1;
    local const int* corner = sums + (y - r) * SUM_STRIDE + x - r - 1;
    const float pixels = side * side;
    const Ints ce = over_window(corner + 4 * PLANE, side) - ((side * side * coarse) << COUNT_BITS);
    const Truth taken = (ce & ((1 << COUNT_BITS) - 1)) == 0 && course.spread == (Lanes)0;
    if (!ANY(taken)) continue;
    const float spread = r * (r + 1) / 3.0f;
    const Ints q = over_window(corner, side);
    const Lanes mean = FLOATS(q) / pixels;
    const Lanes scale = 1.0f / fmax(mean, (Lanes)1);
    const Lanes by_u =
        FLOATS(over_window(corner + PLANE, side) - q * (x + INT_OFFSETS)) * scale / (pixels * spread);
    const Lanes by_v = FLOATS(over_window(corner + 2 * PLANE, side) - q * y) * scale / (pixels * spread);
    const Ints first = ce >> COUNT_BITS;
    const Ints second = over_window(corner + 3 * PLANE, side) - coarse * (2 * first + side * side * coarse);
    const float rounding = pixels / 12;  // variance that whole steps add
    const Lanes coarse_scale = scale * (1 << coarse_bits);
    const Lanes variance = (FLOATS(second) - FLOATS(first) * FLOATS(first) / pixels - rounding) *
                           coarse_scale * coarse_scale / (pixels * spread);
    course.by_u = select(course.by_u, by_u, taken);
    course.by_v = select(course.by_v, by_v, taken);
    course.left = select(course.left, fmax(variance - by_u * by_u - by_v * by_v, (Lanes)0), taken);
    course.spread = select(course.spread, (Lanes)spread, taken);
    if (!ANY(course.spread == (Lanes)0)) break;
  }
  return course;
}

// The covariance of the points that lie on `course` around `ray`, up to scale.
Symmetric covariance_of(Course course, Vector ray, float2 focal) {
  const Lanes squares = course.by_u * course.by_u + course.by_v * course.by_v + course.left;
  const Lanes k = 1.0f / (1.0f + course.spread * squares);
  const float ratio = focal.x / focal.y;
  const Lanes gx = course.by_u, gy = course.by_v * ratio;
  const Lanes kf = k * focal.x, spread = k * course.spread;
  const Lanes depth = k * squares * focal.x * focal.x;
  const Symmetric covariance = {1.0f + (depth * ray.x - 2.0f * kf * gx) * ray.x - spread * gx * gx,
                                depth * ray.x * ray.y - kf * (ray.x * gy + ray.y * gx) - spread * gx * gy,
                                depth * ray.x - kf * gx,
                                ratio * ratio + (depth * ray.y - 2.0f * kf * gy) * ray.y - spread * gy * gy,
                                depth * ray.y - kf * gy,
                                depth};
  return covariance;
}

kernel void integral_images(global const float* depth, int stride, int2 size, int2 corner, float4 camera,
                            int radius, float depth_change, float most_coarse, global float* points,
                            global float* normals) {
  local int sums[5 * PLANE];
  const int tiles = (size.x + TILE_COLUMNS - 1) / TILE_COLUMNS;
  const int top = get_global_id(0) / tiles * TILE_ROWS;
  const int left = (get_global_id(0) % tiles) * TILE_COLUMNS;
  if (top >= size.y) return;
  const int rows = min(TILE_ROWS, size.y - top);
  const int columns = min(TILE_COLUMNS, size.x - left);
  global const float* tile = depth + (top + HALO - radius) * stride + left;
  const int tile_columns = min(SUM_STRIDE, stride - left), tile_rows = rows + 2 * radius;
  const int coarse_bits = spare_bits(tile, stride, tile_columns, tile_rows, most_coarse);
  sum_up(tile, stride, tile_columns, tile_rows, depth_change, coarse_bits, sums);
  for (int v = top; v < top + rows; ++v) {
    for (int u = left; u < left + columns; u += WIDTH) {
      const Lanes z = LOAD(depth + (v + HALO) * stride + u + HALO);
      Vector point = {0, 0, 0}, normal = {0, 0, 0};
      if (ANY_DEPTH(z)) {
        const Ints coarse = coarse_steps(steps_of(z), coarse_bits);
        const Course course =
            course_around(sums, u - left + HALO, v - top + radius, radius, coarse, coarse_bits);
        const Vector ray = ray_through(u, v, corner, camera);
        const Vector least = smallest_eigenvector(covariance_of(course, ray, camera.xy));
        const Lanes away = select((Lanes)1, (Lanes)-1, inner(least, ray) > (Lanes)0);
        point = only(HAS_DEPTH(z), scaled(ray, z));
        normal = only(course.spread > (Lanes)0, scaled(least, away / sqrt(inner(least, least))));
      }
      const int out = 3 * (v * size.x + u);
      store_vectors(point, size.x - u, points + out);
      store_vectors(normal, size.x - u, normals + out);
    }
  }
}
