// Projective association [thesis 4.2]: the target point at the pixel that a source point projects to.
// Compiled behind lanes.cl.

#define FARTHEST 1e18f  // farthest_depth of image.h

// Between neighbouring pixels: a surface seen under more than 84 degrees, or two of them.
#define STEEPEST_SLOPE 10.0f

typedef struct {
  float max_distance;
  float least_cosine;
  int search_radius;
  int steps;
  int rim;
} Limits;

// A vector of the target; one that is not finite, or so long that its square is not, counts as none.
float3 load_finite(int pixel, global const float* vectors) {
  const float3 v = vload3(pixel, vectors);
  return all(fabs(v) < FARTHEST) ? v : (float3)(0);
}

// Offset of that pixel, or -1 when it lies outside or has no point. camera: fx, fy, cx, cy.
int target_pixel(float3 p, float4 camera, int2 size, global const float* target_points) {
  if (!(p.z > 0)) return -1;
  const float u = round(camera.x * p.x / p.z + camera.z);
  const float v = round(camera.y * p.y / p.z + camera.w);
  if (!(u >= 0 && v >= 0 && u < size.x && v < size.y)) return -1;
  const int pixel = (int)v * size.x + (int)u;
  return load_finite(pixel, target_points).z > 0 ? pixel : -1;
}

// Whether target pixel `pixel` is near enough to the point p and faces alike. Without a normal on either side
// distance alone decides.
int is_acceptable(float3 p, float3 normal, int pixel, global const float* target_points,
                  global const float* target_normals, float max_distance, float least_cosine) {
  const float3 target_normal = load_finite(pixel, target_normals);
  const int has_normals = dot(normal, normal) > 0 && dot(target_normal, target_normal) > 0;
  return distance(p, vload3(pixel, target_points)) <= max_distance &&
         (!has_normals || dot(normal, target_normal) >= least_cosine);
}

// The least distance between a point at depth 1 and the viewing ray of a pixel, per pixel between the two.
float distance_per_pixel(float4 camera, int2 size) {
  const float2 corner = fmax(camera.zw, convert_float2(size) - camera.zw) / camera.xy;
  return 1 / (fmax(camera.x, camera.y) * sqrt(1 + dot(corner, corner)));
}

// Offset of the nearest acceptable target point at most `radius` pixels away in u and v from where p projects
// to, the first one in row-major order on a tie; -1 where there is none. Searched ring by ring, until no
// pixel further out can be nearer.
int nearest_pixel(float3 p, float3 normal, int radius, float4 camera, int2 size,
                  global const float* target_points, global const float* target_normals, float max_distance,
                  float least_cosine) {
  if (!(p.z > 0)) return -1;
  const float2 at = round((float2)(camera.x * p.x / p.z + camera.z, camera.y * p.y / p.z + camera.w));
  if (!(at.x + radius >= 0 && at.y + radius >= 0 && at.x - radius < size.x && at.y - radius < size.y))
    return -1;
  const int2 centre = convert_int2(at);
  const float rounding = 0.999f;
  const float per_ring = rounding * p.z * distance_per_pixel(camera, size);
  int best = -1;
  float best_distance = max_distance;
  for (int ring = 0; ring <= radius && (ring - 0.5f) * per_ring <= best_distance; ++ring)
    for (int v = max(centre.y - ring, 0); v <= min(centre.y + ring, size.y - 1); ++v) {
      const int step = abs(v - centre.y) == ring ? 1 : max(2 * ring, 1);  // only the ends of inner rows
      for (int u = centre.x - ring; u <= centre.x + ring; u += step) {
        if (u < 0 || u >= size.x) continue;
        const int pixel = v * size.x + u;
        const float3 q = vload3(pixel, target_points);
        const float away = distance(p, q);
        const int is_nearer = away < best_distance || (away == best_distance && (best < 0 || pixel < best));
        if (!(q.z > 0) || !is_nearer) continue;
        if (!is_acceptable(p, normal, pixel, target_points, target_normals, max_distance, least_cosine))
          continue;
        best = pixel;
        best_distance = away;
      }
    }
  return best;
}

// Whether a camera at the origin sees the side of the surface that the normal points to. Without a normal it
// is taken to.
int is_facing(float3 p, float3 normal, float least_facing) {
  return !(dot(normal, normal) > 0) || -dot(normal, p) >= least_facing * length(p);
}

// Whether the target ends, or jumps in depth, at most `rim` pixels from a pixel that has a point. What lies
// beyond is not seen: the nearest point of all that went out of sight is found here.
int is_rim(int pixel, int rim, float4 camera, int2 size, global const float* target_points) {
  const int u = pixel % size.x, v = pixel / size.x;
  if (u < rim || v < rim || u + rim >= size.x || v + rim >= size.y) return 1;
  const float z = target_points[3 * pixel + 2];
  const float jump = STEEPEST_SLOPE * rim * z / fmax(camera.x, camera.y);
  for (int dv = -rim; dv <= rim; dv += rim)
    for (int du = -rim; du <= rim; du += rim) {
      const float other = load_finite(pixel + dv * size.x + du, target_points).z;
      if (!(other > 0 && fabs(other - z) <= jump)) return 1;
    }
  return 0;
}

// The pixel of the target point nearest to p that a walk of at most `steps` steps from `pixel` finds: from
// the foot of p on one tangent plane to that on the next; where that comes no nearer, from pixel to pixel.
int closest_pixel(float3 p, int pixel, int steps, float4 camera, int2 size, global const float* target_points,
                  global const float* target_normals) {
  float least = distance(p, vload3(pixel, target_points));
  int is_nearer = 1, is_foot = 0;
  for (int step = 0; step < steps && is_nearer; ++step) {
    const float3 n = load_finite(pixel, target_normals);
    const float3 foot = p - dot(p - vload3(pixel, target_points), n) * n;
    const int next = target_pixel(foot, camera, size, target_points);
    const float away = next >= 0 ? distance(p, vload3(next, target_points)) : least;
    is_foot = next == pixel;
    is_nearer = away < least;
    if (is_nearer) pixel = next;
    least = fmin(away, least);
  }
  is_nearer = !is_foot;
  for (int step = 0; step < steps && is_nearer; ++step) {
    const int u = pixel % size.x, v = pixel / size.x;
    is_nearer = 0;
    for (int y = max(v - 1, 0); y <= min(v + 1, size.y - 1); ++y)
      for (int x = max(u - 1, 0); x <= min(u + 1, size.x - 1); ++x) {
        const float3 q = load_finite(y * size.x + x, target_points);
        const float away = distance(p, q);
        if (!(q.z > 0 && away < least)) continue;
        pixel = y * size.x + x;
        least = away;
        is_nearer = 1;
      }
  }
  return pixel;
}

// The pixel of the match of a point that may be seen, -1 where there is none.
int matched_pixel(float3 p, float3 normal, Limits limits, float4 camera, int2 size,
                  global const float* target_points, global const float* target_normals) {
  int pixel = target_pixel(p, camera, size, target_points);
  // A walk may begin beside a pixel that is missing.
  if (pixel < 0 && limits.steps > 0)
    pixel = nearest_pixel(p, normal, 1, camera, size, target_points, target_normals, limits.max_distance,
                          limits.least_cosine);
  if (pixel >= 0 && limits.steps > 0)
    pixel = closest_pixel(p, pixel, limits.steps, camera, size, target_points, target_normals);
  if (pixel >= 0 && !is_acceptable(p, normal, pixel, target_points, target_normals, limits.max_distance,
                                   limits.least_cosine))
    pixel = -1;
  if (pixel < 0 && limits.search_radius > 0)
    pixel = nearest_pixel(p, normal, limits.search_radius, camera, size, target_points, target_normals,
                          limits.max_distance, limits.least_cosine);
  if (pixel >= 0 && limits.rim > 0 && is_rim(pixel, limits.rim, camera, size, target_points)) pixel = -1;
  return pixel;
}

// The unit vector half-way between the normals of a match; (0, 0, 0) where they are opposite.
float3 mean_normal(float3 a, float3 b) {
  const float3 sum = a + b;
  return dot(sum, sum) > 1e-6f ? normalize(sum) : (float3)(0);
}

// One constraint a work-item.
kernel void match(int count, global const int* selected, global const float* rest, global const float* moved,
                  global const float* normals, float4 camera, int2 size, global const float* target_points,
                  global const float* target_normals, float max_distance, float least_cosine,
                  float least_facing, int search_radius, int steps, int rim, int symmetric,
                  global float* data, global float* confidence) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const Limits limits = {max_distance, least_cosine, search_radius, steps, rim};
  const float3 p = vload3(selected[i], moved);
  const float3 normal = vload3(selected[i], normals);
  int pixel = -1;
  if (is_facing(p, normal, least_facing))
    pixel = matched_pixel(p, normal, limits, camera, size, target_points, target_normals);
  float3 plane = pixel >= 0 ? load_finite(pixel, target_normals) : (float3)(0);
  if (symmetric && dot(plane, plane) > 0) plane = mean_normal(plane, normal);
  vstore3(pixel >= 0 ? vload3(pixel, target_points) - vload3(i, rest) : (float3)(0), 2 * i, data);
  vstore3(plane, 2 * i + 1, data);
  confidence[i] = pixel >= 0 ? 1 : 0;
}

kernel void weigh(int count, global const float* weights, global float* confidence) {
  const int i = get_global_id(0);
  if (i < count) confidence[i] *= weights[i];
}

#define CHUNK 256

// One work-item, which stops at the first constraint in force.
kernel void find_in_force(int count, global const float* confidence, global int* found) {
  int i = 0;
  while (i < count && !(confidence[i] > 0)) ++i;
  *found = i < count;
}

// The pixels that WIDTH points, of which `count` are there, project to, and the points and normals of the
// target there; (0, 0, 0) where there is none. What target_pixel says, but rounded and divided for all at
// once.
void load_targets(Vector p, int count, float4 camera, int2 size, global const float* target_points,
                  global const float* target_normals, Vector* points, Vector* normals) {
  const Lanes u = camera.x * p.x / p.z + camera.z, v = camera.y * p.y / p.z + camera.w;
  const Lanes left = floor(u), top = floor(v);
  const Truth is_inside = p.z > (Lanes)0 && u > (Lanes)-0.5f && v > (Lanes)-0.5f &&
                          u < (Lanes)(size.x - 0.5f) && v < (Lanes)(size.y - 0.5f);
  float column[WIDTH], row[WIDTH], x[WIDTH], y[WIDTH], z[WIDTH], nx[WIDTH], ny[WIDTH], nz[WIDTH];
  STORE(WHERE(is_inside, left + WHERE(u - left >= (Lanes)0.5f, (Lanes)1)), column);
  STORE(select((Lanes)-1, top + WHERE(v - top >= (Lanes)0.5f, (Lanes)1), is_inside), row);
  for (int lane = 0; lane < WIDTH; ++lane) {
    float3 q = 0, n = 0;
    if (lane < count && row[lane] >= 0) {
      const int pixel = (int)row[lane] * size.x + (int)column[lane];
      q = load_finite(pixel, target_points);
      n = load_finite(pixel, target_normals);
    }
    x[lane] = q.x;
    y[lane] = q.y;
    z[lane] = q.z;
    nx[lane] = n.x;
    ny[lane] = n.y;
    nz[lane] = n.z;
  }
  const Vector q = {LOAD(x), LOAD(y), LOAD(z)}, n = {LOAD(nx), LOAD(ny), LOAD(nz)};
  *points = only(q.z > (Lanes)0, q);
  *normals = n;
}

// Distance of each point to the target point at its pixel where it may be seen and that is acceptable, else
// -1. WIDTH points a work-item.
kernel void measure(int count, global const float* moved, global const float* normals, float4 camera,
                    int2 size, global const float* target_points, global const float* target_normals,
                    float max_distance, float least_cosine, float least_facing, global float* distances) {
  const int first = get_global_id(0) * WIDTH;
  if (first >= count) return;
  const Vector p = load_vectors(moved + 3 * first, count - first);
  const Vector n = load_vectors(normals + 3 * first, count - first);
  Vector q, m;
  load_targets(p, count - first, camera, size, target_points, target_normals, &q, &m);
  const Vector way = {p.x - q.x, p.y - q.y, p.z - q.z};
  const Lanes distance = sqrt(inner(way, way));
  const Truth has_normal = inner(n, n) > (Lanes)0;
  const Truth is_facing = !has_normal || -inner(n, p) >= least_facing * sqrt(inner(p, p));
  const Truth is_alike = !(has_normal && inner(m, m) > (Lanes)0) || inner(n, m) >= (Lanes)least_cosine;
  float values[WIDTH];
  STORE(
      select((Lanes)-1, distance, q.z > (Lanes)0 && is_facing && is_alike && distance <= (Lanes)max_distance),
      values);
  for (int lane = 0; lane < min(WIDTH, count - first); ++lane) distances[first + lane] = values[lane];
}

float total(Lanes lanes) {
  float values[WIDTH];
  STORE(lanes, values);
  float sum = 0;
  for (int lane = 0; lane < WIDTH; ++lane) sum += values[lane];
  return sum;
}

// Per work-item of CHUNK points, in a fixed order: the sum of the residuals that are known, how many those
// are, how many points have one or project onto a target point, how many points are lost (not finite, or so
// far away that squares are not), and the sum of the squares of all where one that is not known, or longer,
// is `cut`.
kernel void sum_residuals(int count, global const float* moved, float4 camera, int2 size,
                          global const float* target_points, global const float* residual, float cut,
                          global float8* partials) {
  const int chunk = get_global_id(0) * CHUNK;
  const int end = min(chunk + CHUNK, count);
  if (chunk >= count) return;
  Lanes sum = 0, matched = 0, lost = 0, squares = 0;
  int landed = 0;
  for (int first = chunk; first < end; first += WIDTH) {
    const Vector p = load_vectors(moved + 3 * first, end - first);
    float values[WIDTH];
    for (int lane = 0; lane < WIDTH; ++lane) {
      values[lane] = first + lane < end ? residual[first + lane] : -1;
      if (first + lane < end && values[lane] < 0)
        landed += target_pixel(vload3(first + lane, moved), camera, size, target_points) >= 0;
    }
    const Lanes r = LOAD(values);
    const Lanes there = WHERE(LANE_OFFSETS < (Lanes)(end - first), (Lanes)1);
    const Lanes known = WHERE(r >= (Lanes)0, (Lanes)1);
    const Lanes counted = select((Lanes)cut, fmin(r, (Lanes)cut), r >= (Lanes)0);
    const Truth is_finite =
        fabs(p.x) < (Lanes)FARTHEST && fabs(p.y) < (Lanes)FARTHEST && fabs(p.z) < (Lanes)FARTHEST;
    sum += known * fmax(r, (Lanes)0);
    matched += known;
    lost += there - WHERE(is_finite, there);
    squares += there * counted * counted;
  }
  const float known = total(matched);
  partials[get_global_id(0)] =
      (float8)(total(sum), known, known + landed, total(lost), total(squares), 0, 0, 0);
}

kernel void total_residual(int count, global const float8* partials, global float8* total) {
  float8 sum = 0;
  for (int i = 0; i < count; ++i) sum += partials[i];
  total[0] = sum;
}
