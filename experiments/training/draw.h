#pragma once

#include <cstddef>
#include <cstdint>
#include <random>

namespace pliant {

/// Random numbers. The same seed gives the same ones on every standard library, whose generators, unlike
/// their distributions, are fixed by the C++ standard.
class Draw {
 public:
  /// `stream`: others of the same seed are independent of it.
  Draw(std::uint64_t seed, std::uint64_t stream);

  double uniform(double lowest, double highest);
  /// Of mean 0 and standard deviation 1.
  double normal();
  /// One of 0 .. count - 1.
  std::size_t index(std::size_t count);
  bool chance(double probability) { return uniform(0, 1) < probability; }

 private:
  std::mt19937_64 generator_;
};

}  // namespace pliant
