#include "framework/io/gltf_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "framework/core/error.h"
#include "framework/io/gltf_container.h"

namespace pliant {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kByte = 5120;
constexpr std::size_t kUnsignedByte = 5121;
constexpr std::size_t kShort = 5122;
constexpr std::size_t kUnsignedShort = 5123;
constexpr std::size_t kUnsignedInt = 5125;
constexpr std::size_t kFloat = 5126;

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

std::size_t components_of(const std::string& type) {
  if (type == "SCALAR") return 1;
  return type == "MAT4" ? 16 : static_cast<std::size_t>(type.back() - '0');
}

/// A number as it stands in a buffer.
struct Component {
  std::size_t type = kFloat;
  bool is_normalised = false;

  std::size_t size() const {
    if (type == kFloat) return 4;
    return type == kShort || type == kUnsignedShort ? 2 : 1;
  }

  /// glTF 2.0, section 3.6.2.2: the smallest signed integer stands for -1 as the next one does.
  float at(const std::uint8_t* bytes) const {
    if (type == kFloat) return copied<float>(bytes);
    const bool is_signed = type == kByte || type == kShort;
    int value = 0;
    if (size() == 1) value = is_signed ? copied<std::int8_t>(bytes) : copied<std::uint8_t>(bytes);
    if (size() == 2) value = is_signed ? copied<std::int16_t>(bytes) : copied<std::uint16_t>(bytes);
    if (!is_normalised) return static_cast<float>(value);
    const int largest = (1 << (8 * static_cast<int>(size()) - (is_signed ? 1 : 0))) - 1;
    return std::max(static_cast<float>(value) / static_cast<float>(largest), -1.0F);
  }

 private:
  template <class Number>
  static Number copied(const std::uint8_t* bytes) {
    Number number;
    std::memcpy(&number, bytes, sizeof(number));
    return number;
  }
};

}  // namespace

GltfDocument::GltfDocument(const Bytes& bytes, std::string path)
    : path_(std::move(path)), total_size_(bytes.size()) {
  GltfContainer container = open_gltf(bytes, path_);
  root_ = std::move(container.root);
  binary_ = std::move(container.binary);
  check_support();
  load_buffers();
}

void GltfDocument::fail(const std::string& what) const {
  throw DataError(fmt::format("{}: {}", path_, what));
}

/// What changes materials only may be needed by who shows them.
void GltfDocument::check_support() {
  for (const Json& needed : list(root_, "extensionsRequired")) {
    const std::string name = needed.is_string() ? needed.get<std::string>() : "";
    if (name == "KHR_mesh_quantization")
      is_quantised_ = true;
    else if (!name.starts_with("KHR_materials_") && !name.starts_with("KHR_texture_"))
      fail(fmt::format("needs the extension {}, which is not supported", shown_json(needed)));
  }
}

void GltfDocument::load_buffers() {
  for (const Json& buffer : list(root_, "buffers")) {
    if (find(buffer, "uri") == nullptr) continue;
    const auto [entry, is_new] = resolved_.try_emplace(text(buffer, "uri"));
    if (!is_new) continue;
    entry->second = resolve_uri(entry->first, path_);
    total_size_ += entry->second.size();
  }
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
  const std::size_t buffer_number = integer(view, "buffer");
  const Json& buffer = element("buffers", buffer_number);
  const bool is_apart = find(buffer, "uri") != nullptr;
  if (!is_apart && buffer_number != 0) fail(fmt::format("buffer {} has no data", buffer_number));
  const Bytes& data = is_apart ? resolved_.at(text(buffer, "uri")) : binary_;
  const std::size_t buffer_size = integer(buffer, "byteLength");
  if (buffer_size > data.size())
    fail(fmt::format("a buffer of {} bytes, but {} has {}", buffer_size,
                     is_apart ? shown_json(text(buffer, "uri")) : "the binary chunk", data.size()));
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
  const std::uint8_t* from = data.data() + start + offset;
  for (std::size_t i = 0; i < count; ++i)
    std::memcpy(&bytes[i * element_size], from + i * stride, element_size);
  return bytes;
}

std::size_t GltfDocument::count(std::size_t accessor) const {
  const std::size_t count = integer(element("accessors", accessor), "count");
  // An accessor may stand for zeros that are not in the file; nothing else keeps their number sane.
  if (count > total_size_) {
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

void GltfDocument::check_type(std::size_t accessor, const std::string& type, Numbers allowed) const {
  const Json& description = element("accessors", accessor);
  const std::size_t component = integer(description, "componentType");
  const bool may_be_plain = allowed == Numbers::quantised && is_quantised_;
  const bool may_be_small = may_be_plain || (allowed == Numbers::normalised && is_normalised(description));
  const bool is_small =
      component == kByte || component == kUnsignedByte || component == kShort || component == kUnsignedShort;
  if (text(description, "type") == type && (component == kFloat || (is_small && may_be_small))) return;
  fail(fmt::format("accessor {} holds {} of component type {}, expected {} of floats{}", accessor,
                   shown_json(text(description, "type")), component, type,
                   allowed == Numbers::normalised ? " or normalised integers" : ""));
}

bool GltfDocument::is_normalised(const Json& accessor) const {
  const Json* value = find(accessor, "normalized");
  if (value != nullptr && !value->is_boolean()) fail("'normalized' is neither true nor false");
  return value != nullptr && value->get<bool>();
}

std::vector<float> GltfDocument::reals(std::size_t accessor, const std::string& type, Numbers allowed) const {
  check_type(accessor, type, allowed);
  const Json& description = element("accessors", accessor);
  const Component component{integer(description, "componentType"), is_normalised(description)};
  const std::size_t width = components_of(type);
  std::vector<float> numbers(count(accessor) * width);
  const Bytes bytes = packed(description, width * component.size());
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    numbers[i] = component.at(&bytes[i * component.size()]);
    if (!std::isfinite(numbers[i]))
      fail(fmt::format("element {} of accessor {} is not finite", i / width, accessor));
  }
  return numbers;
}

std::vector<Eigen::Vector3f> GltfDocument::vectors(std::size_t accessor) const {
  const std::vector<float> numbers = reals(accessor, "VEC3", Numbers::quantised);
  std::vector<Eigen::Vector3f> vectors(numbers.size() / 3);
  for (std::size_t i = 0; i < vectors.size(); ++i) vectors[i] = Eigen::Vector3f(&numbers[3 * i]);
  return vectors;
}

std::vector<std::uint32_t> GltfDocument::indices(std::size_t accessor, const std::string& type) const {
  const Json& description = element("accessors", accessor);
  const std::size_t size = index_size(integer(description, "componentType"));
  if (text(description, "type") != type || size == 0) {
    fail(fmt::format("accessor {} does not hold unsigned integers", accessor));
  }
  count(accessor);
  return unpack(packed(description, components_of(type) * size), size);
}

}  // namespace pliant
