// The quadtree of [thesis 4.3] as flat arrays over its cells: the four of level 1, the sixteen of level 2,
// ..., within a level in Morton order, so that the parent of cell c is c / 4 one level up.
//
// centre: the point at the centre of a cell, or one of these; constant.
#define VIRTUAL (-1)  // the cell has points, but none there
#define EMPTY (-2)    // the cell has no point at all
#define GAP_RADIUS 3  // gap_radius of pixel_index.h
// state: the tree itself. A parent has been divided, its children are leaves or parents.
#define ABSENT 0
#define LEAF 1
#define PARENT 2

int cell_count(int level) { return 1 << (2 * level); }

int first_cell(int level) { return (cell_count(level) - 4) / 3; }

int every_second_bit(int code) {
  int bits = code & 0x55555555;
  bits = (bits | (bits >> 1)) & 0x33333333;
  bits = (bits | (bits >> 2)) & 0x0f0f0f0f;
  bits = (bits | (bits >> 4)) & 0x00ff00ff;
  return (bits | (bits >> 8)) & 0x0000ffff;
}

// The pixels of a cell from .xy to before .zw; `root`: the root's corner (.xy) and side (.z) in the pixel
// map.
int4 cell_box(int level, int cell, int4 root) {
  const int2 place = (int2)(every_second_bit(cell), every_second_bit(cell >> 1));
  return (int4)(root.xy + ((root.z * place) >> level), root.xy + ((root.z * (place + 1)) >> level));
}

// Sums of a cell of the deepest level: its residuals that are known, and how many those are.
kernel void sum_points(int level, int4 root, int2 size, global const int* points,
                       global const float* residuals, global float2* totals) {
  const int cell = get_global_id(0);
  if (cell >= cell_count(level)) return;
  const int4 box = cell_box(level, cell, root);
  float2 sum = 0;
  for (int v = max(box.y, 0); v < min(box.w, size.y); ++v)
    for (int u = max(box.x, 0); u < min(box.z, size.x); ++u) {
      const int point = points[v * size.x + u];
      if (point >= 0 && residuals[point] >= 0) sum += (float2)(residuals[point], 1);
    }
  totals[first_cell(level) + cell] = sum;
}

kernel void sum_children(int level, global float2* totals) {
  const int cell = get_global_id(0);
  if (cell >= cell_count(level)) return;
  global const float2* children = totals + first_cell(level + 1) + 4 * cell;
  totals[first_cell(level) + cell] = children[0] + children[1] + children[2] + children[3];
}

int seen_at(int2 pixel, int2 size, global const int* points) {
  return all(pixel >= 0) && all(pixel < size) ? points[pixel.y * size.x + pixel.x] : -1;
}

// point_at of pixel_index.h.
int point_at(int2 pixel, int4 box, int2 size, global const int* points) {
  const int there = seen_at(pixel, size, points);
  if (there >= 0) return there;
  int nearest = -1, least = 2 * GAP_RADIUS * GAP_RADIUS + 1, quadrants = 0;
  for (int dv = -GAP_RADIUS; dv <= GAP_RADIUS; ++dv)
    for (int du = -GAP_RADIUS; du <= GAP_RADIUS; ++du) {
      const int2 other = pixel + (int2)(du, dv);
      const int point = seen_at(other, size, points);
      if (point < 0) continue;
      const int columns = (du <= 0 ? 1 : 0) | (du >= 0 ? 2 : 0);
      quadrants |= (dv <= 0 ? columns : 0) | (dv >= 0 ? columns << 2 : 0);
      const int distance = du * du + dv * dv;
      if (!(all(other >= box.xy) && all(other < box.zw)) || distance >= least) continue;
      nearest = point;
      least = distance;
    }
  return quadrants == 15 ? nearest : -1;
}

// What there is at the centre of each cell of a level; `totals` counts every point. Level 1 becomes leaves.
kernel void find_centres(int level, int4 root, int2 size, global const int* points,
                         global const float2* totals, global int* centre, global int* state) {
  const int cell = get_global_id(0);
  if (cell >= cell_count(level)) return;
  const int4 box = cell_box(level, cell, root);
  const int2 pixel = box.xy + (box.zw - box.xy) / 2;
  const int at = first_cell(level) + cell;
  int found = EMPTY;
  if (totals[at].y > 0) {
    const int point = point_at(pixel, box, size, points);
    found = point >= 0 ? point : VIRTUAL;
  }
  centre[at] = found;
  state[at] = level == 1 && found != EMPTY ? LEAF : ABSENT;
}

// Whether a cell enters the tree as a leaf; a virtual one only where the tree may have such.
int may_be_leaf(int centre, int may_be_virtual) {
  return centre >= 0 || (centre == VIRTUAL && may_be_virtual);
}

// [Alg. 2] for one level: divides the leaves whose mean residual lies above the threshold, but for those
// whose node, or whose only cell, would be gone without another.
kernel void refine(int level, float threshold, int children_may_be_virtual, global const float2* totals,
                   global const int* centre, global int* state) {
  const int cell = get_global_id(0);
  if (cell >= cell_count(level)) return;
  const int at = first_cell(level) + cell;
  const int child = first_cell(level + 1) + 4 * cell;
  const float2 total = totals[at];
  if (state[at] != LEAF || !(total.x > threshold * total.y)) return;
  const int needs_nodes = centre[at] >= 0;
  int has_heirs = 0;
  for (int i = child; i < child + 4; ++i)
    has_heirs = has_heirs || may_be_leaf(centre[i], children_may_be_virtual && !needs_nodes);
  if (!has_heirs) return;
  state[at] = PARENT;
  for (int i = child; i < child + 4; ++i)
    state[i] = may_be_leaf(centre[i], children_may_be_virtual) ? LEAF : ABSENT;
}

// [Alg. 3] for one level: takes the children back whose parent's mean residual lies below the threshold. A
// virtual parent takes no nodes back: it has none to give in their place.
kernel void collapse(int level, float threshold, global const float2* totals, global const int* centre,
                     global int* state) {
  const int cell = get_global_id(0);
  if (cell >= cell_count(level)) return;
  const int at = first_cell(level) + cell;
  const int child = first_cell(level + 1) + 4 * cell;
  const float2 total = totals[at];
  if (state[at] != PARENT || !(total.x < threshold * total.y)) return;
  for (int i = child; i < child + 4; ++i)
    if (state[i] == PARENT || (state[i] == LEAF && centre[at] < 0 && centre[i] >= 0)) return;
  state[at] = LEAF;
  for (int i = child; i < child + 4; ++i) state[i] = ABSENT;
}
