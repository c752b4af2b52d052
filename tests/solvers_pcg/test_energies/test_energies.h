#pragma once

#include "framework/problem/energy.h"

namespace pliant::test {

Energy to_plane();      ///< per constraint, couples the axes
Energy moves_as_far();  ///< the same, and not linear
Energy keeps_length();  ///< per edge, couples the axes
Energy stays();         ///< per node, separates

}  // namespace pliant::test
