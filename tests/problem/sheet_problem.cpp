#include "tests/problem/sheet_problem.h"

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <random>

#include "framework/deformation/warp.h"
#include "framework/geometry/point_set.h"

namespace pliant::test {
namespace {

using Points = std::vector<Eigen::Vector3f>;

Points scatter(const Sheet& sheet, int count, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<float> x(-160, 160), y(-120, 120);
  Points points;
  for (int i = 0; i < count; ++i) {
    const float across = x(generator);
    points.emplace_back(across, y(generator), 800 + static_cast<float>(sheet.relief) * std::cos(across / 50));
  }
  return points;
}

Influences influences_of(const Points& points, const Points& nodes, int wanted) {
  const int k = std::min(wanted, static_cast<int>(nodes.size()) - 1);
  if (k > 0) return compute_influences_reference(flatten(points).host(), nodes, k);
  return {1, Array<int>(std::vector<int>(points.size(), 0)),
          Array<float>(std::vector<float>(points.size(), 1))};
}

using SurfaceMap = std::function<Eigen::Vector3f(const Eigen::Vector3f&)>;

std::shared_ptr<Constraints> constrain(const Sheet& sheet, const DeformationGraph& graph,
                                       const Points& points, const SurfaceMap& target) {
  std::vector<float> data;
  for (const auto& point : points) {
    const Eigen::Vector3f motion = target(point) - point;
    const auto slope = [&](const Eigen::Vector3f& along) {
      return Eigen::Vector3f(target(point + along) - target(point - along));
    };
    const Eigen::Vector3f normal =
        slope(Eigen::Vector3f::UnitY()).cross(slope(Eigen::Vector3f::UnitX())).normalized();
    data.insert(data.end(), motion.data(), motion.data() + 3);
    data.insert(data.end(), normal.data(), normal.data() + 3);
  }
  return std::make_shared<Constraints>(
      Constraints{flatten(points), influences_of(points, graph.nodes, sheet.per_point),
                  Array<float>(std::move(data)), Array<float>(std::vector<float>(points.size(), 1))});
}

}  // namespace

DeformationGraph make_sheet_graph(const Sheet& sheet) {
  DeformationGraph graph{scatter(sheet, sheet.nodes, 2 * sheet.seed), {}};
  const auto points = scatter(sheet, 40 * sheet.nodes, 2 * sheet.seed + 1);
  graph.edges = find_edges(influences_of(points, graph.nodes, sheet.per_point), sheet.nodes);
  return graph;
}

std::shared_ptr<Constraints> make_sheet_constraints(const Sheet& sheet, const DeformationGraph& graph) {
  const auto bend = static_cast<float>(sheet.bend);
  return constrain(sheet, graph, scatter(sheet, sheet.constraints, 1000 + sheet.seed),
                   [bend](const Eigen::Vector3f& p) {
                     const float wave = std::sin(p.x() / 60 + p.y() / 90);
                     return Eigen::Vector3f(p.x() + 0.2F * bend * wave, p.y(), p.z() - bend * wave);
                   });
}

std::shared_ptr<Constraints> make_handles(const Sheet& sheet, const DeformationGraph& graph) {
  Points points;
  for (const float x : {-150.0F, 150.0F})
    for (const float y : {-100.0F, -30.0F, 40.0F, 110.0F}) points.emplace_back(x, y, 800);
  const Eigen::AngleAxisf turn(0.5F, Eigen::Vector3f::UnitX());
  const Eigen::Vector3f lift(-20, 0, -static_cast<float>(sheet.bend));
  return constrain(sheet, graph, points, [&](const Eigen::Vector3f& p) -> Eigen::Vector3f {
    if (p.x() < 0) return p;
    const Eigen::Vector3f pivot(p.x(), 0, 800);
    return turn * (p - pivot) + pivot + lift;
  });
}

std::vector<Term> make_terms(const std::vector<Energy>& energies,
                             const std::shared_ptr<Constraints>& constraints) {
  std::vector<Term> terms;
  for (const auto& energy : energies)
    terms.push_back({energy, energy.stencil == Stencil::per_constraint ? constraints : nullptr});
  return terms;
}

Problem make_sheet_problem(const Sheet& sheet, const std::vector<Energy>& energies) {
  auto graph = make_sheet_graph(sheet);
  auto terms = make_terms(energies, make_sheet_constraints(sheet, graph));
  return Problem(std::move(graph), std::move(terms), sheet.length_unit, sheet.transform);
}

void randomise_unknowns(Problem& problem, double matrix, double translation, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  auto& unknowns = problem.unknowns().write_host();
  for (std::size_t i = 0; i < unknowns.size(); ++i)
    unknowns[i] = static_cast<float>(normal(generator) * (i % affine_size < 9 ? matrix : translation));
}

void turn_nodes(Problem& problem, double radians, double translation, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  auto& unknowns = problem.unknowns().write_host();
  for (std::size_t node = 0; node < problem.graph().nodes.size(); ++node) {
    const Eigen::Vector3d axis(normal(generator), normal(generator), normal(generator));
    const Eigen::AngleAxisd turn(radians * normal(generator), axis.normalized());
    const Eigen::Matrix3d deviation = turn.toRotationMatrix() - Eigen::Matrix3d::Identity();
    Eigen::Map<Eigen::Matrix<float, 3, 4>> form(unknowns.data() + affine_size * node);
    form.leftCols<3>() = deviation.cast<float>();
    for (int axis_index = 0; axis_index < 3; ++axis_index)
      form(axis_index, 3) = static_cast<float>(translation * normal(generator));
  }
}

double distance_from_rotations(const std::vector<float>& forms) {
  double worst = 0;
  for (std::size_t at = 0; at < forms.size(); at += affine_size) {
    const Eigen::Matrix3d R =
        Eigen::Map<const Eigen::Matrix3f>(forms.data() + at).cast<double>() + Eigen::Matrix3d::Identity();
    worst = std::max(
        {worst, (R.transpose() * R - Eigen::Matrix3d::Identity()).norm(), std::abs(R.determinant() - 1)});
  }
  return worst;
}

Constraints copy_of(const Constraints& constraints) {
  const Influences& influences = constraints.influences;
  return {constraints.points.clone(),
          {influences.per_point, influences.nodes.clone(), influences.weights.clone()},
          constraints.data.clone(),
          constraints.confidence.clone()};
}

}  // namespace pliant::test
