// The K + 1 nearest nodes of each point, WIDTH points a work-item: points that follow one another lie
// together mostly, and so ask the same nodes. Nodes come in groups of GROUP that lie together, so that a
// group whose box is further from all of them than what has been found is passed over. `nodes` holds three
// rows (x, y, z) of `stride` values, padded with positions far away, and `boxes` six rows (lowest x, y, z,
// highest x, y, z) of `groups` values. HAS_NEXT: are there more than K nodes?

#if WIDTH == 16
typedef float16 Lanes;
typedef int16 LaneInts;
#define LOAD(address) vload16(0, address)
#define STORE(value, address) vstore16(value, 0, address)
#define ANY(mask) any(mask)
#define CHOOSE(mask, yes, no) select(no, yes, mask)
#elif WIDTH == 1
typedef float Lanes;
typedef int LaneInts;
#define LOAD(address) (*(address))
#define STORE(value, address) (*(address) = (value))
#define ANY(mask) (mask)
#define CHOOSE(mask, yes, no) ((mask) ? (yes) : (no))
#else
#error "WIDTH must be 1 or 16"
#endif

typedef struct {
  Lanes x, y, z;
} Points;

typedef struct {
  Lanes distances[K + 1];  // squared, sorted; of equal distances the lower node first
  LaneInts nodes[K + 1];
} Nearest;

// Points beyond the last one are the last one again.
Points load_points(int first, int count, global const float* points) {
  float x[WIDTH], y[WIDTH], z[WIDTH];
  for (int lane = 0; lane < WIDTH; ++lane) {
    const int i = min(first + lane, count - 1);
    x[lane] = points[3 * i];
    y[lane] = points[3 * i + 1];
    z[lane] = points[3 * i + 2];
  }
  const Points p = {LOAD(x), LOAD(y), LOAD(z)};
  return p;
}

void insert_nearest(Nearest* found, Lanes distance, int node) {
  LaneInts nodes = node;
  for (int place = 0; place <= K; ++place) {
    const Lanes old_distance = found->distances[place];
    const LaneInts old_nodes = found->nodes[place];
    const LaneInts is_nearer = (distance < old_distance) | ((distance == old_distance) & (nodes < old_nodes));
    found->distances[place] = CHOOSE(is_nearer, distance, old_distance);
    found->nodes[place] = CHOOSE(is_nearer, nodes, old_nodes);
    distance = CHOOSE(is_nearer, old_distance, distance);
    nodes = CHOOSE(is_nearer, old_nodes, nodes);
  }
}

void search_group(int group, const Points* p, global const float* nodes, int stride, global const int* ids,
                  Nearest* found) {
  for (int i = GROUP * group; i < GROUP * (group + 1); ++i) {
    const Lanes dx = nodes[i] - p->x;
    const Lanes dy = nodes[i + stride] - p->y;
    const Lanes dz = nodes[i + 2 * stride] - p->z;
    const Lanes squared = dx * dx + dy * dy + dz * dz;
    if (ANY(squared <= found->distances[K])) insert_nearest(found, squared, ids[i]);
  }
}

// No node of a group is nearer than this (squared); rounding keeps the order.
Lanes distance_to_box(int group, const Points* p, global const float* boxes, int groups) {
  global const float* low = boxes + group;
  global const float* high = low + 3 * groups;
  const Lanes x = fmax(fmax(low[0] - p->x, p->x - high[0]), (Lanes)(0));
  const Lanes y = fmax(fmax(low[groups] - p->y, p->y - high[groups]), (Lanes)(0));
  const Lanes z = fmax(fmax(low[2 * groups] - p->z, p->z - high[2 * groups]), (Lanes)(0));
  return x * x + y * y + z * z;
}

// Of the groups the one whose box lies nearest to a point.
int nearest_box(float3 p, global const float* boxes, int groups) {
  int best = 0;
  float best_distance = INFINITY;
  for (int group = 0; group < groups; ++group) {
    global const float* low = boxes + group;
    const float3 below = (float3)(low[0], low[groups], low[2 * groups]) - p;
    const float3 above = p - (float3)(low[3 * groups], low[4 * groups], low[5 * groups]);
    const float3 away = fmax(fmax(below, above), (float3)(0));
    const float squared = dot(away, away);
    if (!(squared < best_distance)) continue;
    best = group;
    best_distance = squared;
  }
  return best;
}

void store_influences(int first, int count, const LaneInts* nodes, const Lanes* weights,
                      global int* influence_nodes, global float* influence_weights) {
  for (int slot = 0; slot < K; ++slot) {
    int ids[WIDTH];
    float values[WIDTH];
    STORE(nodes[slot], ids);
    STORE(weights[slot], values);
    for (int lane = 0; lane < min(WIDTH, count - first); ++lane) {
      influence_nodes[(first + lane) * K + slot] = ids[lane];
      influence_weights[(first + lane) * K + slot] = values[lane];
    }
  }
}

kernel void influences(global const float* points, int point_count, global const float* nodes, int stride,
                       global const int* ids, global const float* boxes, int groups,
                       global int* influence_nodes, global float* influence_weights) {
  const int first = get_global_id(0) * WIDTH;
  if (first >= point_count) return;
  const Points p = load_points(first, point_count, points);

  Nearest found;
  for (int slot = 0; slot <= K; ++slot) {
    found.distances[slot] = INFINITY;
    found.nodes[slot] = 0;  // stays only where the point is not a number
  }
  const int nearest = nearest_box(vload3(min(first + WIDTH / 2, point_count - 1), points), boxes, groups);
  search_group(nearest, &p, nodes, stride, ids, &found);
  for (int group = 0; group < groups; ++group)
    if (group != nearest && ANY(distance_to_box(group, &p, boxes, groups) <= found.distances[K]))
      search_group(group, &p, nodes, stride, ids, &found);

  const Lanes farthest = HAS_NEXT ? sqrt(found.distances[K]) : 2 * sqrt(found.distances[K - 1]);
  Lanes weights[K];
  Lanes sum = 0;
  for (int slot = 0; slot < K; ++slot) {
    const Lanes closeness = CHOOSE(farthest > 0, 1 - sqrt(found.distances[slot]) / farthest, (Lanes)(0));
    weights[slot] = closeness * closeness;
    sum += weights[slot];
  }
  for (int slot = 0; slot < K; ++slot)
    weights[slot] = CHOOSE(sum > 0, weights[slot] / sum, (Lanes)(1.0f / K));
  store_influences(first, point_count, found.nodes, weights, influence_nodes, influence_weights);
}
