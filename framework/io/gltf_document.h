#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace pliant {

/// The JSON and the buffers of a glTF 2.0 file, with access that trusts neither: whatever is missing, of the
/// wrong type or out of bounds throws DataError naming the file.
class GltfDocument {
 public:
  using Json = nlohmann::json;

  /// What the numbers of an accessor may be, besides floats.
  enum class Numbers {
    floats,      ///< nothing
    normalised,  ///< integers of 8 or 16 bits that stand for -1 to 1 or 0 to 1
    quantised    ///< those, and integers as they are, where the file needs KHR_mesh_quantization
  };

  /// Takes the file apart. Buffers in files of their own are named relative to `path`.
  GltfDocument(const std::vector<std::uint8_t>& bytes, std::string path);

  const Json& root() const { return root_; }

  // Members of a JSON object. `find` gives null when the key is absent; the others want it, unless there is
  // a fallback.
  const Json* find(const Json& object, const char* key) const;
  const Json& at(const Json& object, const char* key) const;
  std::size_t integer(const Json& object, const char* key,
                      std::optional<std::size_t> fallback = std::nullopt) const;
  std::string text(const Json& object, const char* key) const;
  /// The list under a key; empty when the key is absent.
  const std::vector<Json>& list(const Json& object, const char* key) const;
  /// A list of exactly `count` finite numbers; none when the key is absent.
  std::optional<std::vector<double>> numbers(const Json& object, const char* key, std::size_t count) const;
  /// A JSON value as an index.
  std::size_t index(const Json& value, const char* what) const;
  /// Element `index` of a list at the top level, e.g. "nodes".
  const Json& element(const char* list, std::size_t index) const;

  /// Number of elements of an accessor; no more than the file and its buffers have bytes.
  std::size_t count(std::size_t accessor) const;
  /// The elements of an accessor of `type`, as "VEC3" or "MAT4", one after the other, sparse ones put in
  /// place.
  std::vector<float> reals(std::size_t accessor, const std::string& type, Numbers allowed) const;
  /// The elements of an accessor of vectors of three, in the file's unit.
  std::vector<Eigen::Vector3f> vectors(std::size_t accessor) const;
  /// The elements of an accessor of unsigned integers of 8, 16 or 32 bits, likewise.
  std::vector<std::uint32_t> indices(std::size_t accessor, const std::string& type = "SCALAR") const;

  [[noreturn]] void fail(const std::string& what) const;

 private:
  void check_support();
  void load_buffers();
  bool is_normalised(const Json& accessor) const;
  void check_type(std::size_t accessor, const std::string& type, Numbers allowed) const;
  std::vector<std::uint8_t> packed(const Json& accessor, std::size_t element_size) const;
  void put_sparse(const Json& sparse, std::size_t element_size, std::vector<std::uint8_t>& bytes) const;
  std::vector<std::uint8_t> copy(const Json& owner, std::size_t count, std::size_t element_size) const;

  std::string path_;
  Json root_;
  std::vector<std::uint8_t> binary_;
  std::map<std::string, std::vector<std::uint8_t>> resolved_;  // by URI: several buffers may name one file
  std::size_t total_size_;                                     // of all that was read
  bool is_quantised_ = false;
};

}  // namespace pliant
