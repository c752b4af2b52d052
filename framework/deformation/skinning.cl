// The K + 1 nearest nodes of each point. Nodes come in groups of GROUP that lie together, so that a group
// whose box is further than what has been found is passed over. `nodes` holds three rows (x, y, z) of
// `stride` values and `boxes` six rows (lowest x, y, z, highest x, y, z) of `box_stride` values, both padded
// with positions far away. HAS_NEXT: are there more than K nodes?

#if WIDTH == 16
typedef float16 Lanes;
#define LOAD(offset, base) vload16(0, (base) + (offset))
#define STORE(value, address) vstore16(value, 0, address)
#define ANY_UP_TO(a, b) any((a) <= (Lanes)(b))
#elif WIDTH == 1
typedef float Lanes;
#define LOAD(offset, base) ((base)[offset])
#define STORE(value, address) (*(address) = (value))
#define ANY_UP_TO(a, b) ((a) <= (b))
#else
#error "WIDTH must be 1 or 16"
#endif

typedef struct {
  float distances[K + 1];  // squared, sorted; of equal distances the lower node first
  int nodes[K + 1];
} Nearest;

int is_nearer(float distance, int node, const Nearest* found, int place) {
  return distance < found->distances[place] ||
         (distance == found->distances[place] && node < found->nodes[place]);
}

void insert_nearest(Nearest* found, float distance, int node) {
  if (!is_nearer(distance, node, found, K)) return;
  int place = K;
  while (place > 0 && is_nearer(distance, node, found, place - 1)) {
    found->distances[place] = found->distances[place - 1];
    found->nodes[place] = found->nodes[place - 1];
    --place;
  }
  found->distances[place] = distance;
  found->nodes[place] = node;
}

void search_group(int group, float3 p, global const float* nodes, int stride, global const int* ids,
                  Nearest* found) {
  for (int first = GROUP * group; first < GROUP * (group + 1); first += WIDTH) {
    const Lanes dx = LOAD(first, nodes) - p.x;
    const Lanes dy = LOAD(first, nodes + stride) - p.y;
    const Lanes dz = LOAD(first, nodes + 2 * stride) - p.z;
    const Lanes squared = dx * dx + dy * dy + dz * dz;
    if (!ANY_UP_TO(squared, found->distances[K])) continue;
    float lanes[WIDTH];
    STORE(squared, lanes);
    for (int lane = 0; lane < WIDTH; ++lane) insert_nearest(found, lanes[lane], ids[first + lane]);
  }
}

// No node of the groups from `first` on is nearer than this (squared); rounding keeps the order.
Lanes distances_to_boxes(int first, float3 p, global const float* boxes, int stride) {
  const Lanes x = fmax(fmax(LOAD(first, boxes) - p.x, p.x - LOAD(first, boxes + 3 * stride)), (Lanes)(0));
  const Lanes y =
      fmax(fmax(LOAD(first, boxes + stride) - p.y, p.y - LOAD(first, boxes + 4 * stride)), (Lanes)(0));
  const Lanes z =
      fmax(fmax(LOAD(first, boxes + 2 * stride) - p.z, p.z - LOAD(first, boxes + 5 * stride)), (Lanes)(0));
  return x * x + y * y + z * z;
}

int nearest_box(float3 p, global const float* boxes, int stride) {
  int best = 0;
  float best_distance = INFINITY;
  for (int first = 0; first < stride; first += WIDTH) {
    float squared[WIDTH];
    STORE(distances_to_boxes(first, p, boxes, stride), squared);
    for (int lane = 0; lane < WIDTH; ++lane) {
      if (!(squared[lane] < best_distance)) continue;
      best = first + lane;
      best_distance = squared[lane];
    }
  }
  return best;
}

kernel void influences(global const float* points, int point_count, global const float* nodes, int stride,
                       global const int* ids, global const float* boxes, int box_stride,
                       global int* influence_nodes, global float* influence_weights) {
  const int i = get_global_id(0);
  if (i >= point_count) return;
  const float3 p = vload3(i, points);

  Nearest found;
  for (int slot = 0; slot <= K; ++slot) {
    found.distances[slot] = INFINITY;
    found.nodes[slot] = 0;  // stays only where the point is not a number
  }
  const int nearest = nearest_box(p, boxes, box_stride);
  search_group(nearest, p, nodes, stride, ids, &found);
  for (int first = 0; first < box_stride; first += WIDTH) {
    float squared[WIDTH];
    STORE(distances_to_boxes(first, p, boxes, box_stride), squared);
    for (int lane = 0; lane < WIDTH; ++lane)
      if (squared[lane] <= found.distances[K] && first + lane != nearest && GROUP * (first + lane) < stride)
        search_group(first + lane, p, nodes, stride, ids, &found);
  }

  const float farthest = HAS_NEXT ? sqrt(found.distances[K]) : 2 * sqrt(found.distances[K - 1]);
  float weights[K];
  float sum = 0;
  for (int slot = 0; slot < K; ++slot) {
    const float closeness = farthest > 0 ? 1 - sqrt(found.distances[slot]) / farthest : 0;
    weights[slot] = closeness * closeness;
    sum += weights[slot];
  }
  for (int slot = 0; slot < K; ++slot) {
    influence_nodes[i * K + slot] = found.nodes[slot];
    influence_weights[i * K + slot] = sum > 0 ? weights[slot] / sum : 1.0f / K;
  }
}
