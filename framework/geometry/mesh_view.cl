// What the pixels of a view show, WIDTH of a row a work-item; compiled behind lanes.cl. `camera`: fx, fy, cx,
// cy. Points: mm in the camera's frame, x y z in turn. `seen`: the triangle of each pixel, -1 for none.

#if WIDTH == 16
#define WHOLE(values) convert_int16(values)
#define FLOATS(values) convert_float16(values)
#define FROM_WHOLE(address) vload16(0, address)
#define TO_WHOLE(values, address) vstore16(values, 0, address)
#else
#define WHOLE(values) ((int)(values))
#define FLOATS(values) ((float)(values))
#define FROM_WHOLE(address) (*(address))
#define TO_WHOLE(values, address) (*(address) = (values))
#endif

// The pixels of a work-item: WIDTH of them in a row, from u on, fewer at its end.
typedef struct {
  int u, v, count, first;  // `first`: the place of (u, v) in the image
} Run;

Run run_of(int2 size) {
  const int runs = (size.x + WIDTH - 1) / WIDTH;
  Run run;
  run.v = get_global_id(0) / runs;
  run.u = (get_global_id(0) - run.v * runs) * WIDTH;
  run.count = run.v < size.y ? min(size.x - run.u, WIDTH) : 0;
  run.first = run.v * size.x + run.u;
  return run;
}

Lanes columns_of(Run run) { return run.u + LANE_OFFSETS; }

Vector rays_through(Run run, float4 camera) {
  const Vector rays = {(columns_of(run) - camera.z) / camera.x, (run.v - camera.w) / camera.y, 1};
  return rays;
}

Lanes load_row(Run run, global const float* image) {
  float values[WIDTH];
  for (int lane = 0; lane < WIDTH; ++lane) values[lane] = image[run.first + min(lane, run.count - 1)];
  return LOAD(values);
}

Truth is_seen(Run run, global const int* seen) {
  int shown[WIDTH];
  for (int lane = 0; lane < WIDTH; ++lane)
    shown[lane] = lane < run.count && seen[run.first + lane] >= 0 ? -1 : 0;
  return FROM_WHOLE(shown);
}

typedef struct {
  Vector a, b, c;
} Triangles;

// What the corners of each pixel's triangle have, three values each; of the first triangle where none is
// seen.
Triangles triangles_of(Run run, global const int* seen, global const int* triangles,
                       global const float* values) {
  float x[3][WIDTH], y[3][WIDTH], z[3][WIDTH];
  for (int lane = 0; lane < WIDTH; ++lane) {
    const int triangle = max(lane < run.count ? seen[run.first + lane] : 0, 0);
    for (int corner = 0; corner < 3; ++corner) {
      global const float* value = values + 3 * triangles[3 * triangle + corner];
      x[corner][lane] = value[0];
      y[corner][lane] = value[1];
      z[corner][lane] = value[2];
    }
  }
  const Triangles t = {{LOAD(x[0]), LOAD(y[0]), LOAD(z[0])},
                       {LOAD(x[1]), LOAD(y[1]), LOAD(z[1])},
                       {LOAD(x[2]), LOAD(y[2]), LOAD(z[2])}};
  return t;
}

Vector minus(Vector a, Vector b) {
  const Vector difference = {a.x - b.x, a.y - b.y, a.z - b.z};
  return difference;
}

// As dot() and cross(), which round each product.
Lanes rounded_inner(Vector a, Vector b) {
#pragma OPENCL FP_CONTRACT OFF
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

Vector rounded_outer(Vector a, Vector b) {
#pragma OPENCL FP_CONTRACT OFF
  const Vector product = {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  return product;
}

typedef struct {
  Lanes second, third;  // of the triangle's corners; the first has the rest
} Shares;

Shares load_shares(Run run, global const float* shares) {
  float second[WIDTH], third[WIDTH];
  for (int lane = 0; lane < WIDTH; ++lane) {
    const int pixel = run.first + min(lane, run.count - 1);
    second[lane] = shares[2 * pixel];
    third[lane] = shares[2 * pixel + 1];
  }
  const Shares loaded = {LOAD(second), LOAD(third)};
  return loaded;
}

void store_pairs(Lanes first, Lanes second, Run run, global float* pairs) {
  float a[WIDTH], b[WIDTH];
  STORE(first, a);
  STORE(second, b);
  for (int lane = 0; lane < run.count; ++lane) vstore2((float2)(a[lane], b[lane]), run.first + lane, pairs);
}

// Of the points that rays meet.
Shares shares_of(Triangles t, Vector rays) {
  const Vector ab = minus(t.b, t.a), ac = minus(t.c, t.a);
  const Vector p = rounded_outer(rays, ac), q = rounded_outer(ab, t.a);
  const Lanes determinant = rounded_inner(ab, p);
  const Lanes b = -rounded_inner(t.a, p) / determinant, c = rounded_inner(rays, q) / determinant;
  const Lanes second = WHERE(b > 0, b), third = WHERE(c > 0, c);
  const Lanes beyond = fmax(second + third, (Lanes)1);
  const Shares shares = {WHERE(isfinite(beyond), second / beyond), WHERE(isfinite(beyond), third / beyond)};
  return shares;
}

Vector blend(Triangles t, Shares shares) {
  const Vector ab = minus(t.b, t.a), ac = minus(t.c, t.a);
  const Vector blended = {t.a.x + shares.second * ab.x + shares.third * ac.x,
                          t.a.y + shares.second * ab.y + shares.third * ac.y,
                          t.a.z + shares.second * ab.z + shares.third * ac.z};
  return blended;
}

// Gives each pixel the place of its point in the triangle.
kernel void locate(global const int* triangles, global const float* points, float4 camera, int2 size,
                   global const int* seen, global float* shares) {
  const Run run = run_of(size);
  if (run.count <= 0) return;
  const Truth here = is_seen(run, seen);
  Shares places = {0, 0};
  if (ANY(here)) {
    places = shares_of(triangles_of(run, seen, triangles, points), rays_through(run, camera));
    places.second = WHERE(here, places.second);
    places.third = WHERE(here, places.third);
  }
  store_pairs(places.second, places.third, run, shares);
}

// `values`, three a vertex, at the points seen; 0 where nothing is.
kernel void interpolate(global const int* triangles, global const float* values, int2 size,
                        global const int* seen, global const float* shares, global float* interpolated) {
  const Run run = run_of(size);
  if (run.count <= 0) return;
  const Truth here = is_seen(run, seen);
  Vector value = {0, 0, 0};
  if (ANY(here))
    value = only(here, blend(triangles_of(run, seen, triangles, values), load_shares(run, shares)));
  store_vectors(value, run.count, interpolated + 3 * run.first);
}

// The pixels around points of an image, 0 outside: left and right of the upper row, then of the lower.
typedef struct {
  Lanes values[4];
} Four;

Four four_of(Truth wanted, Truth first_u, Truth first_v, int2 size, global const float* image) {
  int is_wanted[WIDTH], u[WIDTH], v[WIDTH];
  float values[4][WIDTH];
  TO_WHOLE(wanted, is_wanted);
  TO_WHOLE(first_u, u);
  TO_WHOLE(first_v, v);
  for (int lane = 0; lane < WIDTH; ++lane) {
    for (int i = 0; i < 4; ++i) {
      const int at_u = u[lane] + (i & 1), at_v = v[lane] + (i >> 1);
      const bool is_in_image = is_wanted[lane] && at_u >= 0 && at_v >= 0 && at_u < size.x && at_v < size.y;
      values[i][lane] = is_in_image ? image[at_v * size.x + at_u] : 0.0f;
    }
  }
  const Four four = {{LOAD(values[0]), LOAD(values[1]), LOAD(values[2]), LOAD(values[3])}};
  return four;
}

// floor(), which drivers may call a function for.
Truth whole_below(Lanes values) {
  const Truth towards_zero = WHOLE(values);
  return select(towards_zero, towards_zero - 1, FLOATS(towards_zero) > values);
}

// Whether the z-buffer of a view shows points of a surface with these normals: see true_motion.h.
Truth is_shown(Truth wanted, Vector point, Vector normal, Lanes at_u, Lanes at_v, float4 camera, int2 size,
               global const float* depth) {
  const Truth inside =
      wanted && at_u >= -0.5f && at_v >= -0.5f && at_u <= size.x - 0.5f && at_v <= size.y - 0.5f;
  const Truth first_u = whole_below(WHERE(inside, at_u)), first_v = whole_below(WHERE(inside, at_v));
  const Four shown = four_of(inside, first_u, first_v, size, depth);
  const Lanes footprint = point.z / fmin(camera.x, camera.y), reach = STEEPEST_SLOPE * footprint;
  const Lanes tolerance = NEAREST_HIDING + HIDING_PIXELS * footprint;
  const Lanes offset = rounded_inner(normal, point);
  const Truth is_right = at_u - FLOATS(first_u) > 0.5f, is_lower = at_v - FLOATS(first_v) > 0.5f;
  Truth is_same = 0, is_hidden = 0;
  for (int i = 0; i < 4; ++i) {
    const int right = i & 1, lower = i >> 1;
    const Lanes facing = normal.x / camera.x * (FLOATS(first_u + right) - camera.z) +
                         normal.y / camera.y * (FLOATS(first_v + lower) - camera.w) + normal.z;
    const Lanes expected = fmin(fmax(offset / facing, point.z - reach), point.z + reach);
    const Truth is_its_pixel = (right ? is_right : !is_right) && (lower ? is_lower : !is_lower);
    is_hidden = is_hidden || (shown.values[i] > 0 && shown.values[i] < expected - tolerance);
    is_same = is_same || (is_its_pixel && shown.values[i] > 0 && shown.values[i] < expected + tolerance);
  }
  return inside && is_same && !is_hidden;
}

Lanes or_nan(Truth condition, Lanes values) { return select((Lanes)NAN, values, condition); }

// The motion of the points that a view shows while the vertices go to `points`, which another view (`depth`,
// and its camera) shows; NaN where nothing is seen.
kernel void move(global const int* triangles, int2 size, float4 camera, global const int* seen,
                 global const float* shares, global const float* from_depth, global const float* points,
                 int2 target_size, float4 target_camera, global const float* depth, global float* scene_flow,
                 global float* optical_flow, global uchar* visible) {
  const Run run = run_of(size);
  if (run.count <= 0) return;
  const Truth here = is_seen(run, seen);
  Vector motion = {NAN, NAN, NAN};
  Lanes shift_u = NAN, shift_v = NAN;
  Truth shown = 0;
  if (ANY(here)) {
    const Triangles t = triangles_of(run, seen, triangles, points);
    const Vector moved = blend(t, load_shares(run, shares)), rays = rays_through(run, camera);
    const Lanes z = load_row(run, from_depth);
    motion.x = or_nan(here, moved.x - z * rays.x);
    motion.y = or_nan(here, moved.y - z * rays.y);
    motion.z = or_nan(here, moved.z - z);
    const Truth in_front = here && moved.z > 0;
    const Lanes at_u = moved.x / moved.z * target_camera.x + target_camera.z;
    const Lanes at_v = moved.y / moved.z * target_camera.y + target_camera.w;
    shift_u = or_nan(in_front, at_u - columns_of(run));
    shift_v = or_nan(in_front, at_v - run.v);
    shown = is_shown(in_front, moved, rounded_outer(minus(t.b, t.a), minus(t.c, t.a)), at_u, at_v,
                     target_camera, target_size, depth);
  }
  store_vectors(motion, run.count, scene_flow + 3 * run.first);
  store_pairs(shift_u, shift_v, run, optical_flow);
  int is_visible[WIDTH];
  TO_WHOLE(shown, is_visible);
  for (int lane = 0; lane < run.count; ++lane) visible[run.first + lane] = is_visible[lane] ? 1 : 0;
}
