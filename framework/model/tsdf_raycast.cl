// What a camera sees of a truncated signed distance field. Compiled behind tsdf_grid.cl. `area`: a
// window that begins and ends with whole tiles of the image. `ranges`: bits of the depths between which each
// tile's rays can meet the surface.

kernel void clear_ranges(int count, global int* ranges) {
  const int tile = get_global_id(0);
  if (tile >= count) return;
  ranges[2 * tile] = INT_MAX;
  ranges[2 * tile + 1] = 0;
}

// Widens the ranges of the tiles that may show what is behind the surface in a brick. Bits of depths that are
// not negative are ordered as the depths are.
kernel void bound_rays(int4 bricks, global const int* contents, float16 placing, float4 camera, int4 area,
                       global volatile int* ranges) {
  const int index = get_global_id(0);
  if (index >= bricks.x * bricks.y * bricks.z || !(contents[index] & INSIDE)) return;
  const Box box = box_of(brick_at(index, bricks), 1.0f, placing);
  const int4 tiles = tiles_of(box, camera, area);
  const int near = as_int(fmax(box.centre.z - box.reach.z, 0.0f)), far = as_int(box.centre.z + box.reach.z);
  for (int row = tiles.y; row <= tiles.w; ++row) {
    for (int column = tiles.x; column <= tiles.z; ++column) {
      const int tile = row * tiles_over(area).x + column;
      atomic_min(ranges + 2 * tile, near);
      atomic_max(ranges + 2 * tile + 1, far);
    }
  }
}

#if WIDTH == 16
#define TO_LANES(whole) convert_float16(whole)
#else
#define TO_LANES(whole) ((float)(whole))
#endif

typedef struct {
  global const short* distances;
  int3 size;
  int layer;  // voxels
} Field;

typedef struct {
  Lanes first, second;
} Pair;

// The distances at some voxels and at the next ones along x, in parts of the truncation.
Pair gather_pair(Field field, Truth at) {
#define TWO(offset) as_int(vload2(0, field.distances + (offset)))
  const Truth values = GATHER(Truth, TWO, at);
  const Pair pair = {TO_LANES(values << 16 >> 16), TO_LANES(values >> 16)};
  return pair;
}

Vector along(Vector from, Vector direction, Lanes z) {
  const Vector p = {fma(direction.x, z, from.x), fma(direction.y, z, from.y), fma(direction.z, z, from.z)};
  return p;
}

// The distance at the nearest voxel; 0 outside of the grid, too.
Lanes nearest_distance(Field field, Vector p) {
  const Lanes x = p.x + 0.5f, y = p.y + 0.5f, z = p.z + 0.5f;
  const Truth in_grid = x >= (Lanes)0 && y >= (Lanes)0 && z >= (Lanes)0 && x < (Lanes)field.size.x &&
                        y < (Lanes)field.size.y && z < (Lanes)field.size.z;
  const Truth at = select((Truth)0, TO_INT(x) + field.size.x * TO_INT(y) + field.layer * TO_INT(z), in_grid);
  // By twos: what is gathered has 32 bits.
#define TWO_ALIGNED(offset) ((global const int*)field.distances)[offset]
  const Truth both = GATHER(Truth, TWO_ALIGNED, at >> 1);
  return WHERE(in_grid, TO_LANES(both << (16 - 16 * (at & 1)) >> 16));
}

typedef struct {
  Truth corner;     // the voxel before the point along each axis, one away from the grid's border at least
  Vector fraction;  // how far the point lies behind it
  Truth in_grid;
} Cell;

Cell cell_of(Field field, Vector p) {
  const Truth in_grid = p.x >= (Lanes)1 && p.y >= (Lanes)1 && p.z >= (Lanes)1 &&
                        p.x < (Lanes)(field.size.x - 2) && p.y < (Lanes)(field.size.y - 2) &&
                        p.z < (Lanes)(field.size.z - 2);
  const Truth x = TO_INT(select((Lanes)1, p.x, in_grid)), y = TO_INT(select((Lanes)1, p.y, in_grid)),
              z = TO_INT(select((Lanes)1, p.z, in_grid));
  const Cell cell = {x + field.size.x * y + field.layer * z,
                     {p.x - TO_LANES(x), p.y - TO_LANES(y), p.z - TO_LANES(z)},
                     in_grid};
  return cell;
}

typedef struct {
  Lanes value;
  Vector gradient;  // a voxel
  Vector smooth;    // by central differences of the field, where all their voxels were observed
  Truth is_known;
} Sample;

Lanes mixed(Lanes a, Lanes b, Lanes share) { return fma(share, b - a, a); }

Truth both_known(Pair pair) { return pair.first != (Lanes)0 && pair.second != (Lanes)0; }

// The trilinear interpolant and its gradient between the pairs of a cell's four edges along x: y z in turn.
Sample interpolate(Pair p00, Pair p10, Pair p01, Pair p11, Cell cell) {
  const Vector f = cell.fraction;
  const Lanes v00 = mixed(p00.first, p00.second, f.x), v10 = mixed(p10.first, p10.second, f.x);
  const Lanes v01 = mixed(p01.first, p01.second, f.x), v11 = mixed(p11.first, p11.second, f.x);
  const Lanes v0 = mixed(v00, v10, f.y), v1 = mixed(v01, v11, f.y);
  const Lanes along_x = mixed(mixed(p00.second - p00.first, p10.second - p10.first, f.y),
                              mixed(p01.second - p01.first, p11.second - p11.first, f.y), f.z);
  const Vector gradient = {along_x, mixed(v10 - v00, v11 - v01, f.z), v1 - v0};
  const Sample sample = {
      mixed(v0, v1, f.z), gradient, gradient,
      cell.in_grid && both_known(p00) && both_known(p10) && both_known(p01) && both_known(p11)};
  return sample;
}

static inline Sample sample_at(Field field, Vector p) {
  const Cell cell = cell_of(field, p);
  const int row = field.size.x, layer = field.layer;
  return interpolate(gather_pair(field, cell.corner), gather_pair(field, cell.corner + row),
                     gather_pair(field, cell.corner + layer), gather_pair(field, cell.corner + layer + row),
                     cell);
}

// The same with the smooth gradient.
static inline Sample smooth_sample_at(Field field, Vector p) {
  const Cell cell = cell_of(field, p);
  const Truth c = cell.corner;
  const int row = field.size.x, layer = field.layer;
  const Vector f = cell.fraction;
  const Pair p00 = gather_pair(field, c), p10 = gather_pair(field, c + row);
  const Pair p01 = gather_pair(field, c + layer), p11 = gather_pair(field, c + layer + row);
  Sample sample = interpolate(p00, p10, p01, p11, cell);
  Truth all_known = 1;
  Lanes x[4];
  Lanes y_before, y_behind, z_before, z_behind;
  // Along x: the rows of the cell's edges, from the voxel before to the one behind.
#define DIFFERENCE(pair, at, result)                                                                     \
  {                                                                                                      \
    const Lanes before = gather_pair(field, (at)-1).first, behind = gather_pair(field, (at) + 1).second; \
    all_known = all_known && before != (Lanes)0 && behind != (Lanes)0;                                   \
    result = mixed(pair.second - before, behind - pair.first, f.x);                                      \
  }
  DIFFERENCE(p00, c, x[0])
  DIFFERENCE(p10, c + row, x[1])
  DIFFERENCE(p01, c + layer, x[2])
  DIFFERENCE(p11, c + layer + row, x[3])
#define BESIDE(at, other, share, result)                                                         \
  {                                                                                              \
    const Pair one = gather_pair(field, at), two = gather_pair(field, other);                    \
    all_known = all_known && both_known(one) && both_known(two);                                 \
    result = mixed(mixed(one.first, one.second, f.x), mixed(two.first, two.second, f.x), share); \
  }
  BESIDE(c - row, c + layer - row, f.z, y_before)
  BESIDE(c + 2 * row, c + layer + 2 * row, f.z, y_behind)
  BESIDE(c - layer, c + row - layer, f.y, z_before)
  BESIDE(c + 2 * layer, c + row + 2 * layer, f.y, z_behind)
  const Lanes y0 = mixed(mixed(p00.first, p00.second, f.x), mixed(p01.first, p01.second, f.x), f.z);
  const Lanes y1 = mixed(mixed(p10.first, p10.second, f.x), mixed(p11.first, p11.second, f.x), f.z);
  const Lanes z0 = mixed(mixed(p00.first, p00.second, f.x), mixed(p10.first, p10.second, f.x), f.y);
  const Lanes z1 = mixed(mixed(p01.first, p01.second, f.x), mixed(p11.first, p11.second, f.x), f.y);
  const Vector smooth = {0.5f * mixed(mixed(x[0], x[1], f.y), mixed(x[2], x[3], f.y), f.z),
                         0.5f * mixed(y1 - y_before, y_behind - y0, f.y),
                         0.5f * mixed(z1 - z_before, z_behind - z0, f.z)};
  sample.smooth = chosen(sample.gradient, smooth, all_known);
  return sample;
}

typedef struct {
  Lanes front, behind;  // mm along the axis: where the ray was last before the surface, where first behind it
  Lanes front_value, behind_value;
  Truth is_found;
} Crossing;

// Follows rays until they pass from before the surface to behind it. A ray that comes out of the surface from
// behind ends there, having seen nothing. `voxel` and `truncation`: mm along the axis. Where nothing was
// observed steps are as long as the truncation: as thick is what was observed on either side of a surface.
// One that leads to behind a surface is taken back, and that way gone in steps of a voxel.
static inline Crossing march(Field field, Vector from, Vector direction, float near, float far, Lanes voxel,
                             Lanes truncation) {
  Crossing crossing = {0, 0, 0, 0, 0};
  const Lanes reach = 0.75f / STEPS * truncation;
  Lanes z = near, last = 0, last_z = near, careful_to = near;
  Truth is_marching = z <= (Lanes)far;
  while (ANY(is_marching)) {
    const Lanes value = nearest_distance(field, along(from, direction, z));
    const Truth passes = is_marching && last > (Lanes)0 && value < (Lanes)0;
    crossing.front = select(crossing.front, last_z, passes);
    crossing.behind = select(crossing.behind, z, passes);
    crossing.front_value = select(crossing.front_value, last, passes);
    crossing.behind_value = select(crossing.behind_value, value, passes);
    crossing.is_found = crossing.is_found || passes;
    is_marching = is_marching && !passes && !(last < (Lanes)0 && value > (Lanes)0);
    const Truth is_too_far = value < (Lanes)0 && last == (Lanes)0 && z > careful_to;
    careful_to = select(careful_to, z, is_too_far);
    const Lanes step = select(fmax(value * reach, voxel), truncation, value == (Lanes)0 && z > careful_to);
    last = select(value, (Lanes)0, is_too_far);
    last_z = select(z, last_z, is_too_far);
    z = select(z + step, last_z + voxel, is_too_far);
    is_marching = is_marching && z <= (Lanes)far;
  }
  return crossing;
}

// Where Newton's method takes `z` on the ray, held near the crossing.
Lanes improved(Lanes z, Sample sample, Vector direction, Crossing crossing, Lanes voxel) {
  const Lanes width = crossing.behind - crossing.front;
  const Lanes mean = (crossing.behind_value - crossing.front_value) / width;
  const Lanes slope = fmin(inner(sample.gradient, direction), 0.25f * mean);
  return clamp(z - sample.value / slope, crossing.front - voxel, crossing.behind + voxel);
}

// What WIDTH pixels from (u, v) on see, between two depths. `placing`: from the camera's frame to voxels.
// `back`: the same from voxels to the camera's frame.
void cast(Field field, float near, float far, float16 placing, float16 back, float4 camera, int u, int v,
          float voxel, float truncation, Vector* point, Vector* normal) {
  const Vector ray = {((Lanes)(u - camera.z) + LANE_OFFSETS) / camera.x, (v - camera.w) / camera.y, 1};
  const Vector direction = {placing.s0 * ray.x + placing.s1 * ray.y + placing.s2,
                            placing.s4 * ray.x + placing.s5 * ray.y + placing.s6,
                            placing.s8 * ray.x + placing.s9 * ray.y + placing.sa};
  const Vector from = {placing.s3, placing.s7, placing.sb};
  const Lanes shorter = 1.0f / sqrt(inner(ray, ray));
  const Crossing crossing = march(field, from, direction, near, far, voxel * shorter, truncation * shorter);
  if (!ANY(crossing.is_found)) return;
  Lanes z = mixed(crossing.front, crossing.behind,
                  crossing.front_value / (crossing.front_value - crossing.behind_value));
  for (int round = 0; round < 2; ++round)
    z = improved(z, sample_at(field, along(from, direction, z)), direction, crossing, voxel);
  const Sample sample = smooth_sample_at(field, along(from, direction, z));
  z = improved(z, sample, direction, crossing, voxel);
  const Vector g = sample.smooth;
  const Vector turned = {back.s0 * g.x + back.s1 * g.y + back.s2 * g.z,
                         back.s4 * g.x + back.s5 * g.y + back.s6 * g.z,
                         back.s8 * g.x + back.s9 * g.y + back.sa * g.z};
  const Truth is_seen = crossing.is_found && sample.is_known && inner(turned, ray) < (Lanes)0;
  *point = only(is_seen, scaled(ray, z));
  *normal = only(is_seen, scaled(turned, 1.0f / sqrt(inner(turned, turned))));
}

// Stores what the pixels of a row from (u, v) on have, those of them that are in the window.
void store_in_window(Vector vectors, int u, int v, int4 window, global float* map) {
  const int first = max(window.x - u, 0), count = min(window.x + window.z - u, WIDTH);
  const int offset = (v - window.y) * window.z + u - window.x;
  if (first == 0) {
    store_vectors(vectors, count, map + 3 * offset);
    return;
  }
  float x[WIDTH], y[WIDTH], z[WIDTH];
  STORE_VECTOR(vectors, x, y, z);
  for (int lane = first; lane < count; ++lane)
    vstore3((float3)(x[lane], y[lane], z[lane]), offset + lane, map);
}

// A work-group casts the rays of a tile. `window`: the part of the area that is asked for.
kernel void raycast(global const short* distances, int4 bricks, global const int* ranges, float16 placing,
                    float16 back, float4 camera, int4 area, int4 window, float voxel, float truncation,
                    global float* points, global float* normals) {
  const int tile = get_group_id(0), columns = tiles_over(area).x;
  const int2 corner = area.xy + (int2)(tile % columns, tile / columns) * TILE;
  const Field field = {distances, bricks.xyz * (int3)(BRICK_X, BRICK_Y, BRICK_Z),
                       bricks.x * BRICK_X * bricks.y * BRICK_Y};
  const bool is_empty = ranges[2 * tile] == INT_MAX;
  const float near = as_float(ranges[2 * tile]), far = as_float(ranges[2 * tile + 1]);
  for (int part = get_local_id(0); part < TILE * TILE / WIDTH; part += get_local_size(0)) {
    const int u = corner.x + part * WIDTH % TILE, v = corner.y + part * WIDTH / TILE;
    if (v < window.y || v >= window.y + window.w || u + WIDTH <= window.x || u >= window.x + window.z)
      continue;
    Vector point = {0, 0, 0}, normal = {0, 0, 0};
    if (!is_empty) cast(field, near, far, placing, back, camera, u, v, voxel, truncation, &point, &normal);
    store_in_window(point, u, v, window, points);
    store_in_window(normal, u, v, window, normals);
  }
}
