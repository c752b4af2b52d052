// Bilateral filter [Eq. 3.1]; compiled behind depth_map.cl.

// exp2 for 0 >= x, relative error below 2e-5: vectors of the driver's own exp2 are many times slower.
Lanes exp2_of_negative(Lanes x) {
#if WIDTH == 1
  return native_exp2(x);
#else
  const Lanes shift = 12582912.0f;  // 1.5 * 2^23: adding it rounds to whole numbers, left in the low bits
  const Lanes clamped = fmax(x, (Lanes)-126.0f);
  const Lanes shifted = clamped + shift;
  const Lanes f = clamped - (shifted - shift);  // -1/2 .. 1/2
  const Lanes power = 1.0f + f * (0.6931472f + f * (0.2402265f + f * (0.05550411f + f * 0.009618129f)));
  return as_float16(as_int16(power) + (as_int16(shifted) << 23));
#endif
}

// `steps`: -log2 of the spatial weight of each pixel of the window, row by row. `sharpness`:
// log2(e) / (2 sigma_c^2). Writes the whole map, halo included.
kernel void bilateral(global const float* depth, int stride, int2 size, int radius, constant float* steps,
                      float sharpness, global float* filtered) {
  const int start = get_global_id(0) * WIDTH;
  if (start >= stride * (size.y + 2 * HALO)) return;
  const Lanes centre = LOAD(depth + start);
  if (!ANY_DEPTH(centre)) {
    STORE(centre, filtered + start);
    return;
  }
  Lanes sum = 0, weights = 0;
  for (int dv = -radius; dv <= radius; ++dv) {
    global const float* row = depth + start + dv * stride;
    constant float* row_steps = steps + (dv + radius) * (2 * radius + 1) + radius;
    for (int du = -radius; du <= radius; ++du) {
      const Lanes difference = LOAD(row + du) - centre;
      const Lanes weight = exp2_of_negative(-row_steps[du] - sharpness * difference * difference);
      sum += weight * difference;
      weights += weight;
    }
  }
  STORE(select(centre, centre + sum / weights, HAS_DEPTH(centre)), filtered + start);
}
