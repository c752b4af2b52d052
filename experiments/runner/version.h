#pragma once

#include <string>
#include <utility>
#include <vector>

namespace pliant {

std::string version();  ///< of the project, e.g. "0.1.0"
std::string commit();   ///< that was built, "-dirty" with changes, "unknown" without git
std::string build();    ///< both, and what of a dirty commit's changes git tells as a hash

/// Names and versions of the libraries that results depend on.
std::vector<std::pair<std::string, std::string>> libraries();

}  // namespace pliant
