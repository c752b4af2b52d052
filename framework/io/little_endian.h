#pragma once

#include <Eigen/Core>
#include <bit>
#include <cstdint>
#include <vector>

namespace pliant {

// Appends numbers to the bytes of a file, little-endian whatever the machine.

inline void append(std::vector<std::uint8_t>& bytes, std::uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::uint8_t>(value >> shift));
}
inline void append(std::vector<std::uint8_t>& bytes, std::int32_t value) {
  append(bytes, static_cast<std::uint32_t>(value));
}
inline void append(std::vector<std::uint8_t>& bytes, float value) {
  append(bytes, std::bit_cast<std::uint32_t>(value));
}
inline void append(std::vector<std::uint8_t>& bytes, const Eigen::Vector3f& vector) {
  for (int i = 0; i < 3; ++i) append(bytes, vector[i]);
}

}  // namespace pliant
