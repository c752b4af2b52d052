#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace pliant {

/// What the header of a PNG file says.
struct PngHeader {
  int width = 0;
  int height = 0;
  int bit_depth = 0;
  int color_type = 0;  ///< as in the PNG specification: 0 grey, 2 RGB, 3 palette, 4 grey + alpha, 6 RGBA

  bool is_grey() const { return color_type == 0; }
  std::string describe() const;  ///< e.g. "8-bit RGB"
};

/// A PNG file whose structure is sound, from its header to its end, without the chunks that no pixel
/// depends on.
struct PngFile {
  PngHeader header;
  std::vector<std::uint8_t> bytes;
};

bool is_png(const std::vector<std::uint8_t>& bytes);
bool is_jpeg(const std::vector<std::uint8_t>& bytes);

/// Walks the chunks of a PNG file and checks lengths, checksums and the end mark. The decoder would
/// answer damage with lines on stderr and leaves the reason there, so it is found here.
/// Throws DataError naming `path`.
PngFile check_png(const std::vector<std::uint8_t>& bytes, const std::string& path);

/// Walks the segments of a JPEG file up to its end mark: decoders fill what is missing with grey.
/// Throws DataError naming `path` when the file stops earlier.
void check_jpeg(const std::vector<std::uint8_t>& bytes, const std::string& path);

}  // namespace pliant
