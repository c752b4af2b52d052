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
#define STORE_INTS(value, address) vstore16(as_float16(value), 0, (local float*)(address))
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
#define ROW (5 * SUM_STRIDE)
#define COUNT_BITS 9  // of the number of pixels that windows must not hold

// A row of the sums holds five, one after the other: inverse depth q; q times the column and q times the row
// within the tile; the square of coarse inverse depth c; c and, in bits below it, how many pixels no window
// may hold.

// Sums along the lanes, those of the vector before included.
Ints running(Ints x, Ints before) {
#if WIDTH == 16
  const Ints zero = 0;
  x += (Ints)(0, x.s0123, x.s456789ab, x.scd, x.se);
  x += (Ints)(0, 0, x.s0123, x.s456789ab, x.scd);
  x += (Ints)(zero.s0123, x.s01234567, x.s89ab);
  x += (Ints)(zero.lo, x.lo);
  return x + before.sf;
#else
  return x + before;
#endif
}

// To the nearest whole number, for 0 <= x < 2^22.
Ints rounded(Lanes x) {
  const Lanes shift = 8388608.0f;  // 2^23: adding it rounds to whole numbers
  return INTS(x + shift) - INTS(shift);
}

Ints steps_of(Lanes depth) {
  return rounded(WHERE(depth >= (Lanes)NEAREST && HAS_DEPTH(depth), STEPS / depth));
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

// Adds row y of the image to the sums: from `above` to `sums`.
static inline void sum_row(global const float* depth, int stride, int columns, int y, float depth_change,
                           int coarse_bits, local const int* above, local int* sums) {
  Ints q_before = 0, qu_before = 0, cc_before = 0, ce_before = 0;
  for (int x = 0; x < columns; x += WIDTH) {
    global const float* pixel = depth + x;
    const Lanes z = LOAD(pixel);
    const Ints q = steps_of(z);
    const Ints coarse = coarse_steps(q, coarse_bits);
    const Ints edge = is_edge(pixel, stride, z, q, depth_change);
    q_before = running(q, q_before);
    qu_before = running(q * (x + INT_OFFSETS), qu_before);
    cc_before = running(coarse * coarse, cc_before);
    ce_before = running((coarse << COUNT_BITS) + edge, ce_before);
    STORE_INTS(LOAD_INTS(above + x) + q_before, sums + x);
    STORE_INTS(LOAD_INTS(above + x + SUM_STRIDE) + qu_before, sums + x + SUM_STRIDE);
    STORE_INTS(LOAD_INTS(above + x + 2 * SUM_STRIDE) + q_before * y, sums + x + 2 * SUM_STRIDE);
    STORE_INTS(LOAD_INTS(above + x + 3 * SUM_STRIDE) + cc_before, sums + x + 3 * SUM_STRIDE);
    STORE_INTS(LOAD_INTS(above + x + 4 * SUM_STRIDE) + ce_before, sums + x + 4 * SUM_STRIDE);
  }
}

// The sums around a window: in the row above it and in its last row, one column before it.
typedef struct {
  local const int *top, *bottom;
} Corners;

// `which` of the five sums over a window.
static inline Ints over_window(Corners at, int side, int which) {
  local const int* top = at.top + which * SUM_STRIDE;
  local const int* bottom = at.bottom + which * SUM_STRIDE;
  return (LOAD_INTS(bottom + side) - LOAD_INTS(bottom)) - (LOAD_INTS(top + side) - LOAD_INTS(top));
}

// How inverse depth runs over a window, relative to its mean: by column, by row, and what is left.
typedef struct {
  Lanes by_u, by_v;  // per pixel
  Lanes left;        // sum of squares, per sum of squared columns
  Lanes spread;      // mean of squared columns; 0 where there is no window
} Course;

// The course over the window of radius r around the pixels from (x, y) of the tile on. ce: the sum over it.
static inline Course course_over(Corners at, Ints ce, int x, int y, int r, int coarse_bits) {
  const int side = 2 * r + 1, pixels = side * side;
  const float spread = r * (r + 1) / 3.0f, share = 1.0f / pixels, per_square = share / spread;
  const float coarse_unit = 1 << coarse_bits;
  const Ints q = over_window(at, side, 0);
  const Lanes mean = FLOATS(q) * share;
  const Lanes scale = 1.0f / fmax(mean, (Lanes)1);
  const Ints coarse = rounded(mean * (1.0f / coarse_unit));  // near all of the window's: so little is squared
  const Ints sum = (ce - ((pixels * coarse) << COUNT_BITS)) >> COUNT_BITS;
  const Ints squares = over_window(at, side, 3) - coarse * (2 * sum + pixels * coarse);
  const Lanes first = FLOATS(sum);
  const Lanes coarse_scale = scale * coarse_unit;
  const float rounding = pixels / 12.0f;  // variance that whole steps add
  const Lanes variance =
      (FLOATS(squares) - first * first * share - rounding) * (coarse_scale * coarse_scale * per_square);
  Course course;
  course.by_u = FLOATS(over_window(at, side, 1) - q * (x + INT_OFFSETS)) * (scale * per_square);
  course.by_v = FLOATS(over_window(at, side, 2) - q * y) * (scale * per_square);
  course.left = fmax(variance - course.by_u * course.by_u - course.by_v * course.by_v, (Lanes)0);
  course.spread = spread;
  return course;
}

// The course over the largest window around each pixel that holds no edge. The sums are a ring of rows, the
// last of which, in `last`, ends the windows of that radius.
static inline Course course_around(local const int* sums, int last, int x, int y, int radius,
                                   int coarse_bits) {
  Course course = {0, 0, 0, 0};
  for (int r = radius; r > 0; --r) {
    const int ring = 2 * radius + 2, bottom = last - (radius - r) + (last < radius - r ? ring : 0);
    const int top = bottom + 1 + 2 * (radius - r) - (bottom + 1 + 2 * (radius - r) < ring ? 0 : ring);
    const Corners at = {sums + top * ROW + x - r - 1, sums + bottom * ROW + x - r - 1};
    const Ints ce = over_window(at, 2 * r + 1, 4);
    const Truth taken = (ce & ((1 << COUNT_BITS) - 1)) == 0 && course.spread == (Lanes)0;
    if (!ANY(taken)) continue;
    const Course found = course_over(at, ce, x, y, r, coarse_bits);
    course.by_u = select(course.by_u, found.by_u, taken);
    course.by_v = select(course.by_v, found.by_v, taken);
    course.left = select(course.left, found.left, taken);
    course.spread = select(course.spread, found.spread, taken);
    if (!ANY(course.spread == (Lanes)0)) break;
  }
  return course;
}

// The covariance of the points that lie on `course` around `ray`, up to scale.
static inline Symmetric covariance_of(Course course, Vector ray, float2 focal) {
  const Lanes squares = course.by_u * course.by_u + course.by_v * course.by_v + course.left;
  const Lanes weight = 1.0f + course.spread * squares;  // mean of q^2 over the square of the mean
  const float ratio = focal.x / focal.y;
  const Lanes gx = course.by_u, gy = course.by_v * ratio;
  const Lanes depth = squares * (focal.x * focal.x), fx = gx * focal.x, fy = gy * focal.x;
  const Symmetric covariance = {
      weight + (depth * ray.x - 2.0f * fx) * ray.x - course.spread * gx * gx,
      depth * ray.x * ray.y - ray.x * fy - ray.y * fx - course.spread * gx * gy,
      depth * ray.x - fx,
      weight * (ratio * ratio) + (depth * ray.y - 2.0f * fy) * ray.y - course.spread * gy * gy,
      depth * ray.y - fy,
      depth};
  return covariance;
}

// The unit normal of a course, towards the camera; (0, 0, 0) where there is none.
static inline Vector normal_of(Course course, Vector ray, float2 focal) {
  const Vector least = smallest_eigenvector(covariance_of(course, ray, focal));
  const Lanes length = inverse_root(inner(least, least));
  return only(course.spread > (Lanes)0, scaled(least, select(length, -length, inner(least, ray) > (Lanes)0)));
}

// `tile`: columns and rows of the tiles, at most TILE_COLUMNS.
kernel void integral_images(global const float* depth, int stride, int2 size, int2 corner, float4 camera,
                            int2 tile_size, int radius, float depth_change, float most_coarse,
                            local int* sums, global float* points, global float* normals) {
  const int tiles = (size.x + tile_size.x - 1) / tile_size.x;
  const int top = get_global_id(0) / tiles * tile_size.y;
  const int left = (get_global_id(0) % tiles) * tile_size.x;
  if (top >= size.y) return;
  const int rows = min(tile_size.y, size.y - top) + 2 * radius;
  const int before = radius + 1;  // columns of the sums that come before the tile
  const int columns = before + min(tile_size.x, size.x - left) + radius;
  global const float* tile = depth + (top + HALO - radius) * stride + HALO + left - before;
  const int coarse_bits = spare_bits(tile, stride, columns, rows, most_coarse);
  for (int i = 0; i < ROW; i += WIDTH) STORE_INTS((Ints)0, sums + i);
  int last = 0;
  for (int y = 0; y < rows; ++y) {
    const int next = last + 1 < 2 * radius + 2 ? last + 1 : 0;
    sum_row(tile + y * stride, stride, columns, y, depth_change, coarse_bits, sums + last * ROW,
            sums + next * ROW);
    last = next;
    const int v = top + y - 2 * radius;
    if (v < top) continue;
    for (int u = left; u < min(left + tile_size.x, size.x); u += WIDTH) {
      const Lanes z = LOAD(depth + (v + HALO) * stride + u + HALO);
      Vector point = {0, 0, 0}, normal = {0, 0, 0};
      if (ANY_DEPTH(z)) {
        const Vector ray = ray_through(u, v, corner, camera);
        const Course course = course_around(sums, last, u - left + before, y - radius, radius, coarse_bits);
        normal = normal_of(course, ray, camera.xy);
        point = only(HAS_DEPTH(z), scaled(ray, z));
      }
      const int out = 3 * (v * size.x + u);
      store_vectors(point, size.x - u, points + out);
      store_vectors(normal, size.x - u, normals + out);
    }
  }
}
