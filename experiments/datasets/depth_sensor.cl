// A structured-light depth camera: see depth_sensor.h for the terms and depth_sensor.cpp for the reference.
// `camera`: fx, fy, cx, cy. Depth: mm, 0 where nothing is seen.

// The last steps of MurmurHash3 (A. Appleby).
uint mixed(uint bits) {
  bits = (bits ^ (bits >> 16)) * 0x85ebca6bu;
  bits = (bits ^ (bits >> 13)) * 0xc2b2ae35u;
  return bits ^ (bits >> 16);
}

// Two independent normal numbers for each pixel, number and key (Box and Muller 1958).
float2 normal_pair(int pixel, uint number, uint2 key) {
  const uint first = mixed(mixed((uint)pixel + key.x) + key.y + number * 0x9e3779b9u);
  const uint second = mixed(first + 0x9e3779b9u);
  const float radius = sqrt(-2 * log(((first >> 8) + 1) * 0x1p-24f));
  const float angle = 6.2831853f * ((second >> 8) * 0x1p-24f);
  return radius * (float2)(cos(angle), sin(angle));
}

typedef struct {
  global const float* depth;
  int2 size;
  float4 camera;
} View;

float depth_at(View view, int u, int v) {
  const bool is_inside = u >= 0 && v >= 0 && u < view.size.x && v < view.size.y;
  return is_inside ? view.depth[v * view.size.x + u] : 0.0f;
}

// Whether two neighbours show one surface, rather than a step from one to another or to nothing.
bool is_same_surface(float z, float other, float4 camera) {
  return z > 0 && other > 0 && fabs(other - z) <= STEEPEST * fmin(z, other) / camera.x;
}

float3 point_at(View view, int u, int v) {
  const float z = depth_at(view, u, v);
  return z * (float3)((u - view.camera.z) / view.camera.x, (v - view.camera.w) / view.camera.y, 1);
}

// From the neighbour before to the one after, as far as both show the surface of (u, v).
float3 tangent(View view, int u, int v, int du, int dv) {
  const float z = depth_at(view, u, v);
  const bool has_before = is_same_surface(z, depth_at(view, u - du, v - dv), view.camera);
  const bool has_after = is_same_surface(z, depth_at(view, u + du, v + dv), view.camera);
  const int before = has_before ? 1 : 0, after = has_after ? 1 : 0;
  return point_at(view, u + after * du, v + after * dv) - point_at(view, u - before * du, v - before * dv);
}

// Between the ray and the normal of the surface, radians; 0 where no neighbour shows it.
float incidence(View view, int u, int v) {
  const float3 normal = cross(tangent(view, u, v, 1, 0), tangent(view, u, v, 0, 1));
  const float3 point = point_at(view, u, v);
  const float lengths = length(normal) * length(point);
  return lengths > 0 ? acos(fmin(fabs(dot(normal, point)) / lengths, 1.0f)) : 0.0f;
}

bool is_at_step(View view, int u, int v) {
  const float z = depth_at(view, u, v);
  bool is_step = false;
  for (int dv = -1; dv <= 1; ++dv)
    for (int du = -1; du <= 1; ++du) {
      const bool is_inside = u + du >= 0 && v + dv >= 0 && u + du < view.size.x && v + dv < view.size.y;
      const float other = depth_at(view, u + du, v + dv);
      is_step |= is_inside && (z > 0 || other > 0) && !is_same_surface(z, other, view.camera);
    }
  return is_step;
}

// Which pixels the projector lights, a row a work-item. `seen`: 2 * width numbers a row, the disparities of
// what is nearest to the projector, by its column + width.
kernel void light(global const float* depth, int2 size, float4 camera, float baseline, global float* seen,
                  global uchar* lit) {
  const int v = get_global_id(0);
  if (v >= size.y) return;
  const View view = {depth, size, camera};
  global float* nearest = seen + 2 * size.x * v;
  for (int column = 0; column < 2 * size.x; ++column) nearest[column] = 0;
  for (int u = 0; u < size.x; ++u) {
    const float z = depth_at(view, u, v), next = depth_at(view, u + 1, v);
    if (!(z > 0)) continue;
    const bool goes_on = is_same_surface(z, next, camera);
    const float d = camera.x * baseline / z, next_d = goes_on ? camera.x * baseline / next : d;
    const float x = u - d, next_x = goes_on ? u + 1 - next_d : x;
    const int first = max((int)(goes_on ? ceil(fmin(x, next_x)) : rint(x)), -size.x);
    const int last = min((int)(goes_on ? floor(fmax(x, next_x)) : rint(x)), size.x - 1);
    for (int column = first; column <= last; ++column) {
      const float share = goes_on ? (column - x) / (next_x - x) : 0.0f;
      const float here = share >= 0 && share <= 1 ? d + share * (next_d - d) : d;
      nearest[column + size.x] = fmax(nearest[column + size.x], here);
    }
  }
  for (int u = 0; u < size.x; ++u) {
    const float z = depth_at(view, u, v), d = z > 0 ? camera.x * baseline / z : 0.0f;
    const int column = (int)floor(u - d);
    const bool is_inside = column >= -size.x && column + 1 < size.x;
    const float before = is_inside ? fmin(nearest[column + size.x], nearest[column + 1 + size.x]) : 0.0f;
    lit[v * size.x + u] = z > 0 && d >= before - SHADOW_MARGIN ? 1 : 0;
  }
}

// axial, step (pixels of disparity), lateral: 0 switches off; grazing: radians. focal_baseline: that of the
// disparities.
kernel void sense(global const float* depth, int2 size, float4 camera, float axial, float step, float lateral,
                  float grazing, float focal_baseline, int has_shadow, global const uchar* lit, uint2 key,
                  global float* sensed) {
  const int pixel = get_global_id(0);
  if (pixel >= size.x * size.y) return;
  const View view = {depth, size, camera};
  int u = pixel % size.x, v = pixel / size.x;
  if (lateral > 0 && is_at_step(view, u, v)) {
    const float angle = incidence(view, u, v);
    const float sigma = lateral * (0.8f + 0.035f * angle / (HALF_PI - fmin(angle, STEEPEST_ANGLE)));
    const float2 shift = sigma * normal_pair(pixel, 1, key);
    u = clamp(u + (int)rint(shift.x), 0, size.x - 1);
    v = clamp(v + (int)rint(shift.y), 0, size.y - 1);
  }
  float z = depth_at(view, u, v);
  if (z > 0 && (axial > 0 || grazing < HALF_PI)) {
    const float angle = incidence(view, u, v);
    if (angle > grazing) z = 0;
    if (z > 0 && axial > 0) {
      const float metres = z * 0.001f, beyond = metres - 0.4f;
      const float ratio = fmin(angle, STEEPEST_ANGLE) / (HALF_PI - fmin(angle, STEEPEST_ANGLE));
      const float sigma = 1.2f + 1.9f * beyond * beyond + 0.1f * rsqrt(metres) * ratio * ratio;
      z += axial * sigma * normal_pair(pixel, 0, key).x;
    }
  }
  if (has_shadow && !lit[v * size.x + u]) z = 0;
  if (z > 0 && step > 0) {
    const float steps = rint(focal_baseline / z / step);
    z = steps > 0 ? focal_baseline / (steps * step) : 0.0f;
  }
  sensed[pixel] = fmax(z, 0.0f);
}
