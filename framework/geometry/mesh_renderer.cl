// Z-buffer over triangles. `camera`: fx, fy, cx, cy. Points: mm in the camera's frame, x y z in turn.
//
// Corners are rounded to 1/SUBPIXELS of a pixel, and whether a ray meets a triangle is then decided in whole
// numbers, without any rounding: two triangles that share an edge leave no pixel between them. Only triangles
// that reach behind the camera, or too far beside it, are decided in floats.

#define SUBPIXELS 4096
#define SUBPIXEL_BITS 12
#define WIDEST 131072.0f  // pixels from the image's corner: differences of products then fit into a long
#define OUTSIDE INT_MIN   // of what has no place in the image

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

kernel void place(global const float* points, int count, float4 camera, float near, global int* places) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const float3 p = vload3(i, points);
  const float u = camera.x * p.x / p.z + camera.z, v = camera.y * p.y / p.z + camera.w;
  const bool is_placed = p.z >= near && p.z < INFINITY && fabs(u) < WIDEST && fabs(v) < WIDEST;
  places[2 * i] = is_placed ? convert_int_rte(u * SUBPIXELS) : OUTSIDE;
  places[2 * i + 1] = is_placed ? convert_int_rte(v * SUBPIXELS) : OUTSIDE;
}

bool is_placed(int3 corners, global const int* places) {
  return places[2 * corners.x] != OUTSIDE && places[2 * corners.y] != OUTSIDE &&
         places[2 * corners.z] != OUTSIDE;
}

int first_from(int a, int b, int c) { return (min(min(a, b), c) + SUBPIXELS - 1) >> SUBPIXEL_BITS; }

int last_until(int a, int b, int c) { return max(max(a, b), c) >> SUBPIXEL_BITS; }

// The first and the last row of the image that each triangle may be seen in.
kernel void reach(global const int* triangles, int count, global const float* points,
                  global const int* places, float near, int2 size, global int* rows) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const int3 corners = vload3(i, triangles);
  int2 reached = {0, -1};
  if (is_placed(corners, places)) {
    const int a = places[2 * corners.x + 1], b = places[2 * corners.y + 1], c = places[2 * corners.z + 1];
    reached = (int2)(first_from(a, b, c), last_until(a, b, c));
  } else {
    const Triangle t = triangle_of(corners, points);
    if (all(isfinite(t.a)) && all(isfinite(t.b)) && all(isfinite(t.c)) && plane_of(t).farthest >= near)
      reached.y = size.y - 1;
  }
  vstore2(reached, i, rows);
}

// Rows of the image that one work-item draws, with the least depth yet and the first triangle that has it.
typedef struct {
  int first, last, width;
  global float* depth;
  global int* seen;
} Band;

void show(int triangle, float depth, int u, int v, Band band) {
  const int pixel = v * band.width + u;
  if (!(depth < band.depth[pixel])) return;
  band.depth[pixel] = depth;
  band.seen[pixel] = triangle;
}

// Twice the area of (p, q, r), positive when they run clockwise in the image.
long area(long2 p, long2 q, long2 r) { return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x); }

void draw_placed(int index, Triangle t, int2 rows, long2 a, long2 b, long2 c, float4 camera, Band band) {
  const int first_u = max(first_from(a.x, b.x, c.x), 0),
            last_u = min(last_until(a.x, b.x, c.x), band.width - 1);
  const int first_v = max(rows.x, band.first), last_v = min(rows.y, band.last);
  const long whole = area(a, b, c);
  if (first_u > last_u || whole == 0) return;  // seen from its edge: its neighbours are seen instead
  if (whole < 0) {
    const long2 other = b;
    b = c;
    c = other;
  }
  const long2 corner = {(long)first_u * SUBPIXELS, (long)first_v * SUBPIXELS};
  long row_ab = area(a, b, corner), row_bc = area(b, c, corner), row_ca = area(c, a, corner);
  const long2 ab = (b - a) * SUBPIXELS, bc = (c - b) * SUBPIXELS, ca = (a - c) * SUBPIXELS;
  const Plane plane = plane_of(t);
  const float slope_u = plane.normal.x / camera.x, slope_v = plane.normal.y / camera.y;
  for (int v = first_v; v <= last_v; ++v) {
    long on_ab = row_ab, on_bc = row_bc, on_ca = row_ca;
    const float facing = slope_v * (v - camera.w) + plane.normal.z;
    for (int u = first_u; u <= last_u; ++u) {
      if ((on_ab | on_bc | on_ca) >= 0)
        show(index, depth_on(plane, slope_u * (u - camera.z) + facing), u, v, band);
      on_ab -= ab.y;
      on_bc -= bc.y;
      on_ca -= ca.y;
    }
    row_ab += ab.x;
    row_bc += bc.x;
    row_ca += ca.x;
  }
}

// A triangle that is not placed in the image as a whole: see draw() of render.cpp.
void draw_across(int index, Triangle t, float4 camera, float near, Band band) {
  const float rounding = 4e-7f;
  const Plane plane = plane_of(t);
  float3 bc = cross(t.b, t.c), ca = cross(t.c, t.a), ab = cross(t.a, t.b);
  const float sign = dot(bc, t.a) < 0 ? -1.0f : 1.0f;
  const float3 slack =
      rounding * (float3)(length(t.b) * length(t.c), length(t.c) * length(t.a), length(t.a) * length(t.b));
  for (int v = band.first; v <= band.last; ++v) {
    for (int u = 0; u < band.width; ++u) {
      const float3 ray = ray_through(u, v, camera);
      const float3 shares = sign * (float3)(dot(bc, ray), dot(ca, ray), dot(ab, ray));
      const float3 tolerance = slack * length(ray);
      if (any(shares < -tolerance) ||
          !(shares.x + shares.y + shares.z > tolerance.x + tolerance.y + tolerance.z))
        continue;
      const float depth = depth_on(plane, dot(plane.normal, ray));
      if (depth >= near) show(index, depth, u, v, band);
    }
  }
}

// A work-item draws all triangles, one after the other, in `height` rows of its own: no other one writes
// there. The depth is 0 where nothing is seen.
kernel void draw(global const int* triangles, int count, global const float* points, global const int* places,
                 global const int* rows, float4 camera, float near, int2 size, int height,
                 global float* depth, global int* seen) {
  const int top = get_global_id(0) * height;
  const Band band = {top, min(top + height, size.y) - 1, size.x, depth, seen};
  const int begin = band.first * size.x, end = (band.last + 1) * size.x;
  for (int pixel = begin; pixel < end; ++pixel) {
    depth[pixel] = INFINITY;
    seen[pixel] = -1;
  }
  for (int i = 0; i < count; ++i) {
    const int2 reached = vload2(i, rows);
    if (reached.x > band.last || reached.y < band.first) continue;
    const int3 corners = vload3(i, triangles);
    const Triangle t = triangle_of(corners, points);
    if (is_placed(corners, places))
      draw_placed(i, t, reached, convert_long2(vload2(corners.x, places)),
                  convert_long2(vload2(corners.y, places)), convert_long2(vload2(corners.z, places)), camera,
                  band);
    else
      draw_across(i, t, camera, near, band);
  }
  for (int pixel = begin; pixel < end; ++pixel)
    if (seen[pixel] < 0) depth[pixel] = 0;
}
