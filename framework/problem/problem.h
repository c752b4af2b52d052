#pragma once

#include <memory>
#include <vector>

#include "framework/deformation/graph.h"
#include "framework/deformation/node_transform.h"
#include "framework/deformation/skinning.h"
#include "framework/device/array.h"
#include "framework/problem/energy.h"

namespace pliant {

/// Points of the source that are asked to go somewhere [Eq. 4.5]. How they hang on the graph is fixed;
/// what they are asked for (`data`, `confidence`) may change between solves.
struct Constraints {
  Array<float> points;      ///< x y z of each constrained point p at rest, mm
  Influences influences;    ///< of each constrained point
  Array<float> data;        ///< 6 per constraint: q - p, then the target's unit normal at q
  Array<float> confidence;  ///< 0 (inactive) or above; factor of the squared residual

  std::size_t size() const { return points.size() / 3; }
};

/// An energy and what it applies to.
struct Term {
  Energy energy;
  std::shared_ptr<Constraints> constraints;  ///< for per_constraint energies, else null
};

/// Minimise E_tot [Eq. 4.6] over the affine forms of a deformation graph's nodes, those that `transform` lets
/// them take. It does not matter where the graph and the constraints come from: depth maps, meshes, handles
/// moved by hand.
class Problem {
 public:
  /// Starts at the identity. `length_unit`: millimetres per unit of length in which the energies are
  /// measured: 1 for the thesis's balance of weights, 1000 for metres.
  /// Throws DataError for an edge or an influence that names a node that is not there or the same node
  /// twice, for sizes that do not fit together, and for weights and units that are not numbers to measure
  /// with.
  Problem(DeformationGraph graph, std::vector<Term> terms, double length_unit = 1,
          NodeTransform transform = {});

  const DeformationGraph& graph() const { return graph_; }
  const std::vector<Term>& terms() const { return terms_; }
  int node_count() const { return static_cast<int>(graph_.nodes.size()); }
  const NodeTransform& transform() const { return transform_; }
  /// Free numbers of all nodes together: 12 a node, or 6 of `quaternion` (7 numbers with one condition).
  int unknown_count() const { return transform_.unknowns * node_count(); }

  /// x y z of each node, mm.
  const Array<float>& node_points() const { return node_points_; }

  /// The affine forms, affine_size numbers a node whatever the transform: the start of a solve, and
  /// afterwards its solution. A solve that starts from forms which are not of the transform (carry_over
  /// blends, a caller may write anything) begins at the nearest ones that are.
  Array<float>& unknowns() { return unknowns_; }
  const Array<float>& unknowns() const { return unknowns_; }
  void reset_to_identity();

  /// How much a term counts, and the scale of its loss (unit of its residual), may change between solves:
  /// bound solvers take them as they are at each solve. A weight of 0 leaves the term out until it is raised
  /// again. Throws DataError for a weight that is not 0 or above and a scale that is not above 0.
  void set_weight(std::size_t term, double weight);
  void set_loss_scale(std::size_t term, double scale);

  /// The term's weight in the chosen unit of length.
  double effective_weight(const Term& term) const;

  /// E_tot at `unknowns`, in double on the host: the reference that all solvers are measured by.
  double energy(const std::vector<double>& unknowns) const;
  double energy() const;

 private:
  DeformationGraph graph_;
  std::vector<Term> terms_;
  double length_unit_;
  NodeTransform transform_;
  Array<float> node_points_;
  Array<float> unknowns_;
};

/// How many instances a term has in a problem: nodes, edges or constraints.
std::size_t instance_count(const Problem& problem, const Term& term);

/// The nodes whose unknowns `instance` of a term depends on.
std::vector<int> coupled_nodes(const Problem& problem, const Term& term, std::size_t instance);

/// Gathers u and data of instance `index` of a term (see Stencil) from unknowns in double.
void gather_instance(const Problem& problem, const Term& term, std::size_t index, const double* unknowns,
                     double* u, double* data);

}  // namespace pliant
