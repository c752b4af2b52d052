// Projective association [thesis 4.2]: the target point at the pixel that a source point projects to.

// Offset of that pixel, or -1 when it lies outside or has no point. camera: fx, fy, cx, cy.
int target_pixel(float3 p, float4 camera, int2 size, global const float* target_points) {
  if (!(p.z > 0)) return -1;
  const float u = round(camera.x * p.x / p.z + camera.z);
  const float v = round(camera.y * p.y / p.z + camera.w);
  if (!(u >= 0 && v >= 0 && u < size.x && v < size.y)) return -1;
  const int pixel = (int)v * size.x + (int)u;
  return target_points[3 * pixel + 2] > 0 ? pixel : -1;
}

// One constraint a work-item. A point or a pixel without a normal is judged by its distance alone.
kernel void match(int count, global const int* selected, global const float* rest, global const float* moved,
                  global const float* normals, float4 camera, int2 size, global const float* target_points,
                  global const float* target_normals, float max_distance, float least_cosine,
                  global float* data, global float* confidence) {
  const int i = get_global_id(0);
  if (i >= count) return;
  const float3 p = vload3(selected[i], moved);
  const int pixel = target_pixel(p, camera, size, target_points);
  float3 pull = 0, target_normal = 0;
  float trust = 0;
  if (pixel >= 0) {
    const float3 q = vload3(pixel, target_points);
    const float3 normal = vload3(selected[i], normals);
    target_normal = vload3(pixel, target_normals);
    const int has_normals = dot(normal, normal) > 0 && dot(target_normal, target_normal) > 0;
    const int near = distance(p, q) <= max_distance;
    const int alike = !has_normals || dot(normal, target_normal) >= least_cosine;
    trust = near && alike ? 1 : 0;
    pull = q - vload3(i, rest);
  }
  vstore3(pull, 2 * i, data);
  vstore3(target_normal, 2 * i + 1, data);
  confidence[i] = trust;
}

#define CHUNK 256

// Per work-item the residuals of CHUNK points, each (-1: it meets no target point), and in order their sum
// and how many there are.
kernel void residuals(int count, global const float* moved, float4 camera, int2 size,
                      global const float* target_points, global float* residual, global float2* partials) {
  const int first = get_global_id(0) * CHUNK;
  if (first >= count) return;
  float2 sum = 0;
  for (int i = first; i < min(first + CHUNK, count); ++i) {
    const float3 p = vload3(i, moved);
    const int pixel = target_pixel(p, camera, size, target_points);
    residual[i] = pixel >= 0 ? distance(p, vload3(pixel, target_points)) : -1;
    if (pixel >= 0) sum += (float2)(residual[i], 1);
  }
  partials[get_global_id(0)] = sum;
}

kernel void total_residual(int count, global const float2* partials, global float2* total) {
  float2 sum = 0;
  for (int i = 0; i < count; ++i) sum += partials[i];
  total[0] = sum;
}
