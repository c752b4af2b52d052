#include "experiments/datasets/mesh_size.h"

#include <fmt/format.h>

namespace pliant {

bool is_odd_size(const Eigen::AlignedBox3d& box) {
  constexpr double smallest = 10;    // mm
  constexpr double largest = 10000;  // mm
  const double length = box.sizes().maxCoeff();
  return length < smallest || length > largest;
}

std::string described_size(const Eigen::AlignedBox3d& box) {
  const Eigen::Vector3d size = box.sizes();
  return fmt::format("it is {:.6g} x {:.6g} x {:.6g} mm", size.x(), size.y(), size.z());
}

std::string described_size(const Eigen::AlignedBox3d& box, double unit, const std::string& parameter) {
  return fmt::format("{}; if the file counts in another unit than {:g} mm, say which by {}",
                     described_size(box), unit, parameter);
}

}  // namespace pliant
