#include "experiments/modeller/figure.h"

#include "experiments/modeller/figures.h"

namespace pliant {

const std::vector<FigureKind>& figure_kinds() {
  static const std::vector<FigureKind> kinds = {sheet_figure(), hand_figure(), head_figure(),
                                                bag_figure(),   body_figure(), room_figure()};
  return kinds;
}

}  // namespace pliant
