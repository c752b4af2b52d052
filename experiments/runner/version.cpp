#include "experiments/runner/version.h"

#include "pliant_build.h"

namespace pliant {

std::string version() { return PLIANT_VERSION; }

std::string commit() { return PLIANT_COMMIT; }

std::string build() { return version() + " " + commit() + " " + PLIANT_CHANGES; }

std::vector<std::pair<std::string, std::string>> libraries() {
  return {{"ceres", PLIANT_CERES_VERSION},
          {"eigen", PLIANT_EIGEN_VERSION},
          {"flann", PLIANT_FLANN_VERSION},
          {"opencv", PLIANT_OPENCV_VERSION},
          {"yaml-cpp", PLIANT_YAML_CPP_VERSION}};
}

}  // namespace pliant
