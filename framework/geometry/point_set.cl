// Kernels over lists of points. (0, 0, 0) stands for no point.

float3 turned(float3 v, float4 row_x, float4 row_y, float4 row_z) {
  return (float3)(dot(row_x.xyz, v), dot(row_y.xyz, v), dot(row_z.xyz, v));
}

// The points and normals at some indices, moved rigidly: rotation in x y z, translation in w of the rows.
kernel void pick(int count, global const int* indices, global const float* points,
                 global const float* normals, float4 row_x, float4 row_y, float4 row_z,
                 global float* picked_points, global float* picked_normals) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const float3 p = vload3(indices[i], points);
  const float3 n = vload3(indices[i], normals);
  vstore3(turned(p, row_x, row_y, row_z) + (float3)(row_x.w, row_y.w, row_z.w), i, picked_points);
  vstore3(turned(n, row_x, row_y, row_z), i, picked_normals);
}

// The other way round: points and normals go to some indices of others.
kernel void place(int count, global const int* indices, global const float* points,
                  global const float* normals, global float* placed_points, global float* placed_normals) {
  const int i = get_global_id(0);
  if (i >= count) return;
  vstore3(vload3(i, points), indices[i], placed_points);
  vstore3(vload3(i, normals), indices[i], placed_normals);
}

// All of them, moved rigidly; where there is none, there is none.
kernel void move(int count, global const float* points, global const float* normals, float4 row_x,
                 float4 row_y, float4 row_z, global float* moved_points, global float* moved_normals) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const float3 p = vload3(i, points);
  const float3 n = vload3(i, normals);
  const float3 moved = turned(p, row_x, row_y, row_z) + (float3)(row_x.w, row_y.w, row_z.w);
  vstore3(any(p != 0.0f) ? moved : p, i, moved_points);
  vstore3(turned(n, row_x, row_y, row_z), i, moved_normals);
}

// Which of them are points.
kernel void find(int count, global const float* points, global uchar* found) {
  const int i = get_global_id(0);
  if (i < count) found[i] = any(vload3(i, points) != 0.0f);
}
