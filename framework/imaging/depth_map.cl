// Kernels over depth maps. A map is an image of floats in rows of `stride`, ringed by a HALO of pixels
// without depth, so that a window around any pixel is read without a bounds check. Where there is no depth
// stands NO_DEPTH, so far away that no neighbour within reach of a surface is ever mixed with it. Work-items
// are written over vectors of WIDTH pixels of a row; compiled behind lanes.cl.

#define HAS_DEPTH(depth) ((depth) < (Lanes)NO_DEPTH)
#define ANY_DEPTH(depth) ANY(HAS_DEPTH(depth))

// The rays (x, y, 1) through the pixels from (u, v) of a map on. camera: fx, fy, cx, cy; corner: the pixel of
// its image at which the map begins.
Vector ray_through(int u, int v, int2 corner, float4 camera) {
  const float2 pixel = 1.0f / camera.xy;
  const Vector ray = {((Lanes)(corner.x + u - camera.z) + LANE_OFFSETS) * pixel.x,
                      (Lanes)((corner.y + v - camera.w) * pixel.y), 1};
  return ray;
}
