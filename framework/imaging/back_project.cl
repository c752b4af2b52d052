// Points of a depth map, without normals; compiled behind depth_map.cl.

kernel void back_project(global const float* depth, int stride, int2 size, int2 corner, float4 camera,
                         global float* points) {
  const int vectors = (size.x + WIDTH - 1) / WIDTH;
  const int v = get_global_id(0) / vectors;
  const int u = (get_global_id(0) - v * vectors) * WIDTH;
  if (v >= size.y) return;
  const Lanes z = LOAD(depth + (v + HALO) * stride + u + HALO);
  store_vectors(only(HAS_DEPTH(z), scaled(ray_through(u, v, corner, camera), z)), size.x - u,
                points + 3 * (v * size.x + u));
}
