#pragma once

#include "experiments/modeller/figure.h"

namespace pliant {

// Each figure has a file of its own.
FigureKind head_figure();
FigureKind hand_figure();

}  // namespace pliant
