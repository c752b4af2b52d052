#include "framework/io/image_container.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#include "framework/core/error.h"

namespace pliant {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::array<std::uint8_t, 8> kPngSignature = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};

std::uint32_t big_endian(const std::uint8_t* bytes) {
  return (std::uint32_t{bytes[0]} << 24) | (std::uint32_t{bytes[1]} << 16) | (std::uint32_t{bytes[2]} << 8) |
         std::uint32_t{bytes[3]};
}

std::array<std::uint32_t, 256> make_crc_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < table.size(); ++i) {
    std::uint32_t value = i;
    for (int bit = 0; bit < 8; ++bit) value = (value >> 1) ^ ((value & 1u) != 0 ? 0xedb88320u : 0u);
    table[i] = value;
  }
  return table;
}

/// The checksum of PNG chunks (CRC-32 of ISO 3309).
std::uint32_t crc32(const std::uint8_t* bytes, std::size_t size) {
  static const auto table = make_crc_table();
  std::uint32_t crc = 0xffffffffu;
  for (std::size_t i = 0; i < size; ++i) crc = table[(crc ^ bytes[i]) & 0xffu] ^ (crc >> 8);
  return ~crc;
}

[[noreturn]] void throw_truncated(const std::string& path, const char* format, std::size_t size) {
  throw DataError(fmt::format("{}: truncated {}: it ends after {} bytes", path, format, size));
}

struct Chunk {
  std::string type;
  std::size_t begin = 0;  // of the whole chunk, its length field included
  std::size_t data = 0;
  std::size_t length = 0;
  std::size_t end = 0;

  // An upper-case first letter marks the chunks without which there is no image.
  bool is_critical() const { return type[0] >= 'A' && type[0] <= 'Z'; }
};

Chunk read_chunk(const Bytes& bytes, std::size_t begin, const std::string& path) {
  constexpr std::size_t kOverhead = 12;  // length, type and checksum
  if (bytes.size() - begin < kOverhead) throw_truncated(path, "PNG", bytes.size());
  Chunk chunk;
  chunk.begin = begin;
  chunk.data = begin + 8;
  chunk.length = big_endian(&bytes[begin]);
  chunk.type.assign(bytes.begin() + begin + 4, bytes.begin() + begin + 8);
  if (chunk.length > bytes.size() - begin - kOverhead) throw_truncated(path, "PNG", bytes.size());
  chunk.end = begin + kOverhead + chunk.length;
  if (crc32(&bytes[begin + 4], chunk.length + 4) != big_endian(&bytes[chunk.end - 4])) {
    throw DataError(fmt::format("{}: damaged PNG: wrong checksum at byte {}", path, begin));
  }
  return chunk;
}

PngHeader read_png_header(const Bytes& bytes, const Chunk& chunk, const std::string& path) {
  if (chunk.type != "IHDR" || chunk.length != 13) {
    throw DataError(fmt::format("{}: damaged PNG: it does not begin with a header", path));
  }
  const std::uint8_t* data = &bytes[chunk.data];
  const std::uint32_t width = big_endian(data);
  const std::uint32_t height = big_endian(data + 4);
  constexpr std::uint32_t kLargest = std::numeric_limits<int>::max();
  if (width == 0 || height == 0 || width > kLargest || height > kLargest) {
    throw DataError(fmt::format("{}: damaged PNG: a size of {}x{}", path, width, height));
  }
  return {static_cast<int>(width), static_cast<int>(height), data[8], data[9]};
}

// Index just behind the compressed data that begins at `at`: the next marker that is not part of it.
std::size_t skip_jpeg_scan(const Bytes& bytes, std::size_t at) {
  while (at + 1 < bytes.size()) {
    const std::uint8_t next = bytes[at + 1];
    const bool is_restart = next >= 0xd0 && next <= 0xd7;
    if (bytes[at] == 0xff && next != 0x00 && next != 0xff && !is_restart) return at;
    ++at;
  }
  return bytes.size();
}

}  // namespace

std::string PngHeader::describe() const {
  switch (color_type) {
    case 0:
      return fmt::format("{}-bit single-channel", bit_depth);
    case 2:
      return fmt::format("{}-bit RGB", bit_depth);
    case 3:
      return fmt::format("{}-bit palette", bit_depth);
    case 4:
      return fmt::format("{}-bit grey with alpha", bit_depth);
    case 6:
      return fmt::format("{}-bit RGBA", bit_depth);
    default:
      return fmt::format("unknown colour type {}", color_type);
  }
}

bool is_png(const Bytes& bytes) {
  return bytes.size() >= kPngSignature.size() &&
         std::equal(kPngSignature.begin(), kPngSignature.end(), bytes.begin());
}

bool is_jpeg(const Bytes& bytes) {
  return bytes.size() >= 3 && bytes[0] == 0xff && bytes[1] == 0xd8 && bytes[2] == 0xff;
}

PngFile check_png(const Bytes& bytes, const std::string& path) {
  if (!is_png(bytes)) throw DataError(fmt::format("{}: not a PNG file", path));
  PngFile file;
  Chunk chunk = read_chunk(bytes, kPngSignature.size(), path);
  file.header = read_png_header(bytes, chunk, path);
  file.bytes.assign(bytes.begin(), bytes.begin() + chunk.end);
  while (chunk.type != "IEND") {
    chunk = read_chunk(bytes, chunk.end, path);
    if (chunk.is_critical()) {
      file.bytes.insert(file.bytes.end(), bytes.begin() + chunk.begin, bytes.begin() + chunk.end);
    }
  }
  return file;
}

void check_jpeg(const Bytes& bytes, const std::string& path) {
  constexpr std::uint8_t kEnd = 0xd9;
  constexpr std::uint8_t kScan = 0xda;
  std::size_t at = 2;
  while (at + 1 < bytes.size()) {
    if (bytes[at] != 0xff) throw DataError(fmt::format("{}: damaged JPEG at byte {}", path, at));
    const std::uint8_t marker = bytes[at + 1];
    if (marker == kEnd) return;
    if (marker == 0xff) {  // padding
      ++at;
      continue;
    }
    if (at + 3 >= bytes.size()) break;
    at += 2 + (std::size_t{bytes[at + 2]} << 8 | bytes[at + 3]);
    if (marker == kScan) at = skip_jpeg_scan(bytes, at);
  }
  throw_truncated(path, "JPEG", bytes.size());
}

}  // namespace pliant
