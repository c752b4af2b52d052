// How a grid of voxels is displaced: known at every CELL-th voxel along x, y and z, linear between. Compiled
// behind tsdf_grid.cl. `displacements`, in voxels: those along x of all points of the lattice, x of the
// points fastest, then those along y, then along z. `reaches`: of each brick the least displacement of any of
// its voxels along x, y, z, and a zero; then the greatest ones likewise.
#pragma OPENCL FP_CONTRACT OFF

int3 lattice_size(int4 bricks) { return bricks.xyz * (int3)(BRICK_X, BRICK_Y, BRICK_Z) / CELL + 1; }

#if WIDTH == 16
#if CELL != 4
#error "a vector of voxels begins with a point of the lattice and has four cells"
#endif
typedef float4 Row;  // values at the points before the voxels
#define LOAD_ROW(address) vload4(0, address)
#define AT_VOXELS(row) (row).s0000111122223333
#else
typedef float Row;
#define LOAD_ROW(address) (*(address))
#define AT_VOXELS(row) (row)
#endif

// The values between four rows of points that begin at `at`.
Row row_between(global const float* at, int row, int layer, float y, float z) {
  const Row r00 = LOAD_ROW(at), r10 = LOAD_ROW(at + row);
  const Row r01 = LOAD_ROW(at + layer), r11 = LOAD_ROW(at + layer + row);
  const Row r0 = fma((Row)y, r10 - r00, r00), r1 = fma((Row)y, r11 - r01, r01);
  return fma((Row)z, r1 - r0, r0);
}

Lanes between_points(global const float* at, int row, int layer, float y, float z, Lanes x) {
  const Lanes before = AT_VOXELS(row_between(at, row, layer, y, z));
  const Lanes behind = AT_VOXELS(row_between(at + 1, row, layer, y, z));
  return fma(x, behind - before, before);
}

// Where WIDTH voxels from `voxel` on are, that are at `p` at rest.
Vector displaced(Vector p, int3 voxel, int4 bricks, global const float* displacements) {
  const int3 size = lattice_size(bricks), corner = voxel / CELL;
  const float3 share = convert_float3(voxel - corner * CELL) / CELL;
  const Lanes x = p.x / CELL - floor(p.x / CELL);
  const int row = size.x, layer = size.x * size.y, points = layer * size.z;
  global const float* at = displacements + corner.x + row * corner.y + layer * corner.z;
  const Vector moved = {p.x + between_points(at, row, layer, share.y, share.z, x),
                        p.y + between_points(at + points, row, layer, share.y, share.z, x),
                        p.z + between_points(at + 2 * points, row, layer, share.y, share.z, x)};
  return moved;
}

// The box around a brick that is displaced.
Box widened(Box box, float8 reach, float16 m) {
  const float3 middle = 0.5f * (reach.lo.xyz + reach.hi.xyz),
               half_size = 0.5f * (reach.hi.xyz - reach.lo.xyz);
  box.centre += (float3)(dot(m.s012, middle), dot(m.s456, middle), dot(m.s89a, middle));
  box.reach +=
      (float3)(dot(fabs(m.s012), half_size), dot(fabs(m.s456), half_size), dot(fabs(m.s89a), half_size));
  return box;
}

// The points are listed block by block, because those that lie together are quickly found the nodes of; some
// of the last blocks lie beyond the lattice.
#define BLOCK ((int3)(4, 2, 2))

int3 listed_point(int i, int3 size) {
  const int3 blocks = (size + BLOCK - 1) / BLOCK;
  const int block = i / 16, row = block / blocks.x;
  return (int3)(block - row * blocks.x, row % blocks.y, row / blocks.y) * BLOCK +
         (int3)(i % 4, i / 4 % 2, i / 8 % 2);
}

// Where the listed points lie at rest, x y z each, mm. `m`: from voxels to the model's frame.
kernel void place_points(int count, int4 bricks, float16 m, global float* points) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const float3 p = convert_float3(listed_point(i, lattice_size(bricks)) * CELL);
  vstore3((float3)(dot(m.s012, p) + m.s3, dot(m.s456, p) + m.s7, dot(m.s89a, p) + m.sb), i, points);
}

// What the listed points have moved by. `rest`, `moved`: x y z each, mm.
kernel void displace(int count, int4 bricks, float voxel, global const float* rest, global const float* moved,
                     global float* displacements) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const int3 size = lattice_size(bricks), point = listed_point(i, size);
  if (any(point >= size)) return;
  const int at = point.x + size.x * (point.y + size.y * point.z), points = size.x * size.y * size.z;
  const float3 by = (vload3(i, moved) - vload3(i, rest)) / voxel;
  displacements[at] = by.x;
  displacements[at + points] = by.y;
  displacements[at + 2 * points] = by.z;
}

kernel void bound_displacements(int4 bricks, global const float* displacements, global float* reaches) {
  const int index = get_global_id(0);
  if (index >= bricks.x * bricks.y * bricks.z) return;
  const int3 size = lattice_size(bricks);
  const int3 cells = (int3)(BRICK_X, BRICK_Y, BRICK_Z) / CELL, corner = brick_at(index, bricks) * cells;
  const int points = size.x * size.y * size.z;
  float3 least = INFINITY, greatest = -INFINITY;
  for (int k = corner.z; k <= corner.z + cells.z; ++k) {
    for (int j = corner.y; j <= corner.y + cells.y; ++j) {
      for (int i = corner.x; i <= corner.x + cells.x; ++i) {
        const int at = i + size.x * (j + size.y * k);
        const float3 by = {displacements[at], displacements[at + points], displacements[at + 2 * points]};
        least = fmin(least, by);
        greatest = fmax(greatest, by);
      }
    }
  }
  vstore8((float8)(least, 0.0f, greatest, 0.0f), index, reaches);
}
