#pragma once

#include <cstddef>
#include <functional>

namespace pliant {

/// Calls `work` with 0 .. count - 1, on all processors at once, and waits. What work throws first is thrown.
void on_all_processors(std::size_t count, const std::function<void(std::size_t)>& work);

}  // namespace pliant
