// Evaluation of one energy on its stencil. The text is compiled once per energy, after its equation.h:
// NAME_RESIDUAL and NAME_JACOBIAN are the equation's functions, KERNEL(x) names the kernels after the
// energy, RESIDUALS is the length of its residual.
//
// evaluate_*: residual and Jacobian, scaled by the root of weight * confidence.
// energy_*: the sum of weight * rho(|r|^2) over CHUNK instances per work-item, in order: no atomics.

#ifndef PLIANT_EVALUATE_COMMON
#define PLIANT_EVALUATE_COMMON

#define CHUNK 64

// u of a constraint: the displacement p' - p [Eq. 4.1].
void displacement(float* u, int i, int per_point, global const float* points, global const int* nodes,
                  global const float* weights, global const float* node_points, global const float* affine) {
  const float3 p = vload3(i, points);
  float3 sum = 0;
  for (int slot = i * per_point; slot < (i + 1) * per_point; ++slot) {
    const int node = nodes[slot];
    const float3 lever_arm = p - vload3(node, node_points);
    sum +=
        weights[slot] * (lever_arm.x * vload3(4 * node, affine) + lever_arm.y * vload3(4 * node + 1, affine) +
                         lever_arm.z * vload3(4 * node + 2, affine) + vload3(4 * node + 3, affine));
  }
  u[0] = sum.x;
  u[1] = sum.y;
  u[2] = sum.z;
}

void load_node(float* u, int node, global const float* affine) {
  for (int entry = 0; entry < 12; ++entry) u[entry] = affine[12 * node + entry];
}

void load_edge(float* u, float* data, int from, int to, global const float* node_points,
               global const float* affine) {
  load_node(u, from, affine);
  load_node(u + 12, to, affine);
  for (int axis = 0; axis < 3; ++axis) data[axis] = node_points[3 * to + axis] - node_points[3 * from + axis];
}

float squared(const float* r, int rows) {
  float sum = 0;
  for (int row = 0; row < rows; ++row) sum += r[row] * r[row];
  return sum;
}
#endif

#if defined(PER_NODE)

// Adds J^T J (12x12) and J^T r (12) of each node to what stands there.
kernel void KERNEL(evaluate)(global const int* status, int count, float weight, float loss_scale,
                             global const float* affine, global const int* diagonal, global float* blocks,
                             global float* gradient) {
  const int i = get_global_id(0);
  if (status[0] || i >= count) return;
  float u[12], r[RESIDUALS], J[RESIDUALS * 12];
  load_node(u, i, affine);
  NAME_RESIDUAL(u, u, r);
  NAME_JACOBIAN(u, u, J);
  weight *= LOSS_WEIGHT(squared(r, RESIDUALS), loss_scale);
  global float* block = blocks + 144 * diagonal[i];
  for (int a = 0; a < 12; ++a) {
    float sum = 0;
    for (int row = 0; row < RESIDUALS; ++row) sum += J[12 * row + a] * r[row];
    gradient[12 * i + a] += weight * sum;
    for (int b = 0; b < 12; ++b) {
      float product = 0;
      for (int row = 0; row < RESIDUALS; ++row) product += J[12 * row + a] * J[12 * row + b];
      block[12 * a + b] += weight * product;
    }
  }
}

kernel void KERNEL(energy)(global const int* status, int count, float weight, float loss_scale,
                           global const float* affine, global float* partials, int first_partial) {
  const int first = get_global_id(0) * CHUNK;
  if (status[0] || first >= count) return;
  float sum = 0;
  for (int i = first; i < min(first + CHUNK, count); ++i) {
    float u[12], r[RESIDUALS];
    load_node(u, i, affine);
    NAME_RESIDUAL(u, u, r);
    sum += LOSS_VALUE(squared(r, RESIDUALS), loss_scale);
  }
  partials[first_partial + get_global_id(0)] = weight * sum;
}

#elif defined(PER_EDGE)

// Keeps per edge the Jacobian (RESIDUALS x 24) and, behind it, the residual (RESIDUALS).
kernel void KERNEL(evaluate)(global const int* status, int count, float weight, global const float* affine,
                             global const float* node_points, global const int* edges, global float* rows) {
  const int i = get_global_id(0);
  if (status[0] || i >= count) return;
  float u[24], data[3], r[RESIDUALS], J[RESIDUALS * 24];
  load_edge(u, data, edges[2 * i], edges[2 * i + 1], node_points, affine);
  NAME_RESIDUAL(u, data, r);
  NAME_JACOBIAN(u, data, J);
  const float scale = sqrt(weight);
  global float* row = rows + i * RESIDUALS * 25;
  for (int entry = 0; entry < RESIDUALS * 24; ++entry) row[entry] = scale * J[entry];
  for (int entry = 0; entry < RESIDUALS; ++entry) row[RESIDUALS * 24 + entry] = scale * r[entry];
}

kernel void KERNEL(energy)(global const int* status, int count, float weight, global const float* affine,
                           global const float* node_points, global const int* edges, global float* partials,
                           int first_partial) {
  const int first = get_global_id(0) * CHUNK;
  if (status[0] || first >= count) return;
  float sum = 0;
  for (int i = first; i < min(first + CHUNK, count); ++i) {
    float u[24], data[3], r[RESIDUALS];
    load_edge(u, data, edges[2 * i], edges[2 * i + 1], node_points, affine);
    NAME_RESIDUAL(u, data, r);
    sum += squared(r, RESIDUALS);
  }
  partials[first_partial + get_global_id(0)] = weight * sum;
}

#elif defined(PER_CONSTRAINT)

// Keeps per constraint what its energy is to the displaced point: W = J^T J (xx xy xz yy yz zz) and
// g = J^T r (3).
kernel void KERNEL(evaluate)(global const int* status, int count, float weight, float loss_scale,
                             global const float* affine, global const float* node_points,
                             global const float* points, int per_point, global const int* nodes,
                             global const float* weights, global const float* data,
                             global const float* confidence, global float* normal) {
  const int i = get_global_id(0);
  if (status[0] || i >= count) return;
  global float* out = normal + 9 * i;
  if (!(weight * confidence[i] > 0)) {  // inactive: what stands in data may be anything
    for (int entry = 0; entry < 9; ++entry) out[entry] = 0;
    return;
  }
  float u[3], given[6], r[RESIDUALS], J[RESIDUALS * 3];
  displacement(u, i, per_point, points, nodes, weights, node_points, affine);
  for (int entry = 0; entry < 6; ++entry) given[entry] = data[6 * i + entry];
  NAME_RESIDUAL(u, given, r);
  NAME_JACOBIAN(u, given, J);
  const float factor = weight * confidence[i] * LOSS_WEIGHT(squared(r, RESIDUALS), loss_scale);
  for (int a = 0; a < 3; ++a) {
    float sum = 0;
    for (int row = 0; row < RESIDUALS; ++row) sum += J[3 * row + a] * r[row];
    out[6 + a] = factor * sum;
  }
  int entry = 0;
  for (int a = 0; a < 3; ++a)
    for (int b = a; b < 3; ++b) {
      float sum = 0;
      for (int row = 0; row < RESIDUALS; ++row) sum += J[3 * row + a] * J[3 * row + b];
      out[entry++] = factor * sum;
    }
}

kernel void KERNEL(energy)(global const int* status, int count, float weight, float loss_scale,
                           global const float* affine, global const float* node_points,
                           global const float* points, int per_point, global const int* nodes,
                           global const float* weights, global const float* data,
                           global const float* confidence, global float* partials, int first_partial) {
  const int first = get_global_id(0) * CHUNK;
  if (status[0] || first >= count) return;
  float sum = 0;
  for (int i = first; i < min(first + CHUNK, count); ++i) {
    if (confidence[i] <= 0) continue;
    float u[3], given[6], r[RESIDUALS];
    displacement(u, i, per_point, points, nodes, weights, node_points, affine);
    for (int entry = 0; entry < 6; ++entry) given[entry] = data[6 * i + entry];
    NAME_RESIDUAL(u, given, r);
    sum += confidence[i] * LOSS_VALUE(squared(r, RESIDUALS), loss_scale);
  }
  partials[first_partial + get_global_id(0)] = weight * sum;
}

#endif
