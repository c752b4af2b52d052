#pragma once

#include "experiments/modeller/figure.h"

namespace pliant {

// Each figure has a file of its own.
FigureKind sheet_figure();
FigureKind hand_figure();
FigureKind head_figure();
FigureKind bag_figure();
FigureKind body_figure();
FigureKind room_figure();

}  // namespace pliant
