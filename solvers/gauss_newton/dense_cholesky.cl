// Blocked right-looking Cholesky of the lower triangle of A (row-major, n x n, n a multiple of BLOCK).
// Per block column k: `diagonal` factors A_kk and inverts the factor, `panel` makes L_ik = A_ik L_kk^-T a
// product with that inverse, `update` takes L_ik L_jk^T from what is left. status: [0] skip, [1] bad pivot.

#define BLOCK 64
#define TILE 32

// Places the STRIDE x STRIDE blocks; the diagonal is raised by lambda (status[3]). An unknown that nothing
// touches has a row of zeros: a 1 on its diagonal keeps it where it is.
kernel void scatter(global const int* status, int block_count, int n, global const int* rows,
                    global const int* columns, global const float* blocks, global float* A) {
  const int pair = get_global_id(0);
  if (status[0] || pair >= block_count) return;
  const float damping = as_float(status[3]);
  for (int a = 0; a < STRIDE; ++a)
    for (int b = 0; b < STRIDE; ++b) {
      const int row = STRIDE * rows[pair] + a, column = STRIDE * columns[pair] + b;
      const float value = blocks[STRIDE * STRIDE * pair + STRIDE * a + b];
      A[row * n + column] = row != column ? value : value == 0 ? 1 : value * (1 + damping);
    }
}

// Zeroes the matrix and makes the padding an identity.
kernel void clear_matrix(global int* status, int unknowns, int n, global float* A) {
  const int row = get_global_id(0);
  if (status[0] || row >= n) return;
  if (row == 0) status[1] = 0;
  for (int column = 0; column < n; column += 16) vstore16((float16)(0), 0, A + row * n + column);
  if (row >= unknowns) A[row * n + row] = 1;
}

kernel void negate(global const int* status, int unknowns, int n, global const float* gradient,
                   global float* x) {
  const int i = get_global_id(0);
  if (status[0] || i >= n) return;
  x[i] = i < unknowns ? -gradient[i] : 0;
}

// One work-item. U = L^T by rows, so that every inner loop runs along memory. `inverses` and their
// transposes: of all diagonal blocks, one after the other.
kernel void diagonal(global int* status, int k, int n, global float* A, global float* U,
                     global float* inverses, global float* inverses_transposed) {
  if (status[0] || status[1]) return;
  global float* inverse = inverses + k * BLOCK * BLOCK;
  global float* inverse_transposed = inverses_transposed + k * BLOCK * BLOCK;
  global float* block = A + k * BLOCK * n + k * BLOCK;
  for (int i = 0; i < BLOCK; ++i)
    for (int j = 0; j < BLOCK; ++j) U[i * BLOCK + j] = j >= i ? block[j * n + i] : 0;
  for (int j = 0; j < BLOCK; ++j) {
    const float pivot = U[j * BLOCK + j];
    if (!(pivot > 0) || isinf(pivot)) {
      status[1] = 1;
      return;
    }
    const float scale = rsqrt(pivot);
    float16 row[4];
    for (int part = 0; part < 4; ++part) {
      row[part] = scale * vload16(part, U + j * BLOCK);
      vstore16(row[part], part, U + j * BLOCK);
    }
    for (int i = j + 1; i < BLOCK; ++i) {
      const float factor = U[j * BLOCK + i];
      for (int part = i / 16; part < 4; ++part)
        vstore16(vload16(part, U + i * BLOCK) - factor * row[part], part, U + i * BLOCK);
    }
  }
  // Rows of L^-1 by forward substitution.
  for (int i = 0; i < BLOCK; ++i) {
    float16 row[4] = {0, 0, 0, 0};
    for (int j = 0; j < i; ++j) {
      const float factor = U[j * BLOCK + i];
      for (int part = 0; part <= j / 16; ++part) row[part] -= factor * vload16(part, inverse + j * BLOCK);
    }
    const float scale = 1 / U[i * BLOCK + i];
    for (int part = 0; part < 4; ++part) vstore16(scale * row[part], part, inverse + i * BLOCK);
    inverse[i * BLOCK + i] = scale;
  }
  for (int i = 0; i < BLOCK; ++i)
    for (int j = 0; j < BLOCK; ++j) {
      inverse_transposed[j * BLOCK + i] = inverse[i * BLOCK + j];
      if (j <= i) block[i * n + j] = U[j * BLOCK + i];
    }
}

// Four rows of L_ik per work-item; also kept transposed in tiles of TILE rows (each BLOCK x TILE), so that
// `update` runs along memory and its operands do not fall on each other in the cache.
kernel void panel(global const int* status, int k, int n, global float* A,
                  global const float* inverses_transposed, global float* tiles) {
  global const float* inverse_transposed = inverses_transposed + k * BLOCK * BLOCK;
  const int row = (k + 1) * BLOCK + 4 * get_global_id(0);
  if (status[0] || status[1] || row >= n) return;
  float16 sum[16];
  for (int entry = 0; entry < 16; ++entry) sum[entry] = 0;
  for (int t = 0; t < BLOCK; ++t) {
    const float16 c0 = vload16(0, inverse_transposed + t * BLOCK),
                  c1 = vload16(1, inverse_transposed + t * BLOCK);
    const float16 c2 = vload16(2, inverse_transposed + t * BLOCK),
                  c3 = vload16(3, inverse_transposed + t * BLOCK);
    for (int r = 0; r < 4; ++r) {
      const float value = A[(row + r) * n + k * BLOCK + t];
      sum[4 * r] += value * c0;
      sum[4 * r + 1] += value * c1;
      sum[4 * r + 2] += value * c2;
      sum[4 * r + 3] += value * c3;
    }
  }
  for (int r = 0; r < 4; ++r)
    for (int part = 0; part < 4; ++part) vstore16(sum[4 * r + part], part, A + (row + r) * n + k * BLOCK);
  global float* tile = tiles + row / TILE * BLOCK * TILE + row % TILE;
  for (int c = 0; c < BLOCK; ++c)
    vstore4((float4)(A[row * n + k * BLOCK + c], A[(row + 1) * n + k * BLOCK + c],
                     A[(row + 2) * n + k * BLOCK + c], A[(row + 3) * n + k * BLOCK + c]),
            0, tile + c * TILE);
}

// 8 rows of a tile of the remaining lower triangle per work-item: sixteen accumulators stay in registers.
kernel void update(global const int* status, int k, int n, int tile_columns, global float* A,
                   global const float* tiles) {
  const int first = (k + 1) * BLOCK;
  const int row = first + 8 * (get_global_id(0) / tile_columns);
  const int column = first + TILE * (get_global_id(0) % tile_columns);
  if (status[0] || status[1] || row >= n || column > row + 7) return;
  global const float* a = tiles + row / TILE * BLOCK * TILE + row % TILE;
  global const float* b = tiles + column * BLOCK;
  float16 left[8], right[8];
#pragma unroll
  for (int r = 0; r < 8; ++r) {
    left[r] = vload16(0, A + (row + r) * n + column);
    right[r] = vload16(1, A + (row + r) * n + column);
  }
  for (int t = 0; t < BLOCK; ++t) {
    const float16 b0 = vload16(0, b + TILE * t), b1 = vload16(1, b + TILE * t);
#pragma unroll
    for (int r = 0; r < 8; ++r) {
      const float value = a[TILE * t + r];
      left[r] -= value * b0;
      right[r] -= value * b1;
    }
  }
#pragma unroll
  for (int r = 0; r < 8; ++r) {
    vstore16(left[r], 0, A + (row + r) * n + column);
    vstore16(right[r], 1, A + (row + r) * n + column);
  }
}

float dot64(global const float* a, const float* b) {
  float16 sum = 0;
  for (int part = 0; part < 4; ++part) sum += vload16(part, a) * vload16(part, b);
  return sum16(sum);
}

// x_k = M x_k with M = L_kk^-1 (forward) or its transpose (backward). One work-item.
kernel void solve_diagonal(global const int* status, int k, global const float* blocks, global float* x) {
  if (status[0] || status[1]) return;
  global const float* M = blocks + k * BLOCK * BLOCK;
  float old[BLOCK];
  for (int i = 0; i < BLOCK; ++i) old[i] = x[k * BLOCK + i];
  for (int i = 0; i < BLOCK; ++i) x[k * BLOCK + i] = dot64(M + i * BLOCK, old);
}

// x_i -= L_ik x_k for the rows below block k.
kernel void eliminate_below(global const int* status, int k, int n, global const float* A, global float* x) {
  const int row = (k + 1) * BLOCK + get_global_id(0);
  if (status[0] || status[1] || row >= n) return;
  float known[BLOCK];
  for (int i = 0; i < BLOCK; ++i) known[i] = x[k * BLOCK + i];
  x[row] -= dot64(A + row * n + k * BLOCK, known);
}

// x_i -= L_ki^T x_k for the rows above block k, sixteen a work-item.
kernel void eliminate_above(global const int* status, int k, int n, global const float* A, global float* x) {
  const int first = 16 * get_global_id(0);
  if (status[0] || status[1] || first >= k * BLOCK) return;
  float16 sum = vload16(0, x + first);
  for (int t = 0; t < BLOCK; ++t) sum -= x[k * BLOCK + t] * vload16(0, A + (k * BLOCK + t) * n + first);
  vstore16(sum, 0, x + first);
}
