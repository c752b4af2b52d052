// Explicit vectors of WIDTH values, over which kernels are written: drivers do not make them themselves out
// of work-items with inner loops. Large functions of vectors are `inline`: drivers leave others apart, and
// hand vectors over through memory.

#if WIDTH == 16
typedef float16 Lanes;
typedef int16 Truth;  // of a comparison, lane by lane
#define LOAD(address) vload16(0, address)
#define STORE(value, address) vstore16(value, 0, address)
#define LANE_OFFSETS ((Lanes)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15))
#define ANY(condition) any_lane(condition)
// Drivers look at one lane after the other in their own any().
static inline int any_lane(int16 condition) {
  const int8 a = condition.lo | condition.hi;
  const int4 b = a.lo | a.hi;
  const int2 c = b.lo | b.hi;
  return (c.x | c.y) != 0;
}
#elif WIDTH == 1
typedef float Lanes;
typedef int Truth;
#define LOAD(address) (*(address))
#define STORE(value, address) (*(address) = (value))
#define LANE_OFFSETS 0
#define ANY(condition) (condition)
#else
#error "WIDTH must be 1 or 16"
#endif

#define WHERE(condition, value) select((Lanes)0, value, condition)  // 0 elsewhere

typedef struct {
  Lanes x, y, z;
} Vector;

Lanes inner(Vector a, Vector b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

Vector outer(Vector a, Vector b) {
  const Vector product = {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  return product;
}

Vector scaled(Vector v, Lanes factor) {
  const Vector product = {v.x * factor, v.y * factor, v.z * factor};
  return product;
}

// `v` where the condition holds, 0 elsewhere, whatever stands there (a product would let NaN through).
Vector only(Truth condition, Vector v) {
  const Vector chosen = {WHERE(condition, v.x), WHERE(condition, v.y), WHERE(condition, v.z)};
  return chosen;
}

// 2^-n for 2^n <= x < 2^(n + 1).
Lanes reciprocal_exponent(Lanes x) {
#if WIDTH == 16
  return as_float16(0x7f000000 - (as_int16(x) & 0x7f800000));
#else
  return as_float(0x7f000000 - (as_int(x) & 0x7f800000));
#endif
}

// 1 / sqrt(x) but for rounding, by Newton's steps from a straight line over the bits: vectors of roots and
// quotients are several times slower.
Lanes inverse_root(Lanes x) {
#if WIDTH == 16
  Lanes root = as_float16(0x5f3759df - (as_int16(x) >> 1));
  for (int step = 0; step < 3; ++step) root *= 1.5f - 0.5f * x * root * root;
  return root;
#else
  return rsqrt(x);
#endif
}

// WIDTH vectors that lie as x y z in turn; of fewer than WIDTH, `count`, the last one fills the rest.
Vector load_vectors(global const float* address, int count) {
#if WIDTH == 16
  if (count >= WIDTH) {
    const Lanes a = vload16(0, address), b = vload16(1, address), c = vload16(2, address);
    const Vector v = {(Lanes)(a.s0369, a.scf, b.s258b, b.se, c.s147a, c.sd),
                      (Lanes)(a.s147a, a.sd, b.s0369, b.scf, c.s258b, c.se),
                      (Lanes)(a.s258b, a.se, b.s147a, b.sd, c.s0369, c.scf)};
    return v;
  }
#endif
  float x[WIDTH], y[WIDTH], z[WIDTH];
  for (int lane = 0; lane < WIDTH; ++lane) {
    const float3 value = vload3(min(lane, count - 1), address);
    x[lane] = value.x;
    y[lane] = value.y;
    z[lane] = value.z;
  }
  const Vector v = {LOAD(x), LOAD(y), LOAD(z)};
  return v;
}

// x y z in turn of the first `count` of WIDTH vectors.
void store_vectors(Vector v, int count, global float* address) {
#if WIDTH == 16
  if (count >= WIDTH) {
    const Lanes x = v.x, y = v.y, z = v.z;
    vstore16((Lanes)(x.s0, y.s0, z.s0, x.s1, y.s1, z.s1, x.s2, y.s2, z.s2, x.s3, y.s3, z.s3, x.s4, y.s4, z.s4,
                     x.s5),
             0, address);
    vstore16((Lanes)(y.s5, z.s5, x.s6, y.s6, z.s6, x.s7, y.s7, z.s7, x.s8, y.s8, z.s8, x.s9, y.s9, z.s9, x.sa,
                     y.sa),
             1, address);
    vstore16((Lanes)(z.sa, x.sb, y.sb, z.sb, x.sc, y.sc, z.sc, x.sd, y.sd, z.sd, x.se, y.se, z.se, x.sf, y.sf,
                     z.sf),
             2, address);
    return;
  }
#endif
  float x[WIDTH], y[WIDTH], z[WIDTH];
  STORE(v.x, x);
  STORE(v.y, y);
  STORE(v.z, z);
  for (int lane = 0; lane < min(count, WIDTH); ++lane)
    vstore3((float3)(x[lane], y[lane], z[lane]), lane, address);
}

// Transposes a 16x16 matrix in place.
static inline void transpose(float16* m) {
  float16 other[16];
#pragma unroll
  for (int round = 0; round < 2; ++round) {
#pragma unroll
    for (int i = 0; i < 8; ++i) {
      other[2 * i].even = m[i].lo;
      other[2 * i].odd = m[i + 8].lo;
      other[2 * i + 1].even = m[i].hi;
      other[2 * i + 1].odd = m[i + 8].hi;
    }
#pragma unroll
    for (int i = 0; i < 8; ++i) {
      m[2 * i].even = other[i].lo;
      m[2 * i].odd = other[i + 8].lo;
      m[2 * i + 1].even = other[i].hi;
      m[2 * i + 1].odd = other[i + 8].hi;
    }
  }
}
