#pragma once

#include <string>

namespace pliant {

/// Makes every experiment that comes with the program, in a short form when `quick`, into `out` (empty:
/// out/reproduce below the current folder), and one page that leads to all of them. An experiment whose data
/// is not found is skipped, and says so. Throws what the first one that fails throws.
void reproduce_command(bool quick, const std::string& out, const std::string& data);

}  // namespace pliant
