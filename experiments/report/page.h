#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/report/report.h"

namespace pliant {

/// RFC 4648 with padding.
std::string base64(const std::vector<std::uint8_t>& bytes);

/// One run as an HTML page that needs no other file: tables, plots and pictures.
std::string make_page(const RunArtefacts& run);

}  // namespace pliant
