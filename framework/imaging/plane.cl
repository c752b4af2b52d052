// The plane through points: smallest eigenvectors of symmetric 3x3 matrices, one a lane. Compiled behind
// lanes.cl.

typedef struct {
  Lanes xx, xy, xz, yy, yz, zz;
} Symmetric;

Vector times(Symmetric a, Vector v) {
  const Vector product = {a.xx * v.x + a.xy * v.y + a.xz * v.z, a.xy * v.x + a.yy * v.y + a.yz * v.z,
                          a.xz * v.x + a.yz * v.y + a.zz * v.z};
  return product;
}

Symmetric adjugate(Symmetric a) {
  const Symmetric adj = {a.yy * a.zz - a.yz * a.yz, a.xz * a.yz - a.xy * a.zz, a.xy * a.yz - a.xz * a.yy,
                         a.xx * a.zz - a.xz * a.xz, a.xy * a.xz - a.xx * a.yz, a.xx * a.yy - a.xy * a.xy};
  return adj;
}

// The smallest root of r^3 - r^2 + c1 r - c0, all of whose roots are real and not negative: Laguerre's
// iteration climbs to it from 0 and never passes it.
Lanes smallest_root(Lanes c1, Lanes c0) {
  Lanes root = 0;
  for (int round = 0; round < 4; ++round) {
    const Lanes value = ((root - 1.0f) * root + c1) * root - c0;
    const Lanes slope = (3.0f * root - 2.0f) * root + c1;
    const Lanes bend = 6.0f * root - 2.0f;
    const Lanes spread = sqrt(fmax(4.0f * slope * slope - 6.0f * value * bend, (Lanes)0));
    root -= 3.0f * fmin(value, (Lanes)0) / fmax(slope + spread, (Lanes)1e-20f);
  }
  return root;
}

// The column that has the largest entry on the diagonal.
Vector largest_column(Symmetric a) {
  const Lanes x = fabs(a.xx), y = fabs(a.yy), z = fabs(a.zz), larger = fmax(x, y);
  const Vector column = {select(select(a.xx, a.xy, y > x), a.xz, z > larger),
                         select(select(a.xy, a.yy, y > x), a.yz, z > larger),
                         select(select(a.xz, a.yz, y > x), a.zz, z > larger)};
  return column;
}

// A vector along the eigenvector of `a` whose eigenvalue is nearest to `value`, by inverse iteration: the
// column of the adjugate of a - value I that has the largest entry on the diagonal.
Vector eigenvector_near(Symmetric a, Lanes value) {
  a.xx -= value;
  a.yy -= value;
  a.zz -= value;
  return largest_column(adjugate(a));
}

Symmetric of_unit_trace(Symmetric m) {
  const Lanes scale = 1.0f / fmax(m.xx + m.yy + m.zz, (Lanes)1e-30f);
  const Symmetric a = {m.xx * scale, m.xy * scale, m.xz * scale, m.yy * scale, m.yz * scale, m.zz * scale};
  return a;
}

Lanes determinant_of(Symmetric a, Symmetric adj) { return a.xx * adj.xx + a.xy * adj.xy + a.xz * adj.xz; }

// Unit normal of the plane through points with this covariance; (0, 0, 0) where they lie on a line.
Vector plane_normal(Symmetric covariance) {
  const Symmetric a = of_unit_trace(covariance);
  const Symmetric adj = adjugate(a);
  const Lanes minors = adj.xx + adj.yy + adj.zz;
  const Vector rough = eigenvector_near(a, smallest_root(minors, determinant_of(a, adj)));
  // Rounding of the determinant blurs the root of elongated windows; the Rayleigh quotient does not.
  const Lanes quotient = inner(rough, times(a, rough)) / fmax(inner(rough, rough), (Lanes)1e-30f);
  const Vector normal = eigenvector_near(a, quotient);
  const Lanes length = sqrt(inner(normal, normal));
  return only(minors > (Lanes)FLATTEST && length > (Lanes)0, scaled(normal, 1.0f / length));
}

Symmetric squared(Symmetric a) {
  const Symmetric square = {a.xx * a.xx + a.xy * a.xy + a.xz * a.xz, a.xx * a.xy + a.xy * a.yy + a.xz * a.yz,
                            a.xx * a.xz + a.xy * a.yz + a.xz * a.zz, a.xy * a.xy + a.yy * a.yy + a.yz * a.yz,
                            a.xy * a.xz + a.yy * a.yz + a.yz * a.zz, a.xz * a.xz + a.yz * a.yz + a.zz * a.zz};
  return square;
}

// A vector along the eigenvector of the smallest eigenvalue: that of the largest of the adjugate, whose 16th
// power is that vector times itself but for (smallest / middle eigenvalue)^16.
Vector smallest_eigenvector(Symmetric covariance) {
  const Symmetric adj = adjugate(covariance);
  // A power of two brings the trace between 1 and 2, so that no power overflows.
  const Lanes scale = reciprocal_exponent(adj.xx + adj.yy + adj.zz);
  const Symmetric power = {adj.xx * scale, adj.xy * scale, adj.xz * scale,
                           adj.yy * scale, adj.yz * scale, adj.zz * scale};
  return largest_column(squared(squared(squared(squared(power)))));
}
