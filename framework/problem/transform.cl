// Nodes whose transform does not leave every affine form free. Compiled behind the transform's functions,
// RETRACT, PULL_BACK and NEAREST; a node has UNKNOWNS free numbers, kept in STRIDE places, a multiple of
// four, of which the last are zeros.

void load_form(float* form, int node, global const float* forms) {
  for (int entry = 0; entry < 12; ++entry) form[entry] = forms[12 * node + entry];
}

// T_i^T B T_j of each 12x12 block. Where a turn is free the terms of its diagonal entry cancel: what rounding
// leaves below zero is zero.
kernel void project_blocks(global const int* status, int count, global const int* rows,
                           global const int* columns, global const float* forms, global const float* blocks,
                           global float* projected) {
  const int block = get_global_id(0);
  if (status[0] || block >= count) return;
  float form[12], v[12], pulled[UNKNOWNS], half_way[12 * UNKNOWNS];
  load_form(form, columns[block], forms);
  for (int a = 0; a < 12; ++a) {
    for (int b = 0; b < 12; ++b) v[b] = blocks[144 * block + 12 * a + b];
    PULL_BACK(form, v, half_way + UNKNOWNS * a);
  }
  load_form(form, rows[block], forms);
  global float* out = projected + STRIDE * STRIDE * block;
  for (int entry = 0; entry < STRIDE * STRIDE; ++entry) out[entry] = 0;
  for (int b = 0; b < UNKNOWNS; ++b) {
    for (int a = 0; a < 12; ++a) v[a] = half_way[UNKNOWNS * a + b];
    PULL_BACK(form, v, pulled);
    for (int a = 0; a < UNKNOWNS; ++a) out[STRIDE * a + b] = pulled[a];
    if (rows[block] == columns[block] && pulled[b] < 0) out[(STRIDE + 1) * b] = 0;
  }
}

// T_i^T g of each node.
kernel void project_gradient(global const int* status, int count, global const float* forms,
                             global const float* gradient, global float* projected) {
  const int node = get_global_id(0);
  if (status[0] || node >= count) return;
  float form[12], v[12], pulled[UNKNOWNS];
  load_form(form, node, forms);
  load_form(v, node, gradient);
  PULL_BACK(form, v, pulled);
  for (int a = 0; a < STRIDE; ++a) projected[STRIDE * node + a] = a < UNKNOWNS ? pulled[a] : 0;
}

kernel void retract(global const int* status, int count, global const float* forms, global const float* step,
                    global float* moved) {
  const int node = get_global_id(0);
  if (status[0] || node >= count) return;
  float form[12], along[UNKNOWNS], result[12];
  load_form(form, node, forms);
  for (int a = 0; a < UNKNOWNS; ++a) along[a] = step[STRIDE * node + a];
  RETRACT(form, along, result);
  for (int entry = 0; entry < 12; ++entry) moved[12 * node + entry] = result[entry];
}

kernel void take_nearest(global const int* status, int count, global float* forms) {
  const int node = get_global_id(0);
  if (status[0] || node >= count) return;
  float form[12], result[12];
  load_form(form, node, forms);
  NEAREST(form, result);
  for (int entry = 0; entry < 12; ++entry) forms[12 * node + entry] = result[entry];
}
