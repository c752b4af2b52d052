#pragma once

#include <string>

namespace pliant {

/// What to reproduce.
struct ReproduceOptions {
  std::string chapter;  ///< as "chapter5"; empty: all there is
  bool quick = false;
  std::string out;   ///< empty: a folder below out/
  std::string data;  ///< where recorded data is looked for first; empty: nowhere special
};

/// Makes every experiment of a chapter, or all that come with Pliant, and one page over them, whose path is
/// told. What was finished by one that did not come to its end is taken from it. An experiment that fails
/// keeps no other from being made; the first one's error is thrown when all is written.
void reproduce_command(const ReproduceOptions& options);

}  // namespace pliant
