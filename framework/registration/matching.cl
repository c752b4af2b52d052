// Matching with a target [thesis 4.2], WIDTH points a work-item: with the target point at the pixel that a
// point projects to, or one near it. Compiled behind lanes.cl and surface_map.cl.

// Between neighbouring pixels: a surface seen under more than 84 degrees, or two of them.
#define STEEPEST_SLOPE 10.0f

// What does not fill WIDTH points repeats the last one.
Vector load_selected(global const int* selected, int count, global const float* vectors) {
  int at[WIDTH];
  for (int lane = 0; lane < WIDTH; ++lane) at[lane] = selected[min(lane, count - 1)];
  return gather(LOAD_INT(at), vectors);
}

// Of those that have a target point at the pixel that they project to, that pixel; `q`: the target points.
Pixels target_pixels(Vector p, float4 camera, int8 frame, global const float* target_points, Vector* q) {
  const Pixels pixels = project(p, camera, frame);
  *q = gather(pixels, target_points);
  return select(NONE, pixels, q->z > (Lanes)0);
}

Lanes distances(Vector p, Vector q) {
  const Vector way = minus(p, q);
  return sqrt(inner(way, way));
}

// Whether target points q are near enough to p and face alike. Without a normal on either side distance alone
// decides.
Truth are_acceptable(Vector p, Vector normals, Vector q, Vector target_normals, float max_distance,
                     float least_cosine) {
  const Truth have_normals =
      inner(normals, normals) > (Lanes)0 && inner(target_normals, target_normals) > (Lanes)0;
  return q.z > (Lanes)0 && distances(p, q) <= (Lanes)max_distance &&
         (!have_normals || inner(normals, target_normals) >= (Lanes)least_cosine);
}

// Whether a camera at the origin sees the side of the surface that the normals point to. Without a normal it
// is taken to.
Truth are_facing(Vector p, Vector normals, float least_facing) {
  return !(inner(normals, normals) > (Lanes)0) || -inner(normals, p) >= least_facing * sqrt(inner(p, p));
}

// A vector of the target; one that is not finite, or so long that its square is not, counts as none.
float3 load_finite(int pixel, global const float* vectors) {
  const float3 v = vload3(pixel, vectors);
  return all(fabs(v) < FARTHEST) ? v : (float3)(0);
}

// The same of one point and one pixel.
int is_acceptable(float3 p, float3 normal, int pixel, global const float* target_points,
                  global const float* target_normals, float max_distance, float least_cosine) {
  const float3 target_normal = load_finite(pixel, target_normals);
  const int has_normals = dot(normal, normal) > 0 && dot(target_normal, target_normal) > 0;
  return distance(p, vload3(pixel, target_points)) <= max_distance &&
         (!has_normals || dot(normal, target_normal) >= least_cosine);
}

// The least distance between a point at depth 1 and the viewing ray of a pixel, per pixel between the two.
float distance_per_pixel(float4 camera, int8 frame) {
  const float2 corner = fmax(camera.zw, convert_float2(frame.s45) - camera.zw) / camera.xy;
  return 1 / (fmax(camera.x, camera.y) * sqrt(1 + dot(corner, corner)));
}

// Offset of the nearest acceptable target point at most `radius` pixels away in u and v from where p projects
// to, the first one in row-major order on a tie; -1 where there is none. Searched ring by ring, until no
// pixel further out can be nearer.
int nearest_pixel(float3 p, float3 normal, int radius, float4 camera, int8 frame,
                  global const float* target_points, global const float* target_normals, float max_distance,
                  float least_cosine) {
  if (!(p.z > 0)) return -1;
  const float2 at = round((float2)(camera.x * p.x / p.z + camera.z, camera.y * p.y / p.z + camera.w)) -
                    convert_float2(frame.s01);
  if (!(at.x + radius >= 0 && at.y + radius >= 0 && at.x - radius < frame.s2 && at.y - radius < frame.s3))
    return -1;
  const int2 centre = convert_int2(at);
  const float rounding = 0.999f;
  const float per_ring = rounding * p.z * distance_per_pixel(camera, frame);
  int best = -1;
  float best_distance = max_distance;
  for (int ring = 0; ring <= radius && (ring - 0.5f) * per_ring <= best_distance; ++ring)
    for (int v = max(centre.y - ring, 0); v <= min(centre.y + ring, frame.s3 - 1); ++v) {
      const int step = abs(v - centre.y) == ring ? 1 : max(2 * ring, 1);  // only the ends of inner rows
      for (int u = centre.x - ring; u <= centre.x + ring; u += step) {
        if (u < 0 || u >= frame.s2) continue;
        const int pixel = v * frame.s2 + u;
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

// Whether the target ends, or jumps in depth, at most `rim` pixels from a pixel that has a point. What lies
// beyond is not seen: the nearest point of all that went out of sight is found here.
int is_rim(int pixel, int rim, float4 camera, int8 frame, global const float* target_points) {
  const int u = pixel % frame.s2, v = pixel / frame.s2;
  if (u < rim || v < rim || u + rim >= frame.s2 || v + rim >= frame.s3) return 1;
  const float z = target_points[3 * pixel + 2];
  const float jump = STEEPEST_SLOPE * rim * z / fmax(camera.x, camera.y);
  for (int dv = -rim; dv <= rim; dv += rim)
    for (int du = -rim; du <= rim; du += rim) {
      const float other = load_finite(pixel + dv * frame.s2 + du, target_points).z;
      if (!(other > 0 && fabs(other - z) <= jump)) return 1;
    }
  return 0;
}

// The pixel of the target point nearest to p that is found from `pixel`, from pixel to pixel nearer to p, at
// most `steps` of them.
int descend(float3 p, int pixel, int steps, int8 frame, global const float* target_points) {
  float least = distance(p, vload3(pixel, target_points));
  int is_nearer = 1;
  for (int step = 0; step < steps && is_nearer; ++step) {
    const int u = pixel % frame.s2, v = pixel / frame.s2;
    is_nearer = 0;
    for (int y = max(v - 1, 0); y <= min(v + 1, frame.s3 - 1); ++y)
      for (int x = max(u - 1, 0); x <= min(u + 1, frame.s2 - 1); ++x) {
        const float3 q = load_finite(y * frame.s2 + x, target_points);
        const float away = distance(p, q);
        if (!(q.z > 0 && away < least)) continue;
        pixel = y * frame.s2 + x;
        least = away;
        is_nearer = 1;
      }
  }
  return pixel;
}

// The pixels of the target points nearest to p that a walk of at most `steps` steps from `pixels` finds: from
// the foot of p on one tangent plane to that on the next; where that comes no nearer, from pixel to pixel.
// `q`: the target points at `pixels`.
Pixels closest_pixels(Vector p, Pixels pixels, Vector q, int steps, float4 camera, int8 frame,
                      global const float* target_points, global const float* target_normals) {
  Lanes least = distances(p, q);
  Truth moving = pixels >= (Pixels)0, arrived = 0;
  for (int step = 0; step < steps && ANY(moving); ++step) {
    const Vector n = gather(pixels, target_normals);
    const Vector foot = minus(p, scaled(n, inner(minus(p, q), n)));
    Vector at_next;
    const Pixels next = target_pixels(foot, camera, frame, target_points, &at_next);
    const Lanes away = distances(p, at_next);
    arrived = select(arrived, next == pixels, moving);
    moving = moving && next >= (Pixels)0 && away < least;
    pixels = select(pixels, next, moving);
    least = select(least, away, moving);
    q = chosen(q, at_next, moving);
  }
  const Truth unsure = pixels >= (Pixels)0 && !arrived;
  if (!ANY(unsure)) return pixels;
  int at[WIDTH], is_unsure[WIDTH];
  float x[WIDTH], y[WIDTH], z[WIDTH];
  STORE_INT(pixels, at);
  STORE_INT(unsure, is_unsure);
  STORE_VECTOR(p, x, y, z);
  for (int lane = 0; lane < WIDTH; ++lane)
    if (is_unsure[lane])
      at[lane] = descend((float3)(x[lane], y[lane], z[lane]), at[lane], steps, frame, target_points);
  return LOAD_INT(at);
}

// As `pixels`; of points without one that may be seen, the nearest acceptable one within `radius` pixels.
// `q`: the target points at `pixels`, then at those.
Pixels look_around(Pixels pixels, Truth facing, Vector p, Vector normals, int radius, float4 camera,
                   int8 frame, global const float* target_points, global const float* target_normals,
                   float max_distance, float least_cosine, Vector* q) {
  const Truth missing = facing && pixels < (Pixels)0;
  if (!ANY(missing)) return pixels;
  int at[WIDTH], is_missing[WIDTH];
  float x[WIDTH], y[WIDTH], z[WIDTH], nx[WIDTH], ny[WIDTH], nz[WIDTH];
  STORE_INT(pixels, at);
  STORE_INT(missing, is_missing);
  STORE_VECTOR(p, x, y, z);
  STORE_VECTOR(normals, nx, ny, nz);
  for (int lane = 0; lane < WIDTH; ++lane)
    if (is_missing[lane])
      at[lane] =
          nearest_pixel((float3)(x[lane], y[lane], z[lane]), (float3)(nx[lane], ny[lane], nz[lane]), radius,
                        camera, frame, target_points, target_normals, max_distance, least_cosine);
  *q = gather(LOAD_INT(at), target_points);
  return LOAD_INT(at);
}

// Unit vectors half-way between the normals of matches; (0, 0, 0) where they are opposite.
Vector mean_normals(Vector a, Vector b) {
  const Vector sum = {a.x + b.x, a.y + b.y, a.z + b.z};
  const Lanes squares = inner(sum, sum);
  return only(squares > (Lanes)1e-6f, scaled(sum, 1.0f / sqrt(squares)));
}

kernel void match(int count, global const int* selected, global const float* rest, global const float* moved,
                  global const float* normals, float4 camera, int8 frame, global const float* target_points,
                  global const float* target_normals, float max_distance, float least_cosine,
                  float least_facing, int hole_radius, int search_radius, int steps, int rim, int symmetric,
                  global float* data, global float* confidence) {
  const int first = get_global_id(0) * WIDTH;
  if (first >= count) return;
  const int there = min(WIDTH, count - first);
  const Vector p = load_selected(selected + first, there, moved);
  const Vector n = load_selected(selected + first, there, normals);
  const Truth facing = are_facing(p, n, least_facing);
  Vector q;
  Pixels pixels = select(NONE, target_pixels(p, camera, frame, target_points, &q), facing);
  if (hole_radius > 0)
    pixels = look_around(pixels, facing, p, n, hole_radius, camera, frame, target_points, target_normals,
                         max_distance, least_cosine, &q);
  if (steps > 0) {
    pixels = closest_pixels(p, pixels, q, steps, camera, frame, target_points, target_normals);
    q = gather(pixels, target_points);
  }
  pixels = select(NONE, pixels,
                  pixels >= (Pixels)0 &&
                      are_acceptable(p, n, q, gather(pixels, target_normals), max_distance, least_cosine));
  if (search_radius > 0)
    pixels = look_around(pixels, facing, p, n, search_radius, camera, frame, target_points, target_normals,
                         max_distance, least_cosine, &q);
  int at[WIDTH];
  STORE_INT(pixels, at);
  for (int lane = 0; lane < there; ++lane)
    if (rim > 0 && at[lane] >= 0 && is_rim(at[lane], rim, camera, frame, target_points)) at[lane] = -1;
  pixels = LOAD_INT(at);
  const Vector pull = only(pixels >= (Pixels)0, minus(q, load_vectors(rest + 3 * first, there)));
  Vector plane = gather(pixels, target_normals);
  if (symmetric) plane = only(inner(plane, plane) > (Lanes)0, mean_normals(plane, n));
  float x[WIDTH], y[WIDTH], z[WIDTH], nx[WIDTH], ny[WIDTH], nz[WIDTH];
  STORE_VECTOR(pull, x, y, z);
  STORE_VECTOR(plane, nx, ny, nz);
  for (int lane = 0; lane < there; ++lane) {
    const int i = first + lane;
    vstore3((float3)(x[lane], y[lane], z[lane]), 2 * i, data);
    vstore3((float3)(nx[lane], ny[lane], nz[lane]), 2 * i + 1, data);
    confidence[i] = at[lane] >= 0 ? 1 : 0;
  }
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

// Distance of each point to the target point at its pixel, or where there is none to the nearest one within
// `hole_radius` pixels, where it may be seen and that is acceptable, else -1.
kernel void measure(int count, global const float* moved, global const float* normals, float4 camera,
                    int8 frame, global const float* target_points, global const float* target_normals,
                    float max_distance, float least_cosine, float least_facing, int hole_radius,
                    global float* residuals) {
  const int first = get_global_id(0) * WIDTH;
  if (first >= count) return;
  const Vector p = load_vectors(moved + 3 * first, count - first);
  const Vector n = load_vectors(normals + 3 * first, count - first);
  const Truth facing = are_facing(p, n, least_facing);
  Vector q;
  Pixels pixels = target_pixels(p, camera, frame, target_points, &q);
  if (hole_radius > 0)
    pixels = look_around(pixels, facing, p, n, hole_radius, camera, frame, target_points, target_normals,
                         max_distance, least_cosine, &q);
  const Truth is_known =
      facing && are_acceptable(p, n, q, gather(pixels, target_normals), max_distance, least_cosine);
  float values[WIDTH];
  STORE(select((Lanes)-1, distances(p, q), is_known), values);
  for (int lane = 0; lane < min(WIDTH, count - first); ++lane) residuals[first + lane] = values[lane];
}

// Per work-item of CHUNK points, in a fixed order: the sum of the residuals that are known, how many those
// are, how many points have one or project onto a target point, how many points are lost (not finite, or so
// far away that squares are not), and the sum of the squares of all where one that is not known, or longer,
// is `cut`.
kernel void sum_residuals(int count, global const float* moved, float4 camera, int8 frame,
                          global const float* target_points, global const float* residual, float cut,
                          global float8* partials) {
  const int chunk = get_global_id(0) * CHUNK;
  const int end = min(chunk + CHUNK, count);
  if (chunk >= count) return;
  Lanes sum = 0, matched = 0, landed = 0, lost = 0, robust = 0, squares = 0;
  for (int first = chunk; first < end; first += WIDTH) {
    const Vector p = load_vectors(moved + 3 * first, end - first);
    float values[WIDTH];
    for (int lane = 0; lane < WIDTH; ++lane) values[lane] = first + lane < end ? residual[first + lane] : -1;
    const Lanes r = LOAD(values);
    const Lanes there = WHERE(LANE_OFFSETS < (Lanes)(end - first), (Lanes)1);
    const Truth have_residual = r >= (Lanes)0;
    Truth have_landed = have_residual;
    if (ANY(!have_residual)) {
      Vector q;
      have_landed = have_landed || target_pixels(p, camera, frame, target_points, &q) >= (Pixels)0;
    }
    landed += WHERE(have_landed, there);
    const Lanes known = WHERE(have_residual, (Lanes)1);
    const Lanes counted = select((Lanes)cut, fmin(r, (Lanes)cut), have_residual);
    const Truth is_finite =
        fabs(p.x) < (Lanes)FARTHEST && fabs(p.y) < (Lanes)FARTHEST && fabs(p.z) < (Lanes)FARTHEST;
    sum += known * fmax(r, (Lanes)0);
    matched += known;
    lost += there - WHERE(is_finite, there);
    robust += there * counted * counted;
    squares += known * r * r;
  }
  partials[get_global_id(0)] = (float8)(sum_of(sum), sum_of(matched), sum_of(landed), sum_of(lost),
                                        sum_of(robust), sum_of(squares), 0, 0);
}

kernel void total_residual(int count, global const float8* partials, global float8* total) {
  float8 sum = 0;
  for (int i = 0; i < count; ++i) sum += partials[i];
  total[0] = sum;
}
