// Fuses a depth map into a truncated signed distance field. Compiled behind lattice.cl. `window`: the
// map's. The reference computes the same, rounding by rounding: products and sums are joined where it says
// fma and nowhere else.
#pragma OPENCL FP_CONTRACT OFF

#if WIDTH == 16
#define LOAD_DISTANCES(address) convert_float16(vload16(0, address))
#define STORE_DISTANCES(value, address) vstore16(convert_short16(convert_int16_rte(value)), 0, address)
#define STORE_WEIGHTS(value, address) vstore16(convert_uchar16(convert_int16(value)), 0, address)
#else
#define LOAD_DISTANCES(address) ((float)*(address))
#define STORE_DISTANCES(value, address) (*(address) = convert_short(convert_int_rte(value)))
#define STORE_WEIGHTS(value, address) (*(address) = convert_uchar(value))
#endif

// Least and greatest depth of each tile; the least is greater where there is none. Also empties the list that
// find_bricks fills.
kernel void bound_depth(global const float* depth, int stride, int4 window, global float* bounds,
                        global int* found) {
  const int2 tiles = tiles_over(window);
  const int tile = get_global_id(0);
  if (tile == 0) found[0] = 0;
  if (tile >= tiles.x * tiles.y) return;
  global const float* corner = depth + (HALO + tile / tiles.x * TILE) * stride + HALO + tile % tiles.x * TILE;
  Lanes least = NO_DEPTH, greatest = -NO_DEPTH;
  for (int row = 0; row < TILE; ++row) {
    for (int column = 0; column < TILE; column += WIDTH) {
      const Lanes d = LOAD(corner + row * stride + column);
      least = fmin(least, d);
      greatest = fmax(greatest, select((Lanes)-NO_DEPTH, d, d < (Lanes)NO_DEPTH));
    }
  }
  float lows[WIDTH], highs[WIDTH];
  STORE(least, lows);
  STORE(greatest, highs);
  for (int lane = 1; lane < WIDTH; ++lane) {
    lows[0] = fmin(lows[0], lows[lane]);
    highs[0] = fmax(highs[0], highs[lane]);
  }
  vstore2((float2)(lows[0], highs[0]), tile, bounds);
}

// Whether the map may tell something of a voxel of the brick: the surface of one that may be near, or that
// nothing is where the brick has something.
bool is_told_of(Box box, bool is_observed, int4 tiles, int tile_columns, float truncation,
                global const float* bounds) {
  const float near = box.centre.z - box.reach.z - truncation, far = box.centre.z + box.reach.z + truncation;
  for (int row = tiles.y; row <= tiles.w; ++row) {
    for (int column = tiles.x; column <= tiles.z; ++column) {
      const float2 bound = vload2(row * tile_columns + column, bounds);
      if (near <= bound.y && (is_observed || far >= bound.x)) return true;
    }
  }
  return false;
}

// Lists a brick, whose voxels are in the box, where fuse() is to look at it: how many, then which; in any
// order, as each is fused apart.
void list_brick(int index, Box box, float4 camera, int4 window, float truncation, global const float* bounds,
                global int* contents, global int* found) {
  const int4 tiles = tiles_of(box, camera, window);
  const bool is_observed = contents[index] != 0;
  if (is_told_of(box, is_observed, tiles, tiles_over(window).x, truncation, bounds)) {
    contents[index] = 0;  // fuse() says anew
    found[1 + atomic_inc(found)] = index;
  }
}

kernel void find_bricks(int4 bricks, float16 placing, float4 camera, int4 window, float truncation,
                        global const float* bounds, global int* contents, global int* found) {
  const int index = get_global_id(0);
  if (index >= bricks.x * bricks.y * bricks.z) return;
  const Box box = box_of(brick_at(index, bricks), 0.0f, placing);
  list_brick(index, box, camera, window, truncation, bounds, contents, found);
}

// The same of a grid that is displaced. `reaches`: see lattice.cl.
kernel void find_displaced_bricks(int4 bricks, float16 placing, float4 camera, int4 window, float truncation,
                                  global const float* bounds, global int* contents, global int* found,
                                  global const float* reaches) {
  const int index = get_global_id(0);
  if (index >= bricks.x * bricks.y * bricks.z) return;
  const Box box = box_of(brick_at(index, bricks), 0.0f, placing);
  list_brick(index, widened(box, vload8(index, reaches), placing), camera, window, truncation, bounds,
             contents, found);
}

typedef struct {
  Lanes depth;  // mm
  Truth is_known;
} Seen;

// What the map shows at places in the image: the depth between four pixels, of which those count that have
// about the depth of the nearest one.
static inline Seen depth_at(Lanes u, Lanes v, Truth in_front, int4 window, int stride, float truncation,
                            global const float* depth) {
  const Lanes left = floor(u), top = floor(v), a = u - left, b = v - top;
  const Truth is_right = a >= (Lanes)0.5f, is_lower = b >= (Lanes)0.5f;
  const Lanes column = left + select((Lanes)0, (Lanes)1, is_right);
  const Lanes row = top + select((Lanes)0, (Lanes)1, is_lower);
  const int2 end = window.xy + window.zw;
  const Truth in_window = in_front && column >= (Lanes)window.x && row >= (Lanes)window.y &&
                          column < (Lanes)end.x && row < (Lanes)end.y;
  const int first = (HALO - window.y) * stride + HALO - window.x;
  const Truth at = select((Truth)0, TO_INT(top) * stride + TO_INT(left) + first, in_window);
#define UPPER_LEFT(offset) depth[offset]
#define UPPER_RIGHT(offset) depth[(offset) + 1]
#define LOWER_LEFT(offset) depth[(offset) + stride]
#define LOWER_RIGHT(offset) depth[(offset) + stride + 1]
  const Lanes d00 = GATHER(Lanes, UPPER_LEFT, at), d10 = GATHER(Lanes, UPPER_RIGHT, at);
  const Lanes d01 = GATHER(Lanes, LOWER_LEFT, at), d11 = GATHER(Lanes, LOWER_RIGHT, at);
  const Lanes nearest = select(select(d00, d10, is_right), select(d01, d11, is_right), is_lower);
#define NEAR(d) select(nearest, d, fabs(d - nearest) < (Lanes)truncation)
  const Lanes upper = fma(a, NEAR(d10) - NEAR(d00), NEAR(d00));
  const Lanes lower = fma(a, NEAR(d11) - NEAR(d01), NEAR(d01));
  const Seen seen = {fma(b, lower - upper, upper), in_window && nearest < (Lanes)NO_DEPTH};
  return seen;
}

// What WIDTH voxels hold, in parts of the truncation, once a map told of them, which counts as `shown`
// frames. `p`: where they lie, in voxels.
static inline Lanes fuse_voxels(Vector p, float16 placing, float4 camera, int4 window, int stride,
                                float truncation, float shown, float max_weight, global const float* depth,
                                global short* distances, global uchar* weights) {
  const Lanes px = fma((Lanes)placing.s0, p.x,
                       fma((Lanes)placing.s1, p.y, fma((Lanes)placing.s2, p.z, (Lanes)placing.s3)));
  const Lanes py = fma((Lanes)placing.s4, p.x,
                       fma((Lanes)placing.s5, p.y, fma((Lanes)placing.s6, p.z, (Lanes)placing.s7)));
  const Lanes pz = fma((Lanes)placing.s8, p.x,
                       fma((Lanes)placing.s9, p.y, fma((Lanes)placing.sa, p.z, (Lanes)placing.sb)));
  const Lanes inverse = 1.0f / pz;
  const Lanes u = fma((Lanes)camera.x, px * inverse, (Lanes)camera.z);
  const Lanes v = fma((Lanes)camera.y, py * inverse, (Lanes)camera.w);
  const Seen seen = depth_at(u, v, pz > (Lanes)0, window, stride, truncation, depth);
  const Lanes ahead = seen.depth - pz;  // mm from the voxel to the surface, along the axis

  const Lanes old = LOAD_DISTANCES(distances);
  const Truth was_observed = old != (Lanes)0;
  const Truth is_told =
      seen.is_known && ahead >= (Lanes)-truncation && (was_observed || ahead < (Lanes)truncation);
  if (!ANY(is_told)) return old;
  const Lanes weight = LOAD_DISTANCES(weights);
  const Lanes told = fmin(ahead, (Lanes)truncation) * (STEPS / truncation);
  const Lanes mean = rint(fma(old, weight, told * shown) / (weight + shown));
  const Lanes now = select(old, select(mean, (Lanes)1, mean == (Lanes)0), is_told);
  STORE_DISTANCES(now, distances);
  STORE_WEIGHTS(select(weight, fmin(weight + shown, (Lanes)max_weight), is_told), weights);
  return now;
}

// A work-group fuses one brick after another, WIDTH voxels of a row at a time. `displacements`: see
// lattice.cl; 0 where nothing is displaced.
static inline void fuse_bricks(global const int* found, int4 bricks, float16 placing, float4 camera,
                               int4 window, int stride, float truncation, float shown, float max_weight,
                               global const float* depth, global short* distances, global uchar* weights,
                               global int* contents, global const float* displacements) {
  const int2 pitch = {bricks.x * BRICK_X, bricks.y * BRICK_Y};
  for (int n = get_group_id(0); n < found[0]; n += get_num_groups(0)) {
    const int3 corner = brick_at(found[1 + n], bricks) * (int3)(BRICK_X, BRICK_Y, BRICK_Z);
    Truth any_observed = 0, any_inside = 0;
    for (int part = get_local_id(0); part < BRICK_X * BRICK_Y * BRICK_Z / WIDTH; part += get_local_size(0)) {
      const int i = part * WIDTH;
      const int3 voxel = corner + (int3)(i % BRICK_X, i / BRICK_X % BRICK_Y, i / (BRICK_X * BRICK_Y));
      Vector p = {convert_float(voxel.x) + LANE_OFFSETS, (Lanes)voxel.y, (Lanes)voxel.z};
      if (displacements != 0) p = displaced(p, voxel, bricks, displacements);
      const size_t at = voxel.x + pitch.x * (voxel.y + (size_t)pitch.y * voxel.z);
      const Lanes now = fuse_voxels(p, placing, camera, window, stride, truncation, shown, max_weight, depth,
                                    distances + at, weights + at);
      any_observed = any_observed || now != (Lanes)0;
      any_inside = any_inside || now < (Lanes)0;
    }
    atomic_or(contents + found[1 + n], (ANY(any_observed) ? OBSERVED : 0) | (ANY(any_inside) ? INSIDE : 0));
  }
}

// The map counts as `shown` frames.
kernel void fuse(global const int* found, int4 bricks, float16 placing, float4 camera, int4 window,
                 int stride, float truncation, float shown, float max_weight, global const float* depth,
                 global short* distances, global uchar* weights, global int* contents) {
  fuse_bricks(found, bricks, placing, camera, window, stride, truncation, shown, max_weight, depth, distances,
              weights, contents, 0);
}

// The same of a grid that is displaced.
kernel void fuse_displaced(global const int* found, int4 bricks, float16 placing, float4 camera, int4 window,
                           int stride, float truncation, float shown, float max_weight,
                           global const float* depth, global short* distances, global uchar* weights,
                           global int* contents, global const float* displacements) {
  fuse_bricks(found, bricks, placing, camera, window, stride, truncation, shown, max_weight, depth, distances,
              weights, contents, displacements);
}
