#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/report/report.h"
#include "framework/core/registry.h"

namespace pliant {

/// RFC 4648 with padding.
std::string base64(const std::vector<std::uint8_t>& bytes);

/// One run as an HTML page that needs no other file: metrics, counts, energy, times and pictures.
std::string make_page(const ReportInput& input);
std::string make_page(const EditInput& input);

/// Adds the report `page`: index.html.
void register_page_report(Registry& registry);

}  // namespace pliant
