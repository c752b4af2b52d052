#include "framework/io/gltf_container.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <string_view>

#include "framework/core/error.h"
#include "framework/io/file.h"

namespace pliant {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Json = nlohmann::json;

// Numbers are copied from the file as they are.
static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "glTF files are little-endian");

constexpr std::uint32_t kMagic = 0x46546C67;        // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;    // "JSON"
constexpr std::uint32_t kBinaryChunk = 0x004E4942;  // "BIN"

[[noreturn]] void fail(const std::string& path, const std::string& what) {
  throw DataError(fmt::format("{}: {}", path, what));
}

std::uint32_t word_at(const Bytes& bytes, std::size_t offset) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + offset, sizeof(word));
  return word;
}

template <class Iterator>
Json parse(Iterator begin, Iterator end, const std::string& path) {
  Json root = Json::parse(begin, end, nullptr, false);
  if (!root.is_object()) fail(path, "its JSON is damaged");
  return root;
}

GltfContainer open_binary(const Bytes& bytes, const std::string& path) {
  constexpr std::size_t kHeader = 12;
  constexpr std::size_t kChunkHeader = 8;
  if (bytes.size() < kHeader)
    fail(path, fmt::format("truncated: {} bytes are less than a header", bytes.size()));
  if (word_at(bytes, 4) != 2) fail(path, fmt::format("glTF version {}, expected 2", word_at(bytes, 4)));
  const std::size_t length = word_at(bytes, 8);
  if (length != bytes.size())
    fail(path, fmt::format("{}: {} bytes, expected {}", length > bytes.size() ? "truncated" : "too long",
                           bytes.size(), length));
  GltfContainer container;
  for (std::size_t offset = kHeader; offset < bytes.size();) {
    const std::size_t rest = bytes.size() - offset;
    if (rest < kChunkHeader) fail(path, fmt::format("{} bytes after the last chunk", rest));
    const std::size_t size = word_at(bytes, offset);
    const std::uint32_t type = word_at(bytes, offset + 4);
    if (size > rest - kChunkHeader)
      fail(path, fmt::format("a chunk of {} bytes, but only {} are left", size, rest - kChunkHeader));
    const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(offset + kChunkHeader);
    const auto end = begin + static_cast<std::ptrdiff_t>(size);
    if (offset == kHeader) {
      if (type != kJsonChunk) fail(path, "the first chunk is not JSON");
      container.root = parse(begin, end, path);
    } else if (type == kBinaryChunk && container.binary.empty()) {
      container.binary.assign(begin, end);
    }
    offset += kChunkHeader + size;
  }
  if (!container.root.is_object()) fail(path, "no JSON chunk");
  return container;
}

/// Whether a file may be JSON: its first character, after a byte-order mark and blanks, begins an object.
bool is_text(const Bytes& bytes) {
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && text[first] == '{';
}

GltfContainer open_text(const Bytes& bytes, const std::string& path) {
  GltfContainer container{parse(bytes.begin(), bytes.end(), path), {}};
  const auto asset = container.root.find("asset");
  if (asset == container.root.end() || !asset->is_object() || !asset->contains("version"))
    fail(path, "'asset' with a 'version' is missing; is this a glTF 2.0 file?");
  const Json& version = (*asset)["version"];
  if (!version.is_string() || !version.get_ref<const std::string&>().starts_with("2."))
    fail(path, fmt::format("glTF version {}, expected 2.0", shown_json(version)));
  return container;
}

int base64_digit(char letter) {
  static constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const std::size_t digit = kDigits.find(letter);
  return digit == std::string_view::npos ? -1 : static_cast<int>(digit);
}

Bytes decode_base64(std::string_view text, const std::string& path) {
  for (int padding = 0; padding < 2 && text.ends_with('='); ++padding) text.remove_suffix(1);
  if (text.size() % 4 == 1) fail(path, "the data of a buffer are cut short");
  Bytes bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char letter : text) {
    const int digit = base64_digit(letter);
    if (digit < 0) fail(path, "the data of a buffer are not base64");
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes.push_back(static_cast<std::uint8_t>(bits >> count));
  }
  return bytes;
}

/// With what is written as %20 put in its place.
std::string unescaped(const std::string& uri, const std::string& path) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] != '%') {
      text += uri[i];
      continue;
    }
    unsigned code = 0;
    const char* digits = uri.data() + i + 1;
    const char* end = uri.data() + std::min(i + 3, uri.size());
    const auto [stop, error] = std::from_chars(digits, end, code, 16);
    if (error != std::errc() || stop != digits + 2 || code == 0)
      fail(path, fmt::format("the name {} of a buffer is not escaped properly", shown_json(uri)));
    text += static_cast<char>(code);
    i += 2;
  }
  return text;
}

/// Whether a URI names a place beyond the disk, as "https:..." does.
bool has_scheme(const std::string& uri) {
  const std::size_t end = uri.find_first_of(":/?#");
  return end != std::string::npos && end > 1 && uri[end] == ':';
}

}  // namespace

GltfContainer open_gltf(const Bytes& bytes, const std::string& path) {
  if (is_text(bytes)) return open_text(bytes, path);
  if (bytes.size() >= 4 && word_at(bytes, 0) != kMagic)
    fail(path, "not a glTF file: neither binary (.glb) nor JSON (.gltf)");
  return open_binary(bytes, path);
}

Bytes resolve_uri(const std::string& uri, const std::string& path) {
  if (uri.starts_with("data:")) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string::npos || !std::string_view(uri).substr(0, comma).ends_with(";base64"))
      fail(path, "the data of a buffer are not base64");
    return decode_base64(std::string_view(uri).substr(comma + 1), path);
  }
  const std::string name = unescaped(uri, path);
  if (name.empty() || has_scheme(uri))
    fail(path, fmt::format("a buffer is in {}, expected a file or data", shown_json(uri)));
  try {
    return read_file((std::filesystem::path(path).parent_path() / name).string());
  } catch (const DataError& error) {
    fail(path, fmt::format("its buffer cannot be had: {}", error.what()));
  }
}

std::string shown_json(const Json& value) {
  constexpr std::size_t longest = 80;
  std::string text = value.dump(-1, ' ', true, Json::error_handler_t::replace);
  if (text.size() > longest) text = text.substr(0, longest) + "...";
  return text;
}

}  // namespace pliant
