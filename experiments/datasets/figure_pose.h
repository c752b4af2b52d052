#pragma once

#include <string>
#include <vector>

#include "experiments/modeller/figure.h"
#include "experiments/modeller/pose.h"

namespace pliant {

/// What words "name=value" ask for, added up: so much of a named pose (smile=1), the weight of a morph target
/// (jawOpen=0.5), or an angle of a joint in degrees (index_1.x=40). Throws ConfigError that begins with
/// `place`, as in "a.yaml:3:5: 'target'", for what is no such word, for a name that the figure does not have
/// (the nearest is named) and for one that is given twice.
FigurePose read_pose(const Figure& figure, const std::vector<std::string>& words, const std::string& place);

/// The words as a reader is told of them.
std::string name_of_pose(const std::vector<std::string>& words);

/// `share` of the way from one pose to another.
FigurePose between(const FigurePose& from, const FigurePose& to, double share);

}  // namespace pliant
