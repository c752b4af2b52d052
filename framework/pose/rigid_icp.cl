// Rigid ICP [thesis 3.3]: projective matches, point to plane [Eq. 3.2], several poses side by side. Compiled
// behind lanes.cl, surface_map.cl and rigid_step.cl.
//
// Samples lie coordinate by coordinate (x y z of the point, then of its normal), `padded` to whole vectors; a
// sample without a point has z = 0. A pose is 16 numbers: the rows of R, where the pivot goes, and what
// became of it. It moves a point p to R (p - pivot) + where the pivot goes.

#define POSE_SIZE 16
#define PIVOT 9
#define STATUS 12  // 0, or FAILED, or 1 + the level at which it converged
#define ITERATIONS 13
#define SPREAD 14  // root mean square distance of its last matches in the last level; 0: none yet
#define FAILED -1
#define LEAST_TRIM 0.1f  // of max_distance

#define CHUNK (16 * WIDTH)  // samples that a work-item adds up

static inline Vector load(global const float* samples, int padded, int first) {
  const Vector v = {LOAD(samples + first), LOAD(samples + padded + first),
                    LOAD(samples + 2 * padded + first)};
  return v;
}

// A rotation about `from` and the place `to` that `from` goes to.
typedef struct {
  float R[9];
  float from[3], to[3];
} Motion;

static inline void forward(global const float* pose, global const float* pivot, Motion* motion) {
  for (int i = 0; i < 9; ++i) motion->R[i] = pose[i];
  for (int i = 0; i < 3; ++i) {
    motion->from[i] = pivot[i];
    motion->to[i] = pose[PIVOT + i];
  }
}

static inline void backward(global const float* pose, global const float* pivot, Motion* motion) {
  for (int i = 0; i < 9; ++i) motion->R[i] = pose[3 * (i % 3) + i / 3];
  for (int i = 0; i < 3; ++i) {
    motion->from[i] = pose[PIVOT + i];
    motion->to[i] = pivot[i];
  }
}

static inline Vector turned(const Motion* m, Vector v) {
  const Vector result = {m->R[0] * v.x + m->R[1] * v.y + m->R[2] * v.z,
                         m->R[3] * v.x + m->R[4] * v.y + m->R[5] * v.z,
                         m->R[6] * v.x + m->R[7] * v.y + m->R[8] * v.z};
  return result;
}

static inline Vector arm_of(const Motion* m, Vector p) {
  const Vector arm = {p.x - m->from[0], p.y - m->from[1], p.z - m->from[2]};
  return turned(m, arm);
}

static inline Vector placed(const Motion* m, Vector arm) {
  const Vector moved = {arm.x + m->to[0], arm.y + m->to[1], arm.z + m->to[2]};
  return moved;
}

// ------------------------------------------------------------------------------------------------- samples

// Every `stride`-th of the pixels that have a point.
kernel void pack(int count, global const int* pixels, int stride, global const float* points,
                 global const float* normals, int padded, global float* samples) {
  const int i = get_global_id(0);
  if (i >= padded) return;
  float3 p = 0, n = 0;
  if (i * stride < count) {
    p = vload3(pixels[i * stride], points);
    n = vload3(pixels[i * stride], normals);
    if (!all(fabs(p) < FARTHEST)) p = 0;
    if (!all(fabs(n) < FARTHEST)) n = 0;
  }
  samples[i] = p.x;
  samples[padded + i] = p.y;
  samples[2 * padded + i] = p.z;
  samples[3 * padded + i] = n.x;
  samples[4 * padded + i] = n.y;
  samples[5 * padded + i] = n.z;
}

// Mean and root mean square distance from it, of the source's samples and of the target's: a work-item each.
kernel void measure(int padded_source, global const float* source, int padded_target,
                    global const float* target, global float4* extents) {
  const int is_target = get_global_id(0);
  if (is_target > 1) return;
  global const float* samples = is_target ? target : source;
  const int padded = is_target ? padded_target : padded_source;
  float4 sum = 0;
  for (int i = 0; i < padded; ++i)
    if (samples[2 * padded + i] > 0)
      sum += (float4)(samples[i], samples[padded + i], samples[2 * padded + i], 1);
  const float3 mean = sum.xyz / fmax(sum.w, 1.0f);
  float squares = 0;
  for (int i = 0; i < padded; ++i) {
    const float3 away = (float3)(samples[i], samples[padded + i], samples[2 * padded + i]) - mean;
    if (samples[2 * padded + i] > 0) squares += dot(away, away);
  }
  extents[is_target] = (float4)(mean, fmax(sqrt(squares / fmax(sum.w, 1.0f)), 1e-3f));
}

// --------------------------------------------------------------------------------------------------- poses

// What a pose is made of: the rows of R, t (mm), and whether it puts the middle of the source on that of the
// target instead.
#define START_SIZE 13
#define SHIFT 9
#define IS_CENTRED 12

kernel void set_out(int count, global const float* starts, global const float4* extents,
                    global float* poses) {
  const int i = get_global_id(0);
  if (i >= count) return;
  global const float* start = starts + START_SIZE * i;
  global float* pose = poses + POSE_SIZE * i;
  const float3 pivot = extents[0].xyz;
  for (int row = 0; row < 3; ++row) {
    vstore3(vload3(row, start), row, pose);
    pose[PIVOT + row] = start[IS_CENTRED] != 0 ? ((global const float*)(extents + 1))[row]
                                               : dot(vload3(row, start), pivot) + start[SHIFT + row];
  }
  for (int i = STATUS; i < POSE_SIZE; ++i) pose[i] = 0;
}

// Makes the pose with the least residual pose 0, to go on from, and the last one pose 1.
kernel void choose(int count, global const float* residuals, global float* poses) {
  int best = 0;
  for (int i = 1; i < count - 1; ++i)
    if (residuals[i] < residuals[best]) best = i;
  for (int i = 0; i < POSE_SIZE; ++i) {
    poses[i] = poses[POSE_SIZE * best + i];
    poses[POSE_SIZE + i] = poses[POSE_SIZE * (count - 1) + i];
  }
  poses[STATUS] = 0;
}

// How far apart the points of a match may lie, `share` of the way from the coarsest level's distance down.
static inline float farthest_match(global const float4* extents, float max_distance, float coarse,
                                   float share) {
  return max_distance * pow(fmax(coarse * extents[0].w / max_distance, 1.0f), share);
}

// ------------------------------------------------------------------------------------------------ equations

// The normal equations of some poses, a chunk of samples of one pose a work-item; of a negative level
// whatever became of the pose. trim, where it is not 0: once the pose has matches of this level, planes may
// lie that many times their spread away.
kernel void accumulate(int count, int level, int padded, global const float* samples,
                       global const float* poses, global const float4* extents, float4 camera, int8 frame,
                       global const float* points, global const float* normals, float max_distance,
                       float coarse, float share, float trim, float least_cosine, global float* partials) {
  const int chunks = (padded + CHUNK - 1) / CHUNK;
  const int which = get_global_id(0) / chunks;
  if (which >= count) return;
  global const float* pose = poses + POSE_SIZE * which;
  if (level >= 0 && (pose[STATUS] == FAILED || pose[STATUS] == level + 1)) return;
  Motion motion;
  forward(pose, (global const float*)extents, &motion);
  const float far = farthest_match(extents, max_distance, coarse, share);
  const float farthest_plane =
      trim > 0 && pose[SPREAD] > 0 ? fmax(trim * pose[SPREAD], LEAST_TRIM * max_distance) : far;
  const int first = (get_global_id(0) - which * chunks) * CHUNK;
  Lanes sums[SUMS_USED];
  clear_sums(sums);
  for (int i = first; i < min(first + CHUNK, padded); i += WIDTH) {
    const Vector p = load(samples, padded, i);
    const Vector arm = arm_of(&motion, p);
    const Vector moved = placed(&motion, arm);
    const Pixels pixels = project(moved, camera, frame);
    const Vector q = gather(pixels, points);
    const Vector n = gather(pixels, normals);
    const Vector own = turned(&motion, load(samples + 3 * padded, padded, i));
    const Vector offset = minus(moved, q);
    const Truth lands = p.z > (Lanes)0 && q.z > (Lanes)0;
    const Truth matches = lands && inner(n, n) > (Lanes)0 && inner(offset, offset) <= (Lanes)(far * far) &&
                          fabs(inner(offset, n)) <= (Lanes)farthest_plane &&
                          (inner(own, n) >= (Lanes)least_cosine || inner(own, own) == (Lanes)0);
    add_matches(matches, arm, offset, n, sums);
    sums[LANDED] += WHERE(lands, (Lanes)1);
  }
  store_sums(sums, partials + SUMS * get_global_id(0));
}

// Sums of all chunks of a pose, in order.
static inline void add_chunks(int which, int padded, global const float* partials, float* sums) {
  const int chunks = (padded + CHUNK - 1) / CHUNK;
  float16 low = 0, high = 0;
  for (int chunk = which * chunks; chunk < (which + 1) * chunks; ++chunk) {
    low += vload16(2 * chunk, partials);
    high += vload16(2 * chunk + 1, partials);
  }
  vstore16(low, 0, sums);
  vstore16(high, 1, sums);
}

kernel void add_up(int padded, global const float* partials, global float* sums) {
  float added[SUMS];
  add_chunks(0, padded, partials, added);
  for (int k = 0; k < SUMS; ++k) sums[k] = added[k];
}

// One Gauss-Newton step of each pose. damping: share of the mean diagonal, which keeps still what the matches
// do not tell; tolerance: share of the level's distance that a last step stays below.
kernel void take_step(int count, int level, int padded, global const float* partials,
                      global const float4* extents, float max_distance, float coarse, float share, float trim,
                      float fewest, float damping, float tolerance, global float* poses) {
  const int which = get_global_id(0);
  if (which >= count) return;
  global float* pose = poses + POSE_SIZE * which;
  if (pose[STATUS] == FAILED || pose[STATUS] == level + 1) return;
  float sums[SUMS];
  add_chunks(which, padded, partials, sums);
  pose[ITERATIONS] += 1;
  if (trim > 0 && sums[MATCHES] > 0) pose[SPREAD] = sqrt(sums[SQUARES] / sums[MATCHES]);
  const float extent = extents[0].w;
  float A[36], b[6];
  scaled_equations(sums, extent, damping, A, b);
  if (!(sums[MATCHES] >= fewest) || !solve_cholesky(A, b)) {
    pose[STATUS] = FAILED;
    return;
  }
  const float3 turn = (float3)(b[0], b[1], b[2]) / extent, shift = (float3)(b[3], b[4], b[5]);
  turn_pose(turn, pose);
  vstore3(vload3(PIVOT / 3, pose) + shift, PIVOT / 3, pose);
  const float short_step = tolerance * farthest_match(extents, max_distance, coarse, share);
  if (length(turn) * extent < short_step && length(shift) < short_step) pose[STATUS] = level + 1;
}

// ------------------------------------------------------------------------------------------------- judgement

// Cut distances, both ways: the source's samples from the target's map, then the target's samples, moved
// back, from the source's. Where the map shows nothing, or something further away, the distance is `cut`
// extents. What faces away from the camera is hidden, what leaves its view is not known: both do not count.
kernel void judge(int count, int padded_source, global const float* source, int padded_target,
                  global const float* target, global const float* poses, global const float4* extents,
                  float4 camera_source, int8 frame_source, global const float* source_points,
                  float4 camera_target, int8 frame_target, global const float* target_points, float cut,
                  global float2* partials) {
  const int source_chunks = (padded_source + CHUNK - 1) / CHUNK;
  const int chunks = source_chunks + (padded_target + CHUNK - 1) / CHUNK;
  const int which = get_global_id(0) / chunks, chunk = get_global_id(0) - which * chunks;
  if (which >= count) return;
  const int is_back = chunk >= source_chunks;
  global const float* samples = is_back ? target : source;
  global const float* points = is_back ? source_points : target_points;
  const int padded = is_back ? padded_target : padded_source;
  const float4 camera = is_back ? camera_source : camera_target;
  const int8 frame = is_back ? frame_source : frame_target;
  Motion motion;
  if (is_back)
    backward(poses + POSE_SIZE * which, (global const float*)extents, &motion);
  else
    forward(poses + POSE_SIZE * which, (global const float*)extents, &motion);
  const Lanes farthest = cut * extents[0].w;
  const int first = (is_back ? chunk - source_chunks : chunk) * CHUNK;
  Lanes sum = 0, known = 0;
  for (int i = first; i < min(first + CHUNK, padded); i += WIDTH) {
    const Vector p = load(samples, padded, i);
    const Vector moved = placed(&motion, arm_of(&motion, p));
    const Vector normal = turned(&motion, load(samples + 3 * padded, padded, i));
    const Pixels pixels = project(moved, camera, frame);
    const Vector q = gather(pixels, points);
    const Vector offset = minus(moved, q);
    const Truth counts = pixels != NONE && p.z > (Lanes)0 && inner(normal, moved) <= (Lanes)0;
    const Lanes distance = fmin(sqrt(inner(offset, offset)), farthest);
    sum += WHERE(counts, select(farthest, distance, q.z > (Lanes)0));
    known += WHERE(counts, (Lanes)1);
  }
  partials[get_global_id(0)] = (float2)(sum_of(sum), sum_of(known));
}

// The mean of both ways' means, in mm; one that knows too few samples counts as cut.
kernel void verdict(int count, int padded_source, int padded_target, global const float2* partials,
                    global const float4* extents, float cut, float2 fewest, global float* residuals) {
  const int which = get_global_id(0);
  if (which >= count) return;
  const int source_chunks = (padded_source + CHUNK - 1) / CHUNK;
  const int chunks = source_chunks + (padded_target + CHUNK - 1) / CHUNK;
  float2 there = 0, back = 0;
  for (int chunk = 0; chunk < source_chunks; ++chunk) there += partials[which * chunks + chunk];
  for (int chunk = source_chunks; chunk < chunks; ++chunk) back += partials[which * chunks + chunk];
  const float farthest = cut * extents[0].w;
  residuals[which] = 0.5f * ((there.y >= fewest.x ? there.x / there.y : farthest) +
                             (back.y >= fewest.y ? back.x / back.y : farthest));
}
