// Warping [Eq. 4.1], WIDTH points a work-item; compiled behind lanes.cl. Positions are taken relative to the
// first node: then what the nodes do to a point is one affine form, blended by its weights, and no digits are
// lost far from the camera.

// Of each node the rows of [D | t - D (g - origin)] along x, y, z, four numbers each, then four zeros.
kernel void make_rows(int count, global const float* node_points, global const float* affine,
                      global float* rows) {
  const int node = get_global_id(0);
  if (node >= count) return;
  const float3 arm = vload3(node, node_points) - vload3(0, node_points);
  const float3 d1 = vload3(4 * node, affine), d2 = vload3(4 * node + 1, affine);
  const float3 d3 = vload3(4 * node + 2, affine);
  const float3 t = vload3(4 * node + 3, affine) - (arm.x * d1 + arm.y * d2 + arm.z * d3);
  vstore4((float4)(d1.x, d2.x, d3.x, t.x), 4 * node, rows);
  vstore4((float4)(d1.y, d2.y, d3.y, t.y), 4 * node + 1, rows);
  vstore4((float4)(d1.z, d2.z, d3.z, t.z), 4 * node + 2, rows);
  vstore4((float4)(0), 4 * node + 3, rows);
}

// The rows of each point's own form: number 4 axis + column. Points from `last` on are not there.
void blend(int first, int last, int per_point, global const int* nodes, global const float* weights,
           global const float* rows, Lanes* form) {
#if WIDTH == 16
  for (int lane = 0; lane < WIDTH; ++lane) {
    const int begin = min(first + lane, last - 1) * per_point;
    float16 sum = 0;
    for (int entry = begin; entry < begin + per_point; ++entry)
      sum += weights[entry] * vload16(nodes[entry], rows);
    form[lane] = sum;
  }
  transpose(form);
#else
  for (int number = 0; number < 12; ++number) form[number] = 0;
  for (int entry = first * per_point; entry < (first + 1) * per_point; ++entry)
    for (int number = 0; number < 12; ++number)
      form[number] += weights[entry] * rows[16 * nodes[entry] + number];
#endif
}

// `m`: the points' own form, relative to `origin`.
Vector moved_by(const Lanes* m, Vector p, float3 origin) {
  const Lanes x = p.x - origin.x, y = p.y - origin.y, z = p.z - origin.z;
  const Vector moved = {p.x + (m[0] * x + m[1] * y + m[2] * z + m[3]),
                        p.y + (m[4] * x + m[5] * y + m[6] * z + m[7]),
                        p.z + (m[8] * x + m[9] * y + m[10] * z + m[11])};
  return moved;
}

kernel void warp_points(global const float* points, int point_count, global const int* nodes,
                        global const float* weights, int per_point, global const float* node_points,
                        global const float* rows, global float* moved_points) {
  const int first = get_global_id(0) * WIDTH;
  if (first >= point_count) return;
  const int count = point_count - first;
  Lanes m[16];
  blend(first, point_count, per_point, nodes, weights, rows, m);
  const Vector p = load_vectors(points + 3 * first, count);
  store_vectors(moved_by(m, p, vload3(0, node_points)), count, moved_points + 3 * first);
}

// With the normals.
kernel void warp(global const float* points, global const float* normals, int point_count,
                 global const int* nodes, global const float* weights, int per_point,
                 global const float* node_points, global const float* rows, global float* moved_points,
                 global float* moved_normals) {
  const int first = get_global_id(0) * WIDTH;
  if (first >= point_count) return;
  const int count = point_count - first;
  Lanes m[16];
  blend(first, point_count, per_point, nodes, weights, rows, m);

  const Vector p = load_vectors(points + 3 * first, count);
  store_vectors(moved_by(m, p, vload3(0, node_points)), count, moved_points + 3 * first);

  // The rows of the matrix of cofactors.
  const Vector row_x = {1 + m[0], m[1], m[2]}, row_y = {m[4], 1 + m[5], m[6]},
               row_z = {m[8], m[9], 1 + m[10]};
  const Vector n = load_vectors(normals + 3 * first, count);
  const Vector turned = {inner(outer(row_y, row_z), n), inner(outer(row_z, row_x), n),
                         inner(outer(row_x, row_y), n)};
  const Lanes squared = inner(turned, turned);
  const Vector unit = scaled(turned, 1 / sqrt(squared));
  store_vectors(only(squared > (Lanes)0 && squared < (Lanes)INFINITY, unit), count,
                moved_normals + 3 * first);
}
