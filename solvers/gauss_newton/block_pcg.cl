// Conjugate gradients over the blocks of J^T J, 4 GROUPS numbers wide, preconditioned by the inverses of the
// diagonal ones.
//
// A row of blocks holds both triangles. A block is GROUPS x GROUPS float16, number GROUPS g + h for its rows
// 4 g .. 4 g + 3 and columns 4 h .. 4 h + 3, entry 4 d + c = block[4 g + c][4 h + d]: with four numbers x of
// a vector spread as xxxxyyyyzzzzwwww the lanes hold products, to be added up over d once per row.

#define SPREAD(row) (row).xxxxyyyyzzzzwwww
#define TILES (GROUPS * GROUPS)
#define SIDE (4 * GROUPS)

float4 fold(float16 v) { return (v.lo.lo + v.lo.hi) + (v.hi.lo + v.hi.hi); }

// From the lower triangle to rows. sources: 2 * (block of the lower triangle) + whether to transpose it.
kernel void expand(global const int* status, int count, global const int* sources, global const float* lower,
                   global float16* rows) {
  const int i = get_global_id(0);
  if (status[0] || i >= count) return;
  global const float4* block = (global const float4*)(lower + 16 * TILES * (sources[i] / 2));
  global float16* out = rows + TILES * i;
  for (int g = 0; g < GROUPS; ++g)
    for (int h = 0; h < GROUPS; ++h) {
      if (sources[i] % 2) {
        out[GROUPS * g + h] = (float16)(block[GROUPS * (4 * h) + g], block[GROUPS * (4 * h + 1) + g],
                                        block[GROUPS * (4 * h + 2) + g], block[GROUPS * (4 * h + 3) + g]);
      } else {
        const float16 m = (float16)(block[GROUPS * (4 * g) + h], block[GROUPS * (4 * g + 1) + h],
                                    block[GROUPS * (4 * g + 2) + h], block[GROUPS * (4 * g + 3) + h]);
        out[GROUPS * g + h] = m.s048c159d26ae37bf;
      }
    }
}

// Raises the diagonal of each diagonal block, the first of its row, by lambda (status[3]) and inverts the
// block (Gauss-Jordan; rows are lanes). What nothing determines gets zeros: there the preconditioner does not
// move.
kernel void invert_diagonals(global const int* status, int node_count, global const int* starts,
                             global float16* rows, global float16* inverses) {
  const int node = get_global_id(0);
  if (status[0] || node >= node_count) return;
  const float damping = as_float(status[3]);
  global float16* block = rows + TILES * starts[node];
  const float16 raise = (float16)(damping, 0, 0, 0, 0, damping, 0, 0, 0, 0, damping, 0, 0, 0, 0, damping);
  for (int g = 0; g < GROUPS; ++g) block[(GROUPS + 1) * g] += raise * block[(GROUPS + 1) * g];

  float a[SIDE][16];
  float least[SIDE];
  for (int g = 0; g < GROUPS; ++g)
    for (int h = 0; h < GROUPS; ++h) {
      const float16 m = block[GROUPS * g + h];
      vstore4(m.lo.lo, g, a[4 * h]);  // symmetric: columns are rows
      vstore4(m.lo.hi, g, a[4 * h + 1]);
      vstore4(m.hi.lo, g, a[4 * h + 2]);
      vstore4(m.hi.hi, g, a[4 * h + 3]);
    }
  for (int m = 0; m < SIDE; ++m) {
    for (int g = GROUPS; g < 4; ++g) vstore4((float4)(0), g, a[m]);
    least[m] = fmax(1e-5f * a[m][m], 1e-30f);
  }
  for (int pivot = 0; pivot < SIDE; ++pivot) {
    const float d = a[pivot][pivot];
    const float inverse = d > least[pivot] ? 1 / d : 0;
    a[pivot][pivot] = 1;
    const float16 row = inverse * vload16(0, a[pivot]);
    for (int m = 0; m < SIDE; ++m) {
      if (m == pivot) continue;
      const float factor = a[m][pivot];
      a[m][pivot] = 0;
      vstore16(vload16(0, a[m]) - factor * row, 0, a[m]);
    }
    vstore16(row, 0, a[pivot]);
    if (inverse == 0)
      for (int m = 0; m < SIDE; ++m) a[m][pivot] = 0;
  }
  for (int g = 0; g < GROUPS; ++g)
    for (int h = 0; h < GROUPS; ++h)
      inverses[TILES * node + GROUPS * g + h] = (float16)(vload4(g, a[4 * h]), vload4(g, a[4 * h + 1]),
                                                          vload4(g, a[4 * h + 2]), vload4(g, a[4 * h + 3]));
}

// y += block * x, the sums over d still open.
static inline void multiply(global const float16* block, global const float4* x, float16* y) {
#pragma unroll
  for (int g = 0; g < GROUPS; ++g) {
    float16 sum = block[GROUPS * g] * SPREAD(x[0]);
#pragma unroll
    for (int h = 1; h < GROUPS; ++h) sum += block[GROUPS * g + h] * SPREAD(x[h]);
    y[g] += sum;
  }
}

// vectors: residual, direction, product, each GROUPS float4 a node. One work-group; adds its iterations to
// status[9] and sets status[1] when there is no solution.
kernel __attribute__((reqd_work_group_size(GROUP_SIZE, 1, 1))) void solve(
    global int* status, int node_count, global const int* starts, global const int* columns,
    global const float16* rows, global const float16* inverses, global const float4* gradient,
    global float4* vectors, global float4* step) {
  local float scratch[GROUP_SIZE];
  if (status[0]) return;
  global float4* residual = vectors;
  global float4* direction = residual + GROUPS * node_count;
  global float4* product = direction + GROUPS * node_count;

  float4 part = 0;
  FOR_EACH(node, node_count) {
    float16 y[GROUPS] = {0};
    for (int g = GROUPS * node; g < GROUPS * node + GROUPS; ++g) residual[g] = -gradient[g];
    multiply(inverses + TILES * node, residual + GROUPS * node, y);
    for (int g = 0; g < GROUPS; ++g) {
      direction[GROUPS * node + g] = fold(y[g]);
      step[GROUPS * node + g] = 0;
      part += residual[GROUPS * node + g] * direction[GROUPS * node + g];
    }
  }
  float rz = group_sum(sum4(part), scratch);
  const float enough = RELATIVE * RELATIVE * rz;
  int iteration = 0, failed = !isfinite(rz);
  while (rz > enough && !failed && iteration < SIDE * node_count) {
    SYNC;
    part = 0;
    FOR_EACH(node, node_count) {
      float16 y[GROUPS] = {0};
      for (int block = starts[node]; block < starts[node + 1]; ++block)
        multiply(rows + TILES * block, direction + GROUPS * columns[block], y);
      for (int g = 0; g < GROUPS; ++g) {
        product[GROUPS * node + g] = fold(y[g]);
        part += product[GROUPS * node + g] * direction[GROUPS * node + g];
      }
    }
    const float curvature = group_sum(sum4(part), scratch);
    if (!(curvature > 0)) {
      failed = iteration == 0;
      break;
    }
    ++iteration;
    const float alpha = rz / curvature;
    part = 0;
    FOR_EACH(node, node_count) {
      float16 y[GROUPS] = {0};
      for (int g = GROUPS * node; g < GROUPS * node + GROUPS; ++g) {
        step[g] += alpha * direction[g];
        residual[g] -= alpha * product[g];
      }
      multiply(inverses + TILES * node, residual + GROUPS * node, y);
      for (int g = 0; g < GROUPS; ++g) {
        product[GROUPS * node + g] = fold(y[g]);
        part += product[GROUPS * node + g] * residual[GROUPS * node + g];
      }
    }
    const float next = group_sum(sum4(part), scratch);
    const float beta = next / rz;
    rz = next;
    FOR_EACH(node, node_count)
    for (int g = GROUPS * node; g < GROUPS * node + GROUPS; ++g)
      direction[g] = product[g] + beta * direction[g];
  }
  if (get_local_id(0) == 0) {
    status[1] = failed;
    status[9] += iteration;
  }
}
