#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pliant {

/// Puts a binary glTF 2.0 file together: what its JSON says, and the numbers that it names as accessors.
class GlbWriter {
 public:
  nlohmann::ordered_json json = {{"asset", {{"version", "2.0"}, {"generator", "Pliant"}}}};

  // Each gives the number of a new accessor; none takes an empty list.
  std::size_t add_positions(const std::vector<Eigen::Vector3f>& positions);
  std::size_t add_triangles(const std::vector<Eigen::Vector3i>& triangles);
  std::size_t add_scalars(const std::vector<float>& values);

  /// Throws DataError naming the file when it cannot be written.
  void write(const std::string& path) const;

 private:
  nlohmann::ordered_json& add_accessor(std::size_t bytes, int component_type, std::size_t count,
                                       const char* type);

  std::vector<std::uint8_t> binary_;
  nlohmann::ordered_json views_ = nlohmann::ordered_json::array();
  nlohmann::ordered_json accessors_ = nlohmann::ordered_json::array();
};

}  // namespace pliant
