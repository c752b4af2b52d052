// The K + 1 nearest nodes of each point by brute force over the compact list of nodes, WIDTH nodes at a
// time. `nodes` holds three rows (x, y, z) of `stride` values, padded with positions far away. HAS_NEXT: are
// there more than K nodes?

#if WIDTH == 16
typedef float16 Lanes;
#define LOAD(offset, base) vload16(0, (base) + (offset))
#define STORE(value, address) vstore16(value, 0, address)
#define ANY_BELOW(a, b) any((a) < (Lanes)(b))
#elif WIDTH == 1
typedef float Lanes;
#define LOAD(offset, base) ((base)[offset])
#define STORE(value, address) (*(address) = (value))
#define ANY_BELOW(a, b) ((a) < (b))
#else
#error "WIDTH must be 1 or 16"
#endif

// Keeps `distances` (squared) sorted; equal distances keep the lower node first.
void insert_nearest(float* distances, int* found, float distance, int node) {
  int place = K;
  while (place > 0 && distances[place - 1] > distance) {
    distances[place] = distances[place - 1];
    found[place] = found[place - 1];
    --place;
  }
  distances[place] = distance;
  found[place] = node;
}

kernel void influences(global const float* points, int point_count, global const float* nodes, int stride,
                       global int* influence_nodes, global float* influence_weights) {
  const int i = get_global_id(0);
  if (i >= point_count) return;
  const float x = points[3 * i], y = points[3 * i + 1], z = points[3 * i + 2];

  float distances[K + 1];
  int found[K + 1];
  for (int slot = 0; slot <= K; ++slot) {
    distances[slot] = INFINITY;
    found[slot] = 0;
  }
  for (int first = 0; first < stride; first += WIDTH) {
    const Lanes dx = LOAD(first, nodes) - x;
    const Lanes dy = LOAD(first, nodes + stride) - y;
    const Lanes dz = LOAD(first, nodes + 2 * stride) - z;
    const Lanes squared = dx * dx + dy * dy + dz * dz;
    if (ANY_BELOW(squared, distances[K])) {
      float lanes[WIDTH];
      STORE(squared, lanes);
      for (int lane = 0; lane < WIDTH; ++lane)
        if (lanes[lane] < distances[K]) insert_nearest(distances, found, lanes[lane], first + lane);
    }
  }

  const float farthest = HAS_NEXT ? sqrt(distances[K]) : 2 * sqrt(distances[K - 1]);
  float weights[K];
  float sum = 0;
  for (int slot = 0; slot < K; ++slot) {
    const float closeness = farthest > 0 ? 1 - sqrt(distances[slot]) / farthest : 0;
    weights[slot] = closeness * closeness;
    sum += weights[slot];
  }
  for (int slot = 0; slot < K; ++slot) {
    influence_nodes[i * K + slot] = found[slot];
    influence_weights[i * K + slot] = sum > 0 ? weights[slot] / sum : 1.0f / K;
  }
}
