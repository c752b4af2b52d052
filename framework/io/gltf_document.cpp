#include "framework/io/gltf_document.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include "framework/core/error.h"

namespace pliant {
namespace {

using Bytes = std::vector<std::uint8_t>;

// Numbers are copied from the file as they are.
static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "glTF files are little-endian");

constexpr std::uint32_t kMagic = 0x46546C67;        // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;    // "JSON"
constexpr std::uint32_t kBinaryChunk = 0x004E4942;  // "BIN"
constexpr std::size_t kUnsignedByte = 5121;
constexpr std::size_t kUnsignedShort = 5123;
constexpr std::size_t kUnsignedInt = 5125;
constexpr std::size_t kFloat = 5126;

std::uint32_t word_at(const Bytes& bytes, std::size_t offset) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + offset, sizeof(word));
  return word;
}

/// Bytes of an unsigned integer of a component type, 0 for another type.
std::size_t index_size(std::size_t component_type) {
  if (component_type == kUnsignedByte) return 1;
  if (component_type == kUnsignedShort) return 2;
  return component_type == kUnsignedInt ? 4 : 0;
}

std::vector<std::uint32_t> unpack(const Bytes& bytes, std::size_t size) {
  std::vector<std::uint32_t> numbers(bytes.size() / size);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    for (std::size_t b = 0; b < size; ++b) numbers[i] |= std::uint32_t{bytes[i * size + b]} << (8 * b);
  }
  return numbers;
}

}  // namespace

GltfDocument::GltfDocument(const Bytes& bytes, std::string path)
    : path_(std::move(path)), file_size_(bytes.size()) {
  split(bytes);
  check_support();
}

void GltfDocument::fail(const std::string& what) const {
  throw DataError(fmt::format("{}: {}", path_, what));
}

void GltfDocument::split(const Bytes& bytes) {
  constexpr std::size_t kHeader = 12;
  constexpr std::size_t kChunkHeader = 8;
  if (bytes.size() >= 4 && word_at(bytes, 0) != kMagic) fail("not a binary glTF file (.glb)");
  if (bytes.size() < kHeader) fail(fmt::format("truncated: {} bytes are less than a header", bytes.size()));
  if (word_at(bytes, 4) != 2) fail(fmt::format("glTF version {}, expected 2", word_at(bytes, 4)));
  const std::size_t length = word_at(bytes, 8);
  if (length != bytes.size()) {
    fail(fmt::format("{}: {} bytes, expected {}", length > bytes.size() ? "truncated" : "too long",
                     bytes.size(), length));
  }
  for (std::size_t offset = kHeader; offset < bytes.size();) {
    const std::size_t rest = bytes.size() - offset;
    if (rest < kChunkHeader) fail(fmt::format("{} bytes after the last chunk", rest));
    const std::size_t size = word_at(bytes, offset);
    const std::uint32_t type = word_at(bytes, offset + 4);
    if (size > rest - kChunkHeader) {
      fail(fmt::format("a chunk of {} bytes, but only {} are left", size, rest - kChunkHeader));
    }
    const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(offset + kChunkHeader);
    const auto end = begin + static_cast<std::ptrdiff_t>(size);
    if (offset == kHeader) {
      if (type != kJsonChunk) fail("the first chunk is not JSON");
      root_ = Json::parse(begin, end, nullptr, false);
      if (!root_.is_object()) fail("its JSON is damaged");
    } else if (type == kBinaryChunk && binary_.empty()) {
      binary_.assign(begin, end);
    }
    offset += kChunkHeader + size;
  }
}

void GltfDocument::check_support() const {
  if (!root_.is_object()) fail("no JSON chunk");
  const auto& needed = list(root_, "extensionsRequired");
  if (!needed.empty()) fail(fmt::format("needs the extension {}, which is not supported", needed[0].dump()));
}

const GltfDocument::Json* GltfDocument::find(const Json& object, const char* key) const {
  if (!object.is_object()) fail(fmt::format("expected an object with '{}'", key));
  const auto found = object.find(key);
  return found == object.end() ? nullptr : &*found;
}

const GltfDocument::Json& GltfDocument::at(const Json& object, const char* key) const {
  const Json* value = find(object, key);
  if (value == nullptr) fail(fmt::format("'{}' is missing", key));
  return *value;
}

std::size_t GltfDocument::index(const Json& value, const char* what) const {
  if (!value.is_number_unsigned()) fail(fmt::format("'{}' is not an unsigned integer", what));
  return value.get<std::size_t>();
}

std::size_t GltfDocument::integer(const Json& object, const char* key,
                                  std::optional<std::size_t> fallback) const {
  const Json* value = find(object, key);
  if (value == nullptr && fallback) return *fallback;
  return index(at(object, key), key);
}

std::string GltfDocument::text(const Json& object, const char* key) const {
  const Json& value = at(object, key);
  if (!value.is_string()) fail(fmt::format("'{}' is not a text", key));
  return value.get<std::string>();
}

const std::vector<GltfDocument::Json>& GltfDocument::list(const Json& object, const char* key) const {
  static const std::vector<Json> kNothing;
  const Json* value = find(object, key);
  if (value == nullptr) return kNothing;
  if (!value->is_array()) fail(fmt::format("'{}' is not a list", key));
  return value->get_ref<const Json::array_t&>();
}

std::optional<std::vector<double>> GltfDocument::numbers(const Json& object, const char* key,
                                                         std::size_t count) const {
  if (find(object, key) == nullptr) return std::nullopt;
  std::vector<double> numbers;
  for (const Json& value : list(object, key)) {
    if (!value.is_number()) fail(fmt::format("'{}' holds something that is not a number", key));
    numbers.push_back(value.get<double>());
  }
  if (numbers.size() != count) {
    fail(fmt::format("'{}' has {} numbers, expected {}", key, numbers.size(), count));
  }
  return numbers;
}

const GltfDocument::Json& GltfDocument::element(const char* list_name, std::size_t index) const {
  const auto& all = list(root_, list_name);
  if (index >= all.size()) {
    fail(fmt::format("element {} of '{}' is named, which has {}", index, list_name, all.size()));
  }
  return all[index];
}

/// `count` elements from the buffer view that `owner` names, from its byte offset on, without gaps.
Bytes GltfDocument::copy(const Json& owner, std::size_t count, std::size_t element_size) const {
  const std::size_t number = integer(owner, "bufferView");
  const Json& view = element("bufferViews", number);
  const Json& buffer = element("buffers", integer(view, "buffer"));
  if (find(buffer, "uri") != nullptr || integer(view, "buffer") != 0) {
    fail("data outside the binary chunk, which is not supported");
  }
  const std::size_t buffer_size = integer(buffer, "byteLength");
  if (buffer_size > binary_.size()) {
    fail(fmt::format("a buffer of {} bytes, but the binary chunk has {}", buffer_size, binary_.size()));
  }
  const std::size_t start = integer(view, "byteOffset", 0);
  const std::size_t length = integer(view, "byteLength");
  if (start > buffer_size || length > buffer_size - start) {
    fail(fmt::format("buffer view {} reaches out of its buffer", number));
  }
  constexpr std::size_t kWidestStride = 252;
  const std::size_t stride = integer(view, "byteStride", element_size);
  if (stride < element_size || stride > kWidestStride) {
    fail(fmt::format("buffer view {} has a stride of {} bytes, expected {} to {}", number, stride,
                     element_size, kWidestStride));
  }
  const std::size_t offset = integer(owner, "byteOffset", 0);
  // No product overflows: the count is no more than the file has bytes.
  if (offset > length || (count > 0 && (count - 1) * stride + element_size > length - offset)) {
    fail(fmt::format("an accessor reaches out of buffer view {}", number));
  }
  Bytes bytes(count * element_size);
  const std::uint8_t* from = binary_.data() + start + offset;
  for (std::size_t i = 0; i < count; ++i)
    std::memcpy(&bytes[i * element_size], from + i * stride, element_size);
  return bytes;
}

std::size_t GltfDocument::count(std::size_t accessor) const {
  const std::size_t count = integer(element("accessors", accessor), "count");
  // An accessor may stand for zeros that are not in the file; nothing else keeps their number sane.
  if (count > file_size_) {
    fail(fmt::format("accessor {} has {} elements, more than the file has bytes", accessor, count));
  }
  return count;
}

void GltfDocument::put_sparse(const Json& sparse, std::size_t element_size, Bytes& bytes) const {
  const std::size_t total = bytes.size() / element_size;
  const std::size_t count = integer(sparse, "count");
  if (count > total) fail(fmt::format("a sparse accessor replaces {} of {} elements", count, total));
  const Json& places = at(sparse, "indices");
  const std::size_t size = index_size(integer(places, "componentType"));
  if (size == 0) fail("the indices of a sparse accessor are not unsigned integers");
  const auto indices = unpack(copy(places, count, size), size);
  const Bytes values = copy(at(sparse, "values"), count, element_size);
  for (std::size_t i = 0; i < count; ++i) {
    if (indices[i] >= total) {
      fail(fmt::format("a sparse accessor replaces element {} of {}", indices[i], total));
    }
    std::memcpy(&bytes[indices[i] * element_size], &values[i * element_size], element_size);
  }
}

Bytes GltfDocument::packed(const Json& accessor, std::size_t element_size) const {
  const std::size_t count = integer(accessor, "count");
  Bytes bytes(count * element_size);
  if (find(accessor, "bufferView") != nullptr) bytes = copy(accessor, count, element_size);
  if (const Json* sparse = find(accessor, "sparse")) put_sparse(*sparse, element_size, bytes);
  return bytes;
}

std::vector<Eigen::Vector3f> GltfDocument::vectors(std::size_t accessor) const {
  const Json& description = element("accessors", accessor);
  if (text(description, "type") != "VEC3" || integer(description, "componentType") != kFloat) {
    fail(fmt::format("accessor {} does not hold vectors of three floats", accessor));
  }
  std::vector<Eigen::Vector3f> vectors(count(accessor));
  const Bytes bytes = packed(description, 3 * sizeof(float));
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    std::array<float, 3> xyz{};
    std::memcpy(xyz.data(), &bytes[i * sizeof(xyz)], sizeof(xyz));
    vectors[i] = Eigen::Vector3f(xyz[0], xyz[1], xyz[2]);
    if (!vectors[i].allFinite()) fail(fmt::format("element {} of accessor {} is not finite", i, accessor));
  }
  return vectors;
}

std::vector<std::uint32_t> GltfDocument::indices(std::size_t accessor) const {
  const Json& description = element("accessors", accessor);
  const std::size_t size = index_size(integer(description, "componentType"));
  if (text(description, "type") != "SCALAR" || size == 0) {
    fail(fmt::format("accessor {} does not hold unsigned integers", accessor));
  }
  count(accessor);
  return unpack(packed(description, size), size);
}

}  // namespace pliant
