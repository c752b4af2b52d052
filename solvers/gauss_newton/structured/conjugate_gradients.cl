// Conjugate gradients over M (x) I_3, the nodes' blocks and the constraints that couple the axes,
// preconditioned by the factors of the diagonal blocks (block Jacobi). One work-group. A constraint's J^T J
// is 3x3 in the displacement of its point, and is applied point by point.

// result = (M (from place `first` of each row on), and what is coupled if so asked) times by_node, for one
// batch; what is coupled must lie in `hessian_products`.
static inline void multiply_blocks(const System* s, int batch, int first, int with_coupled, float16* result) {
  float16 m[16];
  for (int n = 0; n < 16; ++n) {
    float16 x = 0, y = 0, z = 0;
    const int end = s->row_starts[16 * batch + n + 1];
    for (int block = s->row_starts[16 * batch + n] + first; block < end; ++block) {
      const float16 entries = s->M[block];
      global const float4* other = (global const float4*)(s->by_node + s->columns[block]);
      x += entries * SPREAD(other[0]);
      y += entries * SPREAD(other[1]);
      z += entries * SPREAD(other[2]);
    }
    m[n] = (float16)(fold(x), fold(y), fold(z), (float4)(0));
#if COUPLED
    if (with_coupled) m[n] = add_contributions(16 * batch + n, K, s->constraints, s->hessian_products, m[n]);
#endif
  }
  transpose(m);
  for (int entry = 0; entry < 12; ++entry) result[entry] = m[entry];
}

#if COUPLED
// J^T J (what by_node moves the point by) of every constraint.
static inline void multiply_hessians(const System* s) {
  FOR_EACH(instance, s->constraints.count) {
    const float8 W = s->point_hessians[instance];
    const float3 u = moved_by(instance, K, s->constraints, s->by_node);
    s->hessian_products[instance] = W.s0127 * u.x + W.s1347 * u.y + W.s2457 * u.z;
  }
  SYNC;
}
#endif

// Solves for the step until the preconditioned residual falls below `least`, or an iteration gains but a
// small share of those before. Returns the number of iterations, -1 when there is no solution.
int conjugate_gradients(const System* s, float least, local float* scratch) {
  float16 part = 0;
  FOR_EACH(batch, s->batches) {
    float16 z[12];
    for (int entry = 0; entry < 12; ++entry) z[entry] = s->residual[12 * batch + entry];
    solve_packed(s->P + 78 * batch, z);
    for (int entry = 0; entry < 12; ++entry) {
      part += z[entry] * s->residual[12 * batch + entry];
      s->direction[12 * batch + entry] = z[entry];
      s->step[12 * batch + entry] = 0;
    }
    store_by_node(z, batch, s->by_node);
  }
  float rz = group_sum(sum16(part), scratch);
  float gained = 0;
  int iteration = 0;
  if (!isfinite(rz)) return -1;
  while (iteration < 12 * s->node_count && rz > least) {
    SYNC;
#if COUPLED
    multiply_hessians(s);
#endif
    part = 0;
    FOR_EACH(batch, s->batches) {
      float16 p[12], q[12];
      multiply_blocks(s, batch, 1, 1, q);
      for (int entry = 0; entry < 12; ++entry) p[entry] = s->direction[12 * batch + entry];
      multiply_packed(s->D + 78 * batch, p, q);
      for (int entry = 0; entry < 12; ++entry) {
        part += p[entry] * q[entry];
        s->product[12 * batch + entry] = q[entry];
      }
    }
    const float curvature = group_sum(sum16(part), scratch);
    if (!(curvature > 0)) return iteration > 0 ? iteration : -1;
    ++iteration;
    const float alpha = rz / curvature;
    const float gain = alpha * rz;
    gained += gain;
    const int last = gain * max(iteration, 5) < 0.002f * gained;
    part = 0;
    FOR_EACH(batch, s->batches) {
      float16 z[12];
      for (int entry = 0; entry < 12; ++entry) {
        const int at = 12 * batch + entry;
        s->step[at] += alpha * s->direction[at];
        z[entry] = s->residual[at] - alpha * s->product[at];
        s->residual[at] = z[entry];
      }
      if (last) continue;
      solve_packed(s->P + 78 * batch, z);
      for (int entry = 0; entry < 12; ++entry) {
        part += z[entry] * s->residual[12 * batch + entry];
        s->product[12 * batch + entry] = z[entry];
      }
    }
    if (last) break;
    const float next = group_sum(sum16(part), scratch);
    const float beta = next / rz;
    rz = next;
    FOR_EACH(batch, s->batches) {
      float16 p[12];
      for (int entry = 0; entry < 12; ++entry) {
        const int at = 12 * batch + entry;
        p[entry] = s->product[at] + beta * s->direction[at];
        s->direction[at] = p[entry];
      }
      store_by_node(p, batch, s->by_node);
    }
  }
  return iteration;
}
