#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "framework/io/text_lines.h"

namespace pliant {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::size_t size_of(PlyType type);
bool is_integer(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;         ///< of a list: of its entries
  std::optional<PlyType> count_type = {};  ///< of a list: how its length is written
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;  ///< at least one

  /// Where a property is; none when there is none of that name.
  std::optional<std::size_t> find(const std::string& property) const;
};

struct PlyHeader {
  enum class Format { ascii, little_endian, big_endian };
  Format format = Format::ascii;
  std::vector<PlyElement> elements;  ///< in the order of their data
};

/// Reads from the first line to `end_header`. Throws DataError with file and line when it is none.
PlyHeader read_ply_header(TextLines& lines);

}  // namespace pliant
