// Maps of points, one a pixel of a window of a camera's image, (0, 0, 0) where there is none. `camera`: fx,
// fy, cx, cy. `frame`: left, top, width and height of the window, then width and height of the image.
// Compiled behind lanes.cl.

#define FARTHEST 1e18f  // farthest_depth of image.h

#if WIDTH == 16
#define LOAD_INT(address) vload16(0, address)
#define STORE_INT(value, address) vstore16(value, 0, address)
#define TO_INT(value) convert_int16(value)
#define NONE ((Truth)-1)
#else
#define LOAD_INT(address) (*(address))
#define STORE_INT(value, address) (*(address) = (value))
#define TO_INT(value) ((int)(value))
#define NONE -1
#endif

#define STORE_VECTOR(v, x_address, y_address, z_address) \
  do {                                                   \
    STORE(v.x, x_address);                               \
    STORE(v.y, y_address);                               \
    STORE(v.z, z_address);                               \
  } while (0)

typedef Truth Pixels;  // offsets in the window; below 0: no pixel, or one outside of the window

#define NOT_IN_WINDOW ((Pixels)-2)  // a pixel of the image that the window leaves out

Vector minus(Vector a, Vector b) {
  const Vector difference = {a.x - b.x, a.y - b.y, a.z - b.z};
  return difference;
}

// `b` where the condition holds, `a` elsewhere.
Vector chosen(Vector a, Vector b, Truth condition) {
  const Vector v = {select(a.x, b.x, condition), select(a.y, b.y, condition), select(a.z, b.z, condition)};
  return v;
}

float sum_of(Lanes v) {
#if WIDTH == 1
  return v;
#else
  const float8 a = v.lo + v.hi;
  const float4 b = a.lo + a.hi;
  return (b.x + b.y) + (b.z + b.w);
#endif
}

// The pixels that points project to; none outside of the image.
Pixels project(Vector p, float4 camera, int8 frame) {
  const Lanes scale = 1.0f / p.z;
  const Lanes u = floor(camera.x * p.x * scale + (camera.z + 0.5f));
  const Lanes v = floor(camera.y * p.y * scale + (camera.w + 0.5f));
  const Truth in_image =
      p.z > (Lanes)0 && u >= (Lanes)0 && v >= (Lanes)0 && u < (Lanes)frame.s4 && v < (Lanes)frame.s5;
  const Lanes column = u - (Lanes)frame.s0, row = v - (Lanes)frame.s1;
  const Truth in_window =
      in_image && column >= (Lanes)0 && row >= (Lanes)0 && column < (Lanes)frame.s2 && row < (Lanes)frame.s3;
  return select(select(NONE, NOT_IN_WINDOW, in_image),
                TO_INT(WHERE(in_window, row)) * frame.s2 + TO_INT(WHERE(in_window, column)), in_window);
}

// The vectors of a map at some pixels; none, and those that are not finite, count as (0, 0, 0).
Vector gather(Pixels pixels, global const float* map) {
  int at[WIDTH];
  float x[WIDTH], y[WIDTH], z[WIDTH];
  STORE_INT(max(pixels, (Pixels)0), at);
#pragma unroll
  for (int lane = 0; lane < WIDTH; ++lane) {
    x[lane] = map[3 * at[lane]];
    y[lane] = map[3 * at[lane] + 1];
    z[lane] = map[3 * at[lane] + 2];
  }
  const Vector v = {LOAD(x), LOAD(y), LOAD(z)};
  const Lanes farthest = FARTHEST;
  return only(pixels >= (Pixels)0 && fabs(v.x) < farthest && fabs(v.y) < farthest && fabs(v.z) < farthest, v);
}
