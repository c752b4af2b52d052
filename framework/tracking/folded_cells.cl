// Counts the cells between four neighbouring points of a deformed view that were turned inside out: their
// image goes around the other way though their normals still look at the camera. Compiled behind
// surface_map.cl. `points` and `normals`: x y z per pixel of the window, row by row, (0, 0, 0) where there is
// none. `camera`: fx, fy, cx, cy.

float2 image_of(float3 p, float4 camera) { return camera.xy * p.xy / p.z + camera.zw; }

float goes_around(float2 a, float2 b, float2 c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

kernel void count_folded(int2 size, float4 camera, global const float* points, global const float* normals,
                         global int* folded) {
  const int column = get_global_id(0) % size.x, row = get_global_id(0) / size.x;
  if (column + 1 >= size.x || row + 1 >= size.y) return;
  float2 corners[4];
  for (int i = 0; i < 4; ++i) {
    const int at = row * size.x + column + (i & 1) + (i >> 1) * size.x;
    const float3 p = vload3(at, points);
    if (!(p.z > 0.0f && dot(p, vload3(at, normals)) < 0.0f)) return;
    corners[i] = image_of(p, camera);
  }
  if (goes_around(corners[0], corners[1], corners[2]) < 0.0f ||
      goes_around(corners[3], corners[2], corners[1]) < 0.0f)
    atomic_inc(folded);
}
