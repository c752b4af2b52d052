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

void add(Bytes& bytes, std::string_view word) {
  for (const char letter : word) bytes.push_back(static_cast<std::uint8_t>(letter));
}

void add(Bytes& bytes, std::initializer_list<std::uint32_t> numbers) {
  for (const std::uint32_t number : numbers) append(bytes, number);
}

/// Of a film without pictures: RIFF chunks as Microsoft's AVIMAINHEADER, AVISTREAMHEADER and BITMAPINFOHEADER
/// lay them out.
Bytes head(std::uint32_t width, std::uint32_t height) {
  Bytes bytes;
  add(bytes, "RIFF");
  add(bytes, {pictures_at + 4 - 8});
  add(bytes, "AVI LIST");
  add(bytes, {192});
  add(bytes, "hdrlavih");
  add(bytes, {56, 1'000'000 / pictures_a_second, 0, 0, 0, 0, 0, 1, 0, width, height, 0, 0, 0, 0});
  add(bytes, "LIST");
  add(bytes, {116});
  add(bytes, "strlstrh");
  add(bytes, {56});
  add(bytes, "vidsMJPG");
  add(bytes, {0, 0, 0, 1, pictures_a_second, 0, 0, 0, 0xFFFFFFFF, 0, 0, height << 16 | width});
  add(bytes, "strf");
  add(bytes, {40, 40, width, height, 24 << 16 | 1});
  add(bytes, "MJPG");
  add(bytes, {3 * width * height, 0, 0, 0, 0});
  add(bytes, "LIST");
  add(bytes, {4});
  add(bytes, "movi");
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
  Bytes chunk_head;
  add(chunk_head, "00dc");
  add(chunk_head, {static_cast<std::uint32_t>(jpeg.size())});
  write(chunk_head);
  write(jpeg);
  if (jpeg.size() % 2 != 0) write({0});
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
  add(bytes, {static_cast<std::uint32_t>(number)});
  stream_.seekp(at);
  stream_.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

}  // namespace pliant
