#pragma once

#include <string>
#include <vector>

#include "experiments/datasets/mesh_scene.h"
#include "framework/core/parameters.h"

namespace pliant {

/// A table of `rows`, followed by those that say how a figure moves and is seen.
ParameterTable scene_table(std::vector<Parameter> rows);

/// The scene that a section of such a table describes. `what`: as errors name the figure; `title`: as the
/// stream's name begins; `base`: a pose beneath all others. Throws ConfigError for words that are no pose of
/// the figure, keys that are not in the order of time, and both keys and a source
/// or target.
MeshScene read_scene(const Parameters& section, const Figure& figure, FigurePose base,
                     const std::string& what, const std::string& title);

}  // namespace pliant
