// Procedural colour, WIDTH pixels a work-item; compiled behind lanes.cl. See surface_color.h.

#if WIDTH == 16
typedef uint16 Bits;
#define TO_BITS(value) as_uint16(convert_int16(value))
#define TO_LANES(bits) convert_float16(as_int16(bits))
#define STORE_ROUNDED(value, address) vstore16(convert_int16((value) + 0.5f), 0, address)
#define LOAD_TRUTH(address) vload16(0, address)
#else
typedef uint Bits;
#define TO_BITS(value) ((uint)(int)(value))
#define TO_LANES(bits) ((float)(bits))
#define STORE_ROUNDED(value, address) (*(address) = (int)((value) + 0.5f))
#define LOAD_TRUTH(address) (*(address))
#endif

// Three random numbers of ten bits for a corner of a grid: the last steps of MurmurHash3 (A. Appleby) on a
// sum of multiples.
Bits corner_bits(Bits x, Bits y, Bits z, uint key) {
  Bits bits = x * 0x9e3779b1u + y * 0x85ebca77u + z * 0xc2b2ae3du + key;
  bits = (bits ^ (bits >> 16)) * 0x85ebca6bu;
  bits = (bits ^ (bits >> 13)) * 0xc2b2ae35u;
  return bits ^ (bits >> 16);
}

Vector channels(Bits bits) {
  const Vector values = {TO_LANES(bits & 1023u), TO_LANES((bits >> 10) & 1023u),
                         TO_LANES((bits >> 20) & 1023u)};
  return values;
}

Vector between(Vector a, Vector b, Lanes share) {
  const Vector mixed = {a.x + share * (b.x - a.x), a.y + share * (b.y - a.y), a.z + share * (b.z - a.z)};
  return mixed;
}

Lanes smooth(Lanes share) { return share * share * (3.0f - 2.0f * share); }

Vector along_z(Bits x, Bits y, Bits z, uint key, Lanes share) {
  return between(channels(corner_bits(x, y, z, key)), channels(corner_bits(x, y, z + 1u, key)), share);
}

// Noise from -1 to 1 in each channel.
Vector noise(Vector p, float spacing, uint key) {
  const Lanes sx = p.x / spacing, sy = p.y / spacing, sz = p.z / spacing;
  const Lanes fx = floor(sx), fy = floor(sy), fz = floor(sz);
  const Bits x = TO_BITS(fx), y = TO_BITS(fy), z = TO_BITS(fz);
  const Lanes tx = smooth(sx - fx), ty = smooth(sy - fy), tz = smooth(sz - fz);
  const Vector near = between(along_z(x, y, z, key, tz), along_z(x, y + 1u, z, key, tz), ty);
  const Vector far = between(along_z(x + 1u, y, z, key, tz), along_z(x + 1u, y + 1u, z, key, tz), ty);
  const Vector value = between(near, far, tx);
  const Vector centred = {value.x / 511.5f - 1.0f, value.y / 511.5f - 1.0f, value.z / 511.5f - 1.0f};
  return centred;
}

// How much of a freckle is there: 0 to 1.
Lanes freckle(Lanes noise) {
  return smooth(clamp((noise - FRECKLE_BEGIN) / FRECKLE_EDGE, (Lanes)0, (Lanes)1));
}

Lanes in_range(Lanes value) { return fmin(fmax(value, (Lanes)0), (Lanes)255); }

// spacings, amplitudes, keys: of three scales, then of the freckles. toned: the first channel of noise makes
// all channels brighter in the ratio of `base`.
kernel void paint(int count, global const int* triangles, global const float* rest, float4 spacings,
                  float4 amplitudes, uint4 keys, float4 base, int toned, global uchar* colors) {
  const int first = get_global_id(0) * WIDTH;
  if (first >= count) return;
  const int here = min(count - first, WIDTH);
  int shown[WIDTH];
  int any_shown = 0;
  for (int lane = 0; lane < WIDTH; ++lane) {
    shown[lane] = lane < here && triangles[first + lane] >= 0 ? -1 : 0;
    any_shown |= shown[lane];
  }
  Vector color = {0, 0, 0};
  if (any_shown) {
    const Vector p = load_vectors(rest + 3 * first, here);
    const Vector coarse = noise(p, spacings.x, keys.x), middle = noise(p, spacings.y, keys.y),
                 fine = noise(p, spacings.z, keys.z);
    Vector sum = {amplitudes.x * coarse.x + amplitudes.y * middle.x + amplitudes.z * fine.x,
                  amplitudes.x * coarse.y + amplitudes.y * middle.y + amplitudes.z * fine.y,
                  amplitudes.x * coarse.z + amplitudes.y * middle.z + amplitudes.z * fine.z};
    if (toned) {
      Lanes tone = sum.x;
      if (amplitudes.w > 0) tone -= amplitudes.w * freckle(noise(p, spacings.w, keys.w).x);
      sum.x = tone * (base.x / 255.0f);
      sum.y = tone * (base.y / 255.0f);
      sum.z = tone * (base.z / 255.0f);
    }
    const Vector whole = {base.x + sum.x, base.y + sum.y, base.z + sum.z};
    color = only(LOAD_TRUTH(shown), whole);
  }
  int r[WIDTH], g[WIDTH], b[WIDTH];
  STORE_ROUNDED(in_range(color.x), r);
  STORE_ROUNDED(in_range(color.y), g);
  STORE_ROUNDED(in_range(color.z), b);
  for (int lane = 0; lane < here; ++lane)
    vstore3(convert_uchar3((int3)(r[lane], g[lane], b[lane])), first + lane, colors);
}

// Patches over what was painted: a pixel a work-item. Ten numbers a patch: centre, radii, colour, strength.
kernel void paint_patches(int count, global const int* triangles, global const float* rest, int patches,
                          global const float* numbers, float edge, global uchar* colors) {
  const int pixel = get_global_id(0);
  if (pixel >= count || triangles[pixel] < 0) return;
  const float3 point = vload3(pixel, rest);
  float3 color = convert_float3(vload3(pixel, colors));
  for (int i = 0; i < patches; ++i) {
    global const float* patch = numbers + 10 * i;
    const float inside =
        clamp((1.0f - length((point - vload3(0, patch)) / vload3(1, patch))) / edge, 0.0f, 1.0f);
    const float share = patch[9] * inside * inside * (3.0f - 2.0f * inside);
    color = floor(clamp(color + share * (vload3(2, patch) - color), 0.0f, 255.0f) + 0.5f);
  }
  vstore3(convert_uchar3(color), pixel, colors);
}
