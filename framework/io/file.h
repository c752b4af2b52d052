#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace pliant {

/// All bytes of a file. Throws DataError naming the file when it is missing or cannot be read.
std::vector<std::uint8_t> read_file(const std::string& path);

/// Makes or replaces a file. Throws DataError naming the file unless every byte was written.
void write_file(const std::string& path, const std::vector<std::uint8_t>& bytes);

}  // namespace pliant
