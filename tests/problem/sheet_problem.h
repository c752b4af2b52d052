#pragma once

#include <memory>

#include "framework/problem/problem.h"

namespace pliant::test {

/// A sheet of 320 x 240 mm at 800 mm, nodes and constrained points scattered over it, that is asked to bend.
/// Made of its numbers alone: it knows nothing of depth maps.
struct Sheet {
  int nodes = 36;
  int constraints = 400;
  int per_point = 4;   ///< nodes that influence a constraint; fewer where there are too few nodes
  double bend = 30;    ///< mm, height of the wave that the targets follow
  double relief = 15;  ///< mm, height of the sheet's own waves at rest
  double length_unit = 1;
  unsigned seed = 1;
  NodeTransform transform = {};
};

/// Nodes, and Sumner's edges over many points of the sheet.
DeformationGraph make_sheet_graph(const Sheet& sheet);

/// Points all over the sheet with targets on the bent one.
std::shared_ptr<Constraints> make_sheet_constraints(const Sheet& sheet, const DeformationGraph& graph);

/// A few handles: the left edge is held, the right one is lifted and turned.
std::shared_ptr<Constraints> make_handles(const Sheet& sheet, const DeformationGraph& graph);

/// One term per energy, those over constraints on `constraints`.
std::vector<Term> make_terms(const std::vector<Energy>& energies,
                             const std::shared_ptr<Constraints>& constraints);

Problem make_sheet_problem(const Sheet& sheet, const std::vector<Energy>& energies);

/// Unknowns around the identity: matrices deviate by `matrix`, translations by `translation` mm (one sigma).
void randomise_unknowns(Problem& problem, double matrix, double translation, unsigned seed);

/// Unknowns that turn each node about some axis by an angle of `radians` (one sigma).
void turn_nodes(Problem& problem, double radians, double translation, unsigned seed);

/// How far the matrices of affine forms are from rotations: the largest |R^T R - I| and |det R - 1|.
double distance_from_rotations(const std::vector<float>& forms);

/// Constraints that share nothing with others.
Constraints copy_of(const Constraints& constraints);

}  // namespace pliant::test
