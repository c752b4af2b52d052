#pragma once

#include <string>

namespace pliant {

/// Prints the path of the page of a result, made if there is none, and with `open` hands it to the desktop.
/// Throws DataError when the folder holds no result, or when nothing can open the page.
void view_command(const std::string& folder, bool open);

}  // namespace pliant
