#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace pliant {

/// All bytes of a file. Throws DataError naming the file when it is missing or cannot be read.
std::vector<std::uint8_t> read_file(const std::string& path);

/// Makes or replaces a file: written under another name beside it and renamed at the end, so that the file is
/// the old or the new one, never a part. What is no file (a device, a pipe) is written as it is, and a link
/// is followed. Throws DataError naming the file and the reason unless every byte was written.
void write_file(const std::string& path, const std::vector<std::uint8_t>& bytes);

}  // namespace pliant
