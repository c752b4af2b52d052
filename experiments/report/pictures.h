#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/report/report.h"
#include "framework/core/registry.h"

namespace pliant {

/// A picture ready to be written or embedded.
struct Picture {
  std::string file;  ///< e.g. "depth_source.png"
  std::string caption;
  std::vector<std::uint8_t> png;
};

/// Depth of source and target, and per source pixel the distance to the nearest target point before
/// anything, after the initial alignment (only where that moved the source) and at the end; depths share
/// one colour scale, errors another, in mm. Last the deformation graph as it was in the end.
std::vector<Picture> draw_pictures(const ReportInput& input);
/// Depth of the source and of the bent surface as the same camera would see it, how far each point went, and
/// the deformation graph.
std::vector<Picture> draw_pictures(const EditInput& input);

/// Adds the report `pictures`: what draw_pictures gives, as PNG files.
void register_pictures_report(Registry& registry);

}  // namespace pliant
