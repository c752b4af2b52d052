// How distances between two views change with the focal length that both were made with. Compiled behind
// projective_icp.cl and focal_length_equation.h.

#define FOCAL_SUMS 40  // SUMS, then by motion and focal length (6), by the focal length twice, and times r
#define FOCAL_USED 8

// A row of the first view a work-item. What stretches the view is taken at the moved point, not at its match:
// so that where the views are one, no noise of the points looks like a stretch.
kernel void add_focal_length(int2 size, global const float* first_points, global const float* first_normals,
                             float16 pose, float4 middle, float4 camera, int8 frame,
                             global const float* points, global const float* normals, float max_distance,
                             float noise, float least_cosine, global float* partials) {
  const int row = get_global_id(0);
  if (row >= size.y) return;
  const float R[9] = {pose.s0, pose.s1, pose.s2, pose.s3, pose.s4, pose.s5, pose.s6, pose.s7, pose.s8};
  const float from[3] = {middle.x, middle.y, middle.z};
  const float to[3] = {dot(pose.s012, middle.xyz) + pose.s9, dot(pose.s345, middle.xyz) + pose.sa,
                       dot(pose.s678, middle.xyz) + pose.sb};
  Lanes sums[SUMS_USED], focal[FOCAL_USED];
  clear_sums(sums);
  for (int k = 0; k < FOCAL_USED; ++k) focal[k] = 0;
  for (int first = 0; first < size.x; first += WIDTH) {
    const Pixels at = sampled_pixels(row, first, size.x, size.x, 1);
    const Vector p = gather(at, first_points), before = gather(at, first_normals);
    const Truth there = p.z > (Lanes)0;
    if (!ANY(there)) continue;
    const Vector own = turned(R, before), arm = turned(R, minus_point(p, from));
    const Vector moved = {arm.x + to[0], arm.y + to[1], arm.z + to[2]};
    const Pixels pixels = select(NONE, project(moved, camera, frame), there);
    const Vector q = gather(pixels, points), n = gather(pixels, normals);
    const Vector away = minus(moved, q), lever = minus_point(q, to);
    const Lanes farthest = fmax((Lanes)max_distance, noise * noise_at(q.z));
    const Truth matches = q.z > (Lanes)0 && inner(away, away) <= farthest * farthest &&
                          inner(own, own) > (Lanes)0 && inner(own, n) >= (Lanes)least_cosine;
    add_matches(matches, lever, away, own, sums);
    const Lanes arms[3] = {lever.x, lever.y, lever.z}, normal[3] = {own.x, own.y, own.z};
    const Lanes first_normal[3] = {before.x, before.y, before.z};
    const Lanes first_point[3] = {p.x, p.y, p.z}, point[3] = {moved.x, moved.y, moved.z};
    Lanes J[6];
    plane_distance_jacobian(arms, normal, J);
    const Lanes stretch =
        WHERE(matches, plane_distance_by_focal_length(first_point, first_normal, point, normal));
    for (int a = 0; a < 6; ++a) focal[a] += J[a] * stretch;
    focal[6] += stretch * stretch;
    focal[7] += stretch * WHERE(matches, inner(own, away));
  }
  global float* partial = partials + FOCAL_SUMS * row;
  store_sums(sums, partial);
  for (int k = 0; k < FOCAL_USED; ++k) partial[SUMS + k] = sum_of(focal[k]);
}
