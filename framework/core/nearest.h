#pragma once

#include <string>
#include <vector>

namespace pliant {

/// The choice that `word` was most likely meant to be: the one with the fewest letters inserted, left out,
/// replaced or swapped (letter case aside; the first one on a tie). Empty when none is near.
std::string nearest(const std::string& word, const std::vector<std::string>& choices);

/// "; did you mean 'x'?", or nothing when no choice is near.
std::string suggestion(const std::string& word, const std::vector<std::string>& choices);

}  // namespace pliant
