// How far a model lies from a frame, with the frame's noise averaged out. `points` and `normals` of the
// model, `seen` and `seen_normals` of the frame: x y z per pixel of the window, row by row, (0, 0, 0) where
// there is none. NAN where nothing is known.
#define UNKNOWN NAN

bool faces_camera(float3 normal, float3 point, float least_facing) {
  return -dot(point, normal) >= least_facing * length(point);
}

// Depth of the frame along the ray of a point, less its own; unknown where that is more than `max_distance`,
// or the point looks away from the camera. The frame is the plane through its point at the nearest pixel:
// between pixels its slope would count as a distance.
kernel void difference(int count, global const float* points, global const float* normals, float4 camera,
                       int4 window, global const float* seen, global const float* seen_normals,
                       float max_distance, float least_facing, global float* differences) {
  const int i = get_global_id(0);
  if (i >= count) return;
  float told = UNKNOWN;
  const float3 p = vload3(i, points);
  if (p.z > 0.0f && faces_camera(vload3(i, normals), p, least_facing)) {
    const int u = convert_int_rte(camera.x * p.x / p.z + camera.z) - window.x;
    const int v = convert_int_rte(camera.y * p.y / p.z + camera.w) - window.y;
    if (u >= 0 && v >= 0 && u < window.z && v < window.w) {
      const float3 q = vload3(v * window.z + u, seen);
      const float3 n = vload3(v * window.z + u, seen_normals);
      const float depth = faces_camera(n, p, least_facing) ? p.z * dot(n, q) / dot(n, p) : q.z;
      if (q.z > 0.0f && fabs(depth - p.z) <= max_distance) told = depth - p.z;
    }
  }
  differences[i] = told;
}

// Sums over 2 radius + 1 pixels of a row, and how many of them are known.
kernel void sum_rows(int2 size, int radius, global const float* differences, global float2* sums) {
  const int i = get_global_id(0);
  if (i >= size.x * size.y) return;
  const int column = i % size.x;
  float2 sum = 0.0f;
  for (int c = max(column - radius, 0); c <= min(column + radius, size.x - 1); ++c) {
    const float d = differences[i + c - column];
    sum += isnan(d) ? (float2)(0.0f) : (float2)(d, 1.0f);
  }
  sums[i] = sum;
}

// Of each known difference the mean around it, without sign; -1 of others.
kernel void average(int2 size, int radius, global const float* differences, global const float2* sums,
                    global float* distances) {
  const int i = get_global_id(0);
  if (i >= size.x * size.y) return;
  const int row = i / size.x;
  float2 sum = 0.0f;
  for (int r = max(row - radius, 0); r <= min(row + radius, size.y - 1); ++r)
    sum += sums[i + (r - row) * size.x];
  distances[i] = isnan(differences[i]) ? -1.0f : fabs(sum.x / sum.y);
}
