// Symmetric 12x12 matrices as packed lower triangles, a node a lane.

#define AT(m, n) ((m) * ((m) + 1) / 2 + (n))

// L D L^T of symmetric positive semi-definite 12x12 matrices (packed lower triangles, a node a lane): leaves
// L below the diagonal and the inverse of D on it. What nothing determines gets zero there: the
// preconditioner does not move it.
static inline void factor(float16* packed) {
  float16 least[12];
  for (int m = 0; m < 12; ++m) least[m] = 1e-5f * packed[AT(m, m)];
  for (int pivot = 0; pivot < 12; ++pivot) {
    const float16 d = packed[AT(pivot, pivot)];
    const float16 inverse = select((float16)(0), 1 / d, d > fmax(least[pivot], 1e-30f));
    packed[AT(pivot, pivot)] = inverse;
    for (int m = pivot + 1; m < 12; ++m) {
      const float16 below = packed[AT(m, pivot)];
      const float16 multiplier = below * inverse;
      for (int n = pivot + 1; n < m; ++n) packed[AT(m, n)] -= packed[AT(n, pivot)] * below;
      packed[AT(m, m)] -= multiplier * below;
      packed[AT(m, pivot)] = multiplier;
    }
  }
}

// y += (packed symmetric matrix) x.
static inline void multiply_packed(global const float16* packed, const float16* x, float16* y) {
#pragma unroll
  for (int m = 0; m < 12; ++m) {
#pragma unroll
    for (int n = 0; n < m; ++n) {
      y[m] += packed[AT(m, n)] * x[n];
      y[n] += packed[AT(m, n)] * x[m];
    }
    y[m] += packed[AT(m, m)] * x[m];
  }
}

// Solves L D L^T z = z.
static inline void solve_packed(global const float16* packed, float16* z) {
#pragma unroll
  for (int m = 1; m < 12; ++m)
#pragma unroll
    for (int n = 0; n < m; ++n) z[m] -= packed[AT(m, n)] * z[n];
#pragma unroll
  for (int m = 0; m < 12; ++m) z[m] *= packed[AT(m, m)];
#pragma unroll
  for (int m = 11; m > 0; --m)
#pragma unroll
    for (int n = 0; n < m; ++n) z[n] -= packed[AT(m, n)] * z[m];
}
