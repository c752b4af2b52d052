// Z-buffer over triangles. `camera`: fx, fy, cx, cy. Points: mm in the camera's frame, x y z in turn.
//
// Corners are rounded to 1/SUBPIXELS of a pixel, and whether a ray meets a triangle is then decided in whole
// numbers, without any rounding: two triangles that share an edge leave no pixel between them. Only triangles
// that reach behind the camera, or too far beside it, are decided in floats.

#define SUBPIXELS 4096
#define SUBPIXEL_BITS 12
#define WIDEST 131072.0f     // pixels from the image's corner: differences of products then fit into a long
#define OUTSIDE INT_MIN      // of what has no place in the image
#define NOTHING 0x7f800000u  // the depth, infinity, where no triangle is seen

typedef struct {
  float3 a, b, c;
} Triangle;

typedef struct {
  float3 normal;  // of any length
  float offset;   // normal . point, of the points of the plane
  float nearest, farthest;
} Plane;

Triangle triangle_of(int3 corners, global const float* points) {
  const Triangle triangle = {vload3(corners.x, points), vload3(corners.y, points), vload3(corners.z, points)};
  return triangle;
}

Plane plane_of(Triangle t) {
  Plane plane;
  plane.normal = cross(t.b - t.a, t.c - t.a);
  plane.offset = dot(plane.normal, t.a);
  plane.nearest = fmin(fmin(t.a.z, t.b.z), t.c.z);
  plane.farthest = fmax(fmax(t.a.z, t.b.z), t.c.z);
  return plane;
}

float3 ray_through(int u, int v, float4 camera) {
  return (float3)((u - camera.z) / camera.x, (v - camera.w) / camera.y, 1);
}

// Where a ray meets the triangle of the plane, whose normal . ray is `facing`; rounding must not carry it out
// of the triangle.
float depth_on(Plane plane, float facing) {
  return fmin(fmax(plane.offset / facing, plane.nearest), plane.farthest);
}

kernel void clear(global uint* nearest, global int* seen) {
  nearest[get_global_id(0)] = NOTHING;
  seen[get_global_id(0)] = -1;
}

kernel void place(global const float* points, int count, float4 camera, float near, global int* places) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const float3 p = vload3(i, points);
  const float u = camera.x * p.x / p.z + camera.z, v = camera.y * p.y / p.z + camera.w;
  const bool is_placed = p.z >= near && p.z < INFINITY && fabs(u) < WIDEST && fabs(v) < WIDEST;
  places[2 * i] = is_placed ? convert_int_rte(u * SUBPIXELS) : OUTSIDE;
  places[2 * i + 1] = is_placed ? convert_int_rte(v * SUBPIXELS) : OUTSIDE;
}

// In the first pass the nearest depth of each pixel is found, in the second the first triangle that has it.
// Both are passes of one kernel, so that they round alike. Tells in the first whether the depth may be that.
bool show(int triangle, float depth, int pixel, int pass, global volatile uint* nearest,
          global volatile uint* seen) {
  const uint bits = as_uint(depth);
  if (pass == 0) return bits <= atomic_min(nearest + pixel, bits);
  if (bits == nearest[pixel]) atomic_min(seen + pixel, (uint)triangle);
  return false;
}

// Twice the area of (p, q, r), positive when they run clockwise in the image.
long area(long2 p, long2 q, long2 r) { return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x); }

bool draw_placed(int index, Triangle t, long2 a, long2 b, long2 c, float4 camera, int2 size, int pass,
                 global volatile uint* nearest, global volatile uint* seen) {
  const int first_u = max((int)((min(min(a.x, b.x), c.x) + SUBPIXELS - 1) >> SUBPIXEL_BITS), 0);
  const int first_v = max((int)((min(min(a.y, b.y), c.y) + SUBPIXELS - 1) >> SUBPIXEL_BITS), 0);
  const int last_u = min((int)(max(max(a.x, b.x), c.x) >> SUBPIXEL_BITS), size.x - 1);
  const int last_v = min((int)(max(max(a.y, b.y), c.y) >> SUBPIXEL_BITS), size.y - 1);
  if (first_u > last_u || first_v > last_v) return false;
  const long whole = area(a, b, c);
  if (whole == 0) return false;  // seen from its edge: its neighbours are seen instead
  if (whole < 0) {
    const long2 other = b;
    b = c;
    c = other;
  }
  const long2 corner = {(long)first_u * SUBPIXELS, (long)first_v * SUBPIXELS};
  long row_ab = area(a, b, corner), row_bc = area(b, c, corner), row_ca = area(c, a, corner);
  const long2 ab = (b - a) * SUBPIXELS, bc = (c - b) * SUBPIXELS, ca = (a - c) * SUBPIXELS;
  bool is_shown = false;
  const Plane plane = plane_of(t);
  const float slope_u = plane.normal.x / camera.x, slope_v = plane.normal.y / camera.y;
  for (int v = first_v; v <= last_v; ++v) {
    long on_ab = row_ab, on_bc = row_bc, on_ca = row_ca;
    const float facing = slope_v * (v - camera.w) + plane.normal.z;
    for (int u = first_u; u <= last_u; ++u) {
      if ((on_ab | on_bc | on_ca) >= 0)
        is_shown |= show(index, depth_on(plane, slope_u * (u - camera.z) + facing), v * size.x + u, pass,
                         nearest, seen);
      on_ab -= ab.y;
      on_bc -= bc.y;
      on_ca -= ca.y;
    }
    row_ab += ab.x;
    row_bc += bc.x;
    row_ca += ca.x;
  }
  return is_shown;
}

// A triangle that is not placed in the image as a whole: see draw() of render.cpp.
bool draw_across(int index, Triangle t, float4 camera, float near, int2 size, int pass,
                 global volatile uint* nearest, global volatile uint* seen) {
  const float rounding = 4e-7f;
  const Plane plane = plane_of(t);
  float3 bc = cross(t.b, t.c), ca = cross(t.c, t.a), ab = cross(t.a, t.b);
  const float sign = dot(bc, t.a) < 0 ? -1.0f : 1.0f;
  const float3 slack =
      rounding * (float3)(length(t.b) * length(t.c), length(t.c) * length(t.a), length(t.a) * length(t.b));
  bool is_shown = false;
  for (int v = 0; v < size.y; ++v) {
    for (int u = 0; u < size.x; ++u) {
      const float3 ray = ray_through(u, v, camera);
      const float3 shares = sign * (float3)(dot(bc, ray), dot(ca, ray), dot(ab, ray));
      const float3 tolerance = slack * length(ray);
      if (any(shares < -tolerance) ||
          !(shares.x + shares.y + shares.z > tolerance.x + tolerance.y + tolerance.z))
        continue;
      const float depth = depth_on(plane, dot(plane.normal, ray));
      if (depth >= near) is_shown |= show(index, depth, v * size.x + u, pass, nearest, seen);
    }
  }
  return is_shown;
}

// `may_be_seen`: of each triangle, what the first pass found; the second passes over the others.
kernel void draw(global const int* triangles, int count, global const float* points, global const int* places,
                 float4 camera, float near, int2 size, int pass, global volatile uint* nearest,
                 global volatile uint* seen, global uchar* may_be_seen) {
  const int index = get_global_id(0);
  if (index >= count || (pass == 1 && !may_be_seen[index])) return;
  const int3 corners = vload3(index, triangles);
  const Triangle t = triangle_of(corners, points);
  const int2 a = vload2(corners.x, places), b = vload2(corners.y, places), c = vload2(corners.z, places);
  bool is_shown = false;
  if (a.x != OUTSIDE && b.x != OUTSIDE && c.x != OUTSIDE)
    is_shown = draw_placed(index, t, convert_long2(a), convert_long2(b), convert_long2(c), camera, size, pass,
                           nearest, seen);
  else if (all(isfinite(t.a)) && all(isfinite(t.b)) && all(isfinite(t.c)) && plane_of(t).farthest >= near)
    is_shown = draw_across(index, t, camera, near, size, pass, nearest, seen);
  if (pass == 0) may_be_seen[index] = is_shown ? 1 : 0;
}

// The shares of the triangle's second and third corner in the point that a ray meets.
float2 shares_of(Triangle t, float3 ray) {
  const float3 ab = t.b - t.a, ac = t.c - t.a;
  const float3 p = cross(ray, ac), q = cross(ab, t.a);
  const float determinant = dot(ab, p);
  float b = -dot(t.a, p) / determinant, c = dot(ray, q) / determinant;
  b = b > 0 ? b : 0.0f;
  c = c > 0 ? c : 0.0f;
  const float beyond = fmax(b + c, 1.0f);
  return isfinite(beyond) ? (float2)(b, c) / beyond : (float2)(0);
}

float3 blend(Triangle t, float2 shares) { return t.a + shares.x * (t.b - t.a) + shares.y * (t.c - t.a); }

// The pixels of a work-item: WIDTH of them in a row, from u on, fewer at its end.
typedef struct {
  int u, v, count;
} Run;

Run run_of(int2 size) {
  const int runs = (size.x + WIDTH - 1) / WIDTH;
  Run run;
  run.v = get_global_id(0) / runs;
  run.u = (get_global_id(0) - run.v * runs) * WIDTH;
  run.count = run.v < size.y ? min(size.x - run.u, WIDTH) : 0;
  return run;
}

// Gives each pixel its depth, 0 where nothing is seen, and the place of its point in the triangle.
kernel void resolve(global const int* triangles, global const float* points, float4 camera, int2 size,
                    global const uint* nearest, global const int* seen, global float* depth,
                    global float* shares) {
  const Run run = run_of(size);
  for (int u = run.u; u < run.u + run.count; ++u) {
    const int pixel = run.v * size.x + u, triangle = seen[pixel];
    depth[pixel] = triangle < 0 ? 0.0f : as_float(nearest[pixel]);
    float2 place = 0;
    if (triangle >= 0)
      place = shares_of(triangle_of(vload3(triangle, triangles), points), ray_through(u, run.v, camera));
    vstore2(place, pixel, shares);
  }
}

// `values`, three a vertex, at the points seen; 0 where nothing is.
kernel void interpolate(global const int* triangles, global const float* values, int2 size,
                        global const int* seen, global const float* shares, global float* interpolated) {
  const Run run = run_of(size);
  for (int u = run.u; u < run.u + run.count; ++u) {
    const int pixel = run.v * size.x + u;
    float3 value = 0;
    if (seen[pixel] >= 0)
      value = blend(triangle_of(vload3(seen[pixel], triangles), values), vload2(pixel, shares));
    vstore3(value, pixel, interpolated);
  }
}

// Whether the z-buffer of a view shows a point of a surface with this normal: see true_motion.h. The four
// pixels around it in turn: left and right of the upper row, then of the lower.
bool is_shown(float3 point, float3 normal, float2 at, float4 camera, int2 size, global const float* depth) {
  const float2 corner = floor(at), inside = at - corner;
  if (!(at.x >= -0.5f && at.y >= -0.5f && at.x <= size.x - 0.5f && at.y <= size.y - 0.5f)) return false;
  const int2 first = convert_int2(corner);
  const int4 u = first.x + (int4)(0, 1, 0, 1), v = first.y + (int4)(0, 0, 1, 1);
  const int4 in_image = u >= 0 && v >= 0 && u < size.x && v < size.y;
  const int4 pixel = select((int4)(0), v * size.x + u, in_image);
  const float4 values = {depth[pixel.x], depth[pixel.y], depth[pixel.z], depth[pixel.w]};
  const float4 shown = select((float4)(0), values, in_image);
  const float4 facing = normal.x / camera.x * (convert_float4(u) - camera.z) +
                        normal.y / camera.y * (convert_float4(v) - camera.w) + normal.z;
  const float footprint = point.z / fmin(camera.x, camera.y), reach = STEEPEST_SLOPE * footprint;
  const float4 expected = fmin(fmax(dot(normal, point) / facing, point.z - reach), point.z + reach);
  const float tolerance = NEAREST_HIDING + HIDING_PIXELS * footprint;
  const int4 before = shown > 0 && shown < expected - tolerance;
  const int4 same = shown > 0 && shown < expected + tolerance;
  const bool is_right = inside.x > 0.5f, is_lower = inside.y > 0.5f;
  const int is_same = is_lower ? (is_right ? same.w : same.z) : (is_right ? same.y : same.x);
  return is_same && !any(before);
}

// The motion of the points that a view shows while the vertices go to `points`, which another view (`depth`,
// and its camera) shows; NaN where nothing is seen.
kernel void move(global const int* triangles, int2 size, float4 camera, global const int* seen,
                 global const float* shares, global const float* from_depth, global const float* points,
                 int2 target_size, float4 target_camera, global const float* depth, global float* scene_flow,
                 global float* optical_flow, global uchar* visible) {
  const Run run = run_of(size);
  for (int u = run.u; u < run.u + run.count; ++u) {
    const int pixel = run.v * size.x + u;
    float3 motion = NAN;
    float2 shift = NAN;
    bool is_visible = false;
    if (seen[pixel] >= 0) {
      const Triangle t = triangle_of(vload3(seen[pixel], triangles), points);
      const float3 moved = blend(t, vload2(pixel, shares));
      motion = moved - from_depth[pixel] * ray_through(u, run.v, camera);
      if (moved.z > 0) {
        const float2 at = moved.xy / moved.z * target_camera.xy + target_camera.zw;
        shift = at - (float2)(u, run.v);
        is_visible = is_shown(moved, cross(t.b - t.a, t.c - t.a), at, target_camera, target_size, depth);
      }
    }
    vstore3(motion, pixel, scene_flow);
    vstore2(shift, pixel, optical_flow);
    visible[pixel] = is_visible ? 1 : 0;
  }
}
