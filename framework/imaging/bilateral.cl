// Bilateral filter [Eq. 3.1]; compiled behind depth_map.cl.

// A Gaussian of depth, exp(-x^2 / 2 sigma^2) up to scale, of d = x / REACH sigma: the 16th power of a cubic
// in d^2, which vanishes from 1 on. It was fitted so that a window of two depths is filtered right to 3e-5
// sigma.
Lanes depth_weight(Lanes d) {
  const Lanes v = fmax(TOP - d * d, (Lanes)(TOP - 1.0f));
  const Lanes cubic = (v * v + LINEAR) * v + CONSTANT;
  const Lanes square = cubic * cubic, fourth = square * square, eighth = fourth * fourth;
  return eighth * eighth;
}

// `space`: the spatial weight of each pixel of the window, row by row. `scale`: 1 / REACH sigma_c, per mm.
// Writes the whole map, halo included.
kernel void bilateral(global const float* depth, int stride, int2 size, int radius, constant float* space,
                      float scale, global float* filtered) {
  const int start = get_global_id(0) * WIDTH;
  if (start >= stride * (size.y + 2 * HALO)) return;
  const Lanes centre = LOAD(depth + start);
  if (!ANY_DEPTH(centre)) {
    STORE(centre, filtered + start);
    return;
  }
  const Lanes origin = centre * scale;
  Lanes sum = 0, weights = 0;
  for (int dv = -radius; dv <= radius; ++dv) {
    global const float* row = depth + start + dv * stride;
    constant float* row_space = space + (dv + radius) * (2 * radius + 1) + radius;
    // Both sides at once: they have one spatial weight.
    const Lanes middle = LOAD(row) * scale - origin;
    const Lanes weight = row_space[0] * depth_weight(middle);
    sum += weight * middle;
    weights += weight;
    for (int du = 1; du <= radius; ++du) {
      const Lanes left = LOAD(row - du) * scale - origin, right = LOAD(row + du) * scale - origin;
      const Lanes of_left = depth_weight(left), of_right = depth_weight(right);
      sum += row_space[du] * (of_left * left + of_right * right);
      weights += row_space[du] * (of_left + of_right);
    }
  }
  STORE(select(centre, centre + sum / (weights * scale), HAS_DEPTH(centre)), filtered + start);
}
