// Kernels over lists of points.

// The points and normals at some indices, moved rigidly: rotation in x y z, translation in w of the rows.
kernel void pick(int count, global const int* indices, global const float* points,
                 global const float* normals, float4 row_x, float4 row_y, float4 row_z,
                 global float* picked_points, global float* picked_normals) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const float3 p = vload3(indices[i], points);
  const float3 n = vload3(indices[i], normals);
  const float3 turned = (float3)(dot(row_x.xyz, p), dot(row_y.xyz, p), dot(row_z.xyz, p));
  vstore3(turned + (float3)(row_x.w, row_y.w, row_z.w), i, picked_points);
  vstore3((float3)(dot(row_x.xyz, n), dot(row_y.xyz, n), dot(row_z.xyz, n)), i, picked_normals);
}
