#include "experiments/view/film_file.h"

#include <initializer_list>
#include <string_view>
#include <utility>

#include "framework/core/error.h"
#include "framework/io/little_endian.h"

namespace pliant {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::uint32_t pictures_a_second = 30;
constexpr std::size_t most_bytes = 2'000'000'000;

// Where the numbers that grow stand.
constexpr std::streamoff file_size_at = 4;
constexpr std::streamoff picture_count_at = 48;
constexpr std::streamoff length_at = 140;
constexpr std::streamoff pictures_size_at = 216;
constexpr std::uint32_t pictures_at = 220;

void append(Bytes& bytes, std::string_view word) { bytes.insert(bytes.end(), word.begin(), word.end()); }

void append(Bytes& bytes, std::initializer_list<std::uint32_t> numbers) {
  for (const std::uint32_t number : numbers) append(bytes, number);
}

/// Of a film without pictures: RIFF chunks as Microsoft's AVIMAINHEADER, AVISTREAMHEADER and BITMAPINFOHEADER
/// lay them out.
Bytes head(std::uint32_t width, std::uint32_t height) {
  Bytes bytes;
  append(bytes, "RIFF");
  append(bytes, {pictures_at + 4 - 8});
  append(bytes, "AVI LIST");
  append(bytes, {192});
  append(bytes, "hdrlavih");
  append(bytes, {56, 1'000'000 / pictures_a_second, 0, 0, 0, 0, 0, 1, 0, width, height, 0, 0, 0, 0});
  append(bytes, "LIST");
  append(bytes, {116});
  append(bytes, "strlstrh");
  append(bytes, {56});
  append(bytes, "vidsMJPG");
  append(bytes, {0, 0, 0, 1, pictures_a_second, 0, 0, 0, 0xFFFFFFFF, 0, 0, height << 16 | width});
  append(bytes, "strf");
  append(bytes, {40, 40, width, height, 24 << 16 | 1});
  append(bytes, "MJPG");
  append(bytes, {3 * width * height, 0, 0, 0, 0});
  append(bytes, "LIST");
  append(bytes, {4});
  append(bytes, "movi");
  return bytes;
}

}  // namespace

FilmFile::FilmFile(std::filesystem::path file, int width, int height)
    : file_(std::move(file)), stream_(file_, std::ios::binary | std::ios::trunc) {
  write(head(static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)));
  stream_.flush();
}

bool FilmFile::append(const Bytes& jpeg) {
  if (size_ + jpeg.size() + 9 > most_bytes) return false;
  Bytes chunk;
  pliant::append(chunk, "00dc");
  pliant::append(chunk, {static_cast<std::uint32_t>(jpeg.size())});
  chunk.insert(chunk.end(), jpeg.begin(), jpeg.end());
  if (chunk.size() % 2 != 0) chunk.push_back(0);
  write(chunk);
  ++pictures_;
  write_number(file_size_at, size_ - 8);
  write_number(picture_count_at, pictures_);
  write_number(length_at, pictures_);
  write_number(pictures_size_at, size_ - pictures_at);
  stream_.flush();
  return true;
}

/// Behind what is there.
void FilmFile::write(const Bytes& bytes) {
  stream_.seekp(static_cast<std::streamoff>(size_));
  stream_.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!stream_) throw DataError(file_.string() + ": the film cannot be written");
  size_ += bytes.size();
}

void FilmFile::write_number(std::streamoff at, std::size_t number) {
  Bytes bytes;
  pliant::append(bytes, static_cast<std::uint32_t>(number));
  stream_.seekp(at);
  stream_.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

}  // namespace pliant
