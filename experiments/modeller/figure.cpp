#include "experiments/modeller/figure.h"

#include "experiments/modeller/figures.h"

namespace pliant {

const std::vector<FigureKind>& figure_kinds() {
  static const std::vector<FigureKind> kinds = {head_figure(), hand_figure()};
  return kinds;
}

}  // namespace pliant
