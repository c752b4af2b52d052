// One energy per node, for sixteen nodes at once: compiled after its equation.h over float16. TERM(x) names
// the functions after the term, RESIDUALS is the length of its residual, ROBUST whether its loss is none.

float16 TERM(squared)(const float16* r) {
  float16 sum = 0;
  for (int row = 0; row < RESIDUALS; ++row) sum += r[row] * r[row];
  return sum;
}

// Adds weight * J^T J to the packed lower triangle and weight * J^T r to the gradient, both in the order
// 4 axis + c.
void TERM(add)(const float16* u, float16 weight, float16 loss_scale, float16* packed, float16* gradient) {
  float16 r[RESIDUALS], J[12 * RESIDUALS];
  NAME_RESIDUAL(u, u, r);
  NAME_JACOBIAN(u, u, J);
  weight *= LOSS_WEIGHT(TERM(squared)(r), loss_scale);
  int entry = 0;
  for (int m = 0; m < 12; ++m) {
    const int at_m = COLUMNWISE(m);
    float16 sum = 0;
    for (int row = 0; row < RESIDUALS; ++row) sum += J[12 * row + at_m] * r[row];
    gradient[m] += weight * sum;
    for (int n = 0; n <= m; ++n, ++entry) {
      const int at_n = COLUMNWISE(n);
      float16 product = 0;
      for (int row = 0; row < RESIDUALS; ++row) product += J[12 * row + at_m] * J[12 * row + at_n];
      packed[entry] += weight * product;
    }
  }
}

// Energy at v less energy at u, without losing the digits of a small difference.
float16 TERM(change)(const float16* u, const float16* v, float16 weight, float16 loss_scale) {
  float16 before[RESIDUALS], after[RESIDUALS];
  NAME_RESIDUAL(u, u, before);
  NAME_RESIDUAL(v, v, after);
  float16 gain = 0;
  for (int row = 0; row < RESIDUALS; ++row) gain += (after[row] - before[row]) * (after[row] + before[row]);
#if ROBUST
  const float16 squared = TERM(squared)(before);
  gain = select(LOSS_VALUE(fmax(squared + gain, (float16)0), loss_scale) - LOSS_VALUE(squared, loss_scale),
                gain * LOSS_WEIGHT(squared + 0.5f * gain, loss_scale), fabs(gain) < 0.01f * squared);
#endif
  return weight * gain;
}

float16 TERM(energy)(const float16* u, float16 weight, float16 loss_scale) {
  float16 r[RESIDUALS];
  NAME_RESIDUAL(u, u, r);
  return weight * LOSS_VALUE(TERM(squared)(r), loss_scale);
}
