#include "benchmarks/sheet.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "framework/geometry/point_set.h"

namespace pliant::bench {
namespace {

constexpr double width = 420, height = 300, distance = 800, bend = 20;
constexpr int nearest_nodes = 4;

Eigen::Vector3f at(double s, double t) {
  return {static_cast<float>((s - 0.5) * width), static_cast<float>((t - 0.5) * height), distance};
}

/// Where the bent sheet has the point (s, t): a wave along each side, and what it takes in along the sheet.
Eigen::Vector3f bent(double s, double t) {
  constexpr double pi = std::numbers::pi;
  const Eigen::Vector3d moved(-0.1 * bend * std::sin(2 * pi * s), 0.05 * bend * std::sin(2 * pi * t),
                              -bend * std::sin(pi * s) * std::cos(pi * (t - 0.5)));
  return at(s, t) + moved.cast<float>();
}

}  // namespace

std::unique_ptr<Problem> make_sheet(const SheetSize& size, const Registry& registry, Device& device) {
  const int side = static_cast<int>(std::lround(std::sqrt(size.nodes)));
  std::vector<Eigen::Vector3f> nodes;
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column)
      nodes.push_back(at((column + 0.5) / side, (row + 0.5) / side));

  auto constraints = std::make_shared<Constraints>();
  std::vector<Eigen::Vector3f> points;
  std::vector<float> data;
  for (int i = 1; i <= size.constraints; ++i) {
    // The sequence of the plastic number covers the square evenly for any count.
    const double s = std::fmod(0.7548776662466927 * i, 1.0), t = std::fmod(0.5698402909980532 * i, 1.0);
    points.push_back(at(s, t));
    const Eigen::Vector3f wish = bent(s, t) - points.back();
    data.insert(data.end(), {wish.x(), wish.y(), wish.z(), 0, 0, -1});
  }
  constraints->points = flatten(points);
  constraints->data = Array<float>(std::move(data));
  constraints->confidence = Array<float>(std::vector<float>(points.size(), 1.0F));
  constraints->influences = compute_influences(device, constraints->points, nodes, nearest_nodes);
  auto edges = find_edges(constraints->influences, size.nodes);

  std::vector<Term> terms;
  for (const char* name : {"rotation", "regularization", "constraint"}) {
    const auto energy = registry.make<Energy>(with_defaults(registry, "energy", name));
    terms.push_back({*energy, energy->stencil == Stencil::per_constraint ? constraints : nullptr});
  }
  return std::make_unique<Problem>(DeformationGraph{std::move(nodes), std::move(edges)}, std::move(terms),
                                   size.length_unit);
}

Parameters with_defaults(const Registry& registry, const std::string& kind, const std::string& name,
                         const std::vector<Parameters::Value>& given) {
  const auto* info = registry.find(kind, name);
  if (info == nullptr) throw std::logic_error("no " + kind + " " + name);
  std::vector<Parameters::Value> values;
  for (const auto& row : info->parameters.rows()) {
    const auto found = std::find_if(given.begin(), given.end(),
                                    [&](const Parameters::Value& value) { return value.name == row.name(); });
    if (found != given.end()) {
      values.push_back(*found);
      continue;
    }
    if (!row.default_text()) continue;  // optional, and not given
    const std::string& text = *row.default_text();
    if (row.type() == ParameterType::integer)
      values.push_back({row.name(), static_cast<std::int64_t>(std::stoll(text))});
    else if (row.type() == ParameterType::real)
      values.push_back({row.name(), std::stod(text)});
    else if (row.type() == ParameterType::component)
      values.push_back(
          {row.name(), Parameters::Sections{{text, with_defaults(registry, row.kind(), text)}}, true});
    else
      values.push_back({row.name(), text});
  }
  return {name, std::move(values)};
}

}  // namespace pliant::bench
