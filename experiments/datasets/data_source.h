#pragma once

#include <cstdint>

#include "framework/geometry/frame.h"

namespace pliant {

/// Where an experiment's frames come from.
class DataSource {
 public:
  static constexpr const char* kind = "data";
  virtual ~DataSource() = default;
  /// Deterministic for a given seed. Throws DataError naming the file at fault.
  virtual FramePair load(std::uint64_t seed) const = 0;
};

}  // namespace pliant
