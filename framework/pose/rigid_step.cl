// Gauss-Newton of a rigid motion: six unknowns, a small turn about a pivot (radians), then a shift (mm).
// Compiled behind lanes.cl, surface_map.cl and rigid_equation.h.

// What matches add up: the upper triangle of J^T J, J^T r, the sum of r^2, then counts: of matches, of points
// that meet one of the target, and of all points.
#define SUMS 32
#define GRADIENT 21
#define SQUARES 27
#define MATCHES 28
#define LANDED 29
#define SAMPLES 30
#define SUMS_USED 31

static inline void clear_sums(Lanes* sums) {
#pragma unroll
  for (int k = 0; k < SUMS_USED; ++k) sums[k] = 0;
}

// Adds those that are matches. lever: from the pivot; offset: from the match to the point.
static inline void add_matches(Truth matches, Vector lever, Vector offset, Vector n, Lanes* sums) {
  const Lanes normal[3] = {WHERE(matches, n.x), WHERE(matches, n.y), WHERE(matches, n.z)};
  const Lanes away[3] = {WHERE(matches, offset.x), WHERE(matches, offset.y), WHERE(matches, offset.z)};
  const Lanes arm[3] = {lever.x, lever.y, lever.z};
  const Lanes r = plane_distance(away, normal);
  Lanes J[6];
  plane_distance_jacobian(arm, normal, J);
  int k = 0;
#pragma unroll
  for (int a = 0; a < 6; ++a)
#pragma unroll
    for (int b = a; b < 6; ++b) sums[k++] += J[a] * J[b];
#pragma unroll
  for (int a = 0; a < 6; ++a) sums[k++] += J[a] * r;
  sums[SQUARES] += r * r;
  sums[MATCHES] += WHERE(matches, (Lanes)1);
}

static inline void store_sums(const Lanes* sums, global float* partial) {
#pragma unroll
  for (int k = 0; k < SUMS_USED; ++k) partial[k] = sum_of(sums[k]);
  for (int k = SUMS_USED; k < SUMS; ++k) partial[k] = 0;
}

// Damped normal equations of sums, turns in mm at `extent`, so that all six unknowns are alike: the lower
// triangle of A, and b. damping: share of the mean diagonal. Returns what it added to the diagonal.
static inline float scaled_equations(const float* sums, float extent, float damping, float* A, float* b) {
  float trace = 0;
  int k = 0;
  for (int i = 0; i < 6; ++i) {
    const float unit = i < 3 ? 1 / extent : 1;
    for (int j = i; j < 6; ++j) A[6 * j + i] = sums[k++] * unit * (j < 3 ? 1 / extent : 1);
    b[i] = -sums[GRADIENT + i] * unit;
    trace += A[7 * i];
  }
  for (int i = 0; i < 6; ++i) A[7 * i] += damping * trace / 6;
  return damping * trace / 6;
}

// Solves A x = b for a positive definite A by its factor L L^T, in place; b becomes x. Whether it could.
static inline int solve_cholesky(float* A, float* b) {
  for (int j = 0; j < 6; ++j) {
    for (int i = 0; i < j; ++i)
      for (int row = j; row < 6; ++row) A[6 * row + j] -= A[6 * row + i] * A[6 * j + i];
    if (!(A[7 * j] > 0)) return 0;
    const float scale = rsqrt(A[7 * j]);
    for (int row = j; row < 6; ++row) A[6 * row + j] *= scale;
  }
  for (int j = 0; j < 6; ++j) {
    for (int i = 0; i < j; ++i) b[j] -= A[6 * j + i] * b[i];
    b[j] /= A[7 * j];
  }
  for (int j = 5; j >= 0; --j) {
    for (int i = j + 1; i < 6; ++i) b[j] -= A[6 * i + j] * b[i];
    b[j] /= A[7 * j];
  }
  return 1;
}

static inline float3 turn_by(float3 axis, float sine, float cosine, float3 v) {
  return cosine * v + sine * cross(axis, v) + (1 - cosine) * dot(axis, v) * axis;
}

// Turns the rows of R as a matrix: R <- exp(turn) R, made orthonormal again.
static inline void turn_pose(float3 turn, global float* pose) {
  const float angle = length(turn);
  const float3 axis = angle > 0 ? turn / angle : (float3)(1, 0, 0);
  const float sine = sin(angle), cosine = cos(angle);
  float3 x = turn_by(axis, sine, cosine, (float3)(pose[0], pose[3], pose[6]));
  float3 y = turn_by(axis, sine, cosine, (float3)(pose[1], pose[4], pose[7]));
  x = x / length(x);
  y = y - dot(x, y) * x;
  y = y / length(y);
  const float3 z = cross(x, y);
  vstore3((float3)(x.x, y.x, z.x), 0, pose);
  vstore3((float3)(x.y, y.y, z.y), 1, pose);
  vstore3((float3)(x.z, y.z, z.z), 2, pose);
}
