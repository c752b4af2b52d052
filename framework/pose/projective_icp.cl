// Projective ICP of a model's map against a frame's [thesis 3.3]: every point, or every so-many-th of a
// level, is matched with the point at the pixel that it projects to; point to plane [Eq. 3.2] with the
// model's normals, which are fused from many frames. Compiled behind lanes.cl, surface_map.cl,
// rigid_equation.h and rigid_step.cl.

// The state of the motion: it moves a point p to R (p - FROM) + TO.
#define TO 9
#define STATUS 12  // 0, or FAILED, or 1 + the level at which it converged
#define ITERATIONS 13
#define FROM 16
#define EXTENT 19  // root mean square distance of the source's points from their middle, FROM; mm
#define TURNED 20  // since the start, as a vector (radians)
#define SHIFTED 24
#define LAST 32  // the sums of its last matches
#define FAILED -1

#define RUN (32 * WIDTH)  // points of a row that a work-item adds up

// How many of so many pixels a level looks at that takes every so-many-th, from half of that on.
static inline int sampled(int size, int step) { return (size + step / 2) / step; }

// The offsets in a map `width` pixels wide of WIDTH samples of a row, NONE beyond the row's end.
static inline Pixels sampled_pixels(int row, int first, int columns, int width, int step) {
  const Lanes column = first + LANE_OFFSETS;
  const Pixels pixels =
      (Pixels)(row * step + (step - 1) / 2) * width + TO_INT(column) * step + (step - 1) / 2;
  return select(NONE, pixels, column < (Lanes)columns);
}

static inline Vector finite_or_none(Vector v) {
  const Lanes farthest = FARTHEST;
  return only(fabs(v.x) < farthest && fabs(v.y) < farthest && fabs(v.z) < farthest, v);
}

// Of a map at samples that begin at column `first`.
static inline Vector sampled_vectors(Pixels pixels, int first, int columns, int step, int offset,
                                     global const float* map) {
  if (step == 1 && first + WIDTH <= columns) return finite_or_none(load_vectors(map + 3 * offset, WIDTH));
  return gather(pixels, map);
}

// ------------------------------------------------------------------------------------------------------
// start

// Of a row of samples: the sum of x, y, z, 1 and x^2 + y^2 + z^2.
kernel void measure(int2 size, int step, global const float* points, global float* partials) {
  const int row = get_global_id(0), columns = sampled(size.x, step);
  if (row >= sampled(size.y, step)) return;
  Vector sum = {0, 0, 0};
  Lanes count = 0, squares = 0;
  for (int first = 0; first < columns; first += WIDTH) {
    const Vector p = gather(sampled_pixels(row, first, columns, size.x, step), points);
    const Truth there = p.z > (Lanes)0;
    sum.x += WHERE(there, p.x);
    sum.y += WHERE(there, p.y);
    sum.z += WHERE(there, p.z);
    count += WHERE(there, (Lanes)1);
    squares += WHERE(there, inner(p, p));
  }
  vstore4((float4)(sum_of(sum.x), sum_of(sum.y), sum_of(sum.z), sum_of(count)), row, partials);
  partials[4 * sampled(size.y, step) + row] = sum_of(squares);
}

// `start`: the rows of a rotation, then a shift (mm), from the source's frame to the target's.
kernel void begin(int rows, global const float* partials, float16 start, global float* state) {
  float4 sum = 0;
  float squares = 0;
  for (int row = 0; row < rows; ++row) {
    sum += vload4(row, partials);
    squares += partials[4 * rows + row];
  }
  const float count = fmax(sum.w, 1.0f);
  const float3 middle = sum.xyz / count;
  for (int i = 0; i < LAST + SUMS; ++i) state[i] = 0;
  vstore3(middle, 0, state + FROM);
  state[EXTENT] = sqrt(fmax(squares / count - dot(middle, middle), 1.0f));
  vstore3(start.s012, 0, state);
  vstore3(start.s345, 1, state);
  vstore3(start.s678, 2, state);
  vstore3((float3)(dot(start.s012, middle), dot(start.s345, middle), dot(start.s678, middle)) + start.s9ab, 0,
          state + TO);
}

// --------------------------------------------------------------------------------------------------
// equations

static inline Vector turned(const float* R, Vector v) {
  const Vector result = {R[0] * v.x + R[1] * v.y + R[2] * v.z, R[3] * v.x + R[4] * v.y + R[5] * v.z,
                         R[6] * v.x + R[7] * v.y + R[8] * v.z};
  return result;
}

static inline Vector minus_point(Vector v, const float* point) {
  const Vector difference = {v.x - point[0], v.y - point[1], v.z - point[2]};
  return difference;
}

// Standard deviation of a structured-light camera's depths, mm [Nguyen, Izadi, Lovell 2012].
static inline Lanes noise_at(Lanes depth) {
  const Lanes beyond = 1e-3f * depth - 0.4f;
  return 1.2f + 1.9f * beyond * beyond;
}

// The normal equations at the state, a run of samples a work-item. With the normal n turning along, the
// distance n . (p - q) changes with a turn by ((q - pivot) x n): the lever ends at the match.
kernel void accumulate(int level, int2 size, int step, global const float* source_points,
                       global const float* source_normals, float4 camera, int8 frame,
                       global const float* target_points, global const float* target_normals,
                       float max_distance, float noise, float least_cosine, global const float* state,
                       global float* partials) {
  const int columns = sampled(size.x, step), runs = (columns + RUN - 1) / RUN;
  const int row = get_global_id(0) / runs, begin = (get_global_id(0) - row * runs) * RUN;
  if (row >= sampled(size.y, step) || state[STATUS] == FAILED || state[STATUS] == level + 1) return;
  float R[9], from[3], to[3];
  for (int i = 0; i < 9; ++i) R[i] = state[i];
  for (int i = 0; i < 3; ++i) {
    from[i] = state[FROM + i];
    to[i] = state[TO + i];
  }
  Lanes sums[SUMS_USED];
  clear_sums(sums);
  for (int first = begin; first < min(begin + RUN, columns); first += WIDTH) {
    const Pixels at = sampled_pixels(row, first, columns, size.x, step);
    const int offset = row * size.x + first;
    const Vector p = sampled_vectors(at, first, columns, step, offset, source_points);
    const Truth there = p.z > (Lanes)0;
    if (!ANY(there)) continue;
    const Vector own = turned(R, sampled_vectors(at, first, columns, step, offset, source_normals));
    const Vector arm = turned(R, minus_point(p, from));
    const Vector moved = {arm.x + to[0], arm.y + to[1], arm.z + to[2]};
    const Pixels pixels = select(NONE, project(moved, camera, frame), there);
    const Vector q = gather(pixels, target_points);
    const Vector n = gather(pixels, target_normals);
    const Vector away = minus(moved, q);
    const Truth lands = q.z > (Lanes)0;
    const Lanes farthest = fmax((Lanes)max_distance, noise * noise_at(q.z));
    const Truth matches = lands && inner(away, away) <= farthest * farthest && inner(own, own) > (Lanes)0 &&
                          (inner(own, n) >= (Lanes)least_cosine || inner(n, n) == (Lanes)0);
    add_matches(matches, minus_point(q, to), away, own, sums);
    sums[LANDED] += WHERE(lands, (Lanes)1);
    sums[SAMPLES] += WHERE(there, (Lanes)1);
  }
  store_sums(sums, partials + SUMS * get_global_id(0));
}

// Sums over all runs, in order, four sums a work-item.
static inline void add_runs(int runs, global const float* partials, global float* sums) {
  for (int k = get_local_id(0); k < SUMS / 4; k += get_local_size(0)) {
    float4 sum = 0;
    for (int run = 0; run < runs; ++run) sum += vload4(k + SUMS / 4 * run, partials);
    vstore4(sum, k, sums);
  }
  barrier(CLK_GLOBAL_MEM_FENCE);
}

// One Gauss-Newton step, by one work-group. damping: share of the mean diagonal that pulls back to the start,
// so that what the matches do not tell stays there; tolerance: mm that a last step stays below.
kernel void take_step(int level, int runs, global const float* partials, float damping, float tolerance,
                      global float* state) {
  if (state[STATUS] == FAILED || state[STATUS] == level + 1) return;
  add_runs(runs, partials, state + LAST);
  if (get_local_id(0) > 0) return;
  float sums[SUMS];
  for (int k = 0; k < SUMS; ++k) sums[k] = state[LAST + k];
  state[ITERATIONS] += 1;
  const float extent = state[EXTENT];
  float A[36], b[6];
  const float pull = scaled_equations(sums, extent, damping, A, b);
  for (int i = 0; i < 3; ++i) {
    b[i] -= pull * extent * state[TURNED + i];
    b[3 + i] -= pull * state[SHIFTED + i];
  }
  if (!(sums[MATCHES] >= 6) || !solve_cholesky(A, b)) {
    state[STATUS] = FAILED;
    return;
  }
  const float3 turn = (float3)(b[0], b[1], b[2]) / extent, shift = (float3)(b[3], b[4], b[5]);
  turn_pose(turn, state);
  vstore3(vload3(0, state + TO) + shift, 0, state + TO);
  vstore3(vload3(0, state + TURNED) + turn, 0, state + TURNED);
  vstore3(vload3(0, state + SHIFTED) + shift, 0, state + SHIFTED);
  if (length(turn) * extent < tolerance && length(shift) < tolerance) state[STATUS] = level + 1;
}
