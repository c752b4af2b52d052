#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numeric>

#include "benchmarks/bench.h"
#include "experiments/program/folders.h"
#include "experiments/training/head_sitter.h"
#include "experiments/training/head_trial.h"
#include "framework/io/gltf.h"
#include "framework/pose/head_relocalizer.h"

namespace pliant::bench {
namespace {

using nlohmann::ordered_json;

// None is that of the training.
constexpr std::uint64_t seeds[] = {20261126, 20261127};

ordered_json row_of(const std::string& name, std::uint64_t seed, const HeadTrial& trial) {
  ordered_json row{{"name", name}, {"seed", seed}, {"views", trial.views}, {"found", trial.found}};
  const auto add = [&](const std::string& what, const std::vector<double>& values) {
    const MeanAndMost summary = mean_and_most(values);
    row[what] = {{"mean", summary.mean}, {"most", summary.most}};
  };
  add("position_mm", trial.position);
  for (const auto& [what, axis] : {std::pair{"yaw_degree", 0}, {"pitch_degree", 1}, {"roll_degree", 2}}) {
    std::vector<double> values;
    for (const Eigen::Vector3d& angles : trial.angles) values.push_back(angles[axis]);
    add(what, values);
  }
  add("rotation_degree", trial.rotation);
  const double total = std::accumulate(trial.milliseconds.begin(), trial.milliseconds.end(), 0.0);
  row["per_second"] = 1000 * trial.views / total;
  row["least_ms"] = *std::min_element(trial.milliseconds.begin(), trial.milliseconds.end());
  return row;
}

void print_row(const ordered_json& row) {
  fmt::print("{:<32} seed {}: {} of {} found", row["name"].get<std::string>(),
             row["seed"].get<std::uint64_t>(), row["found"].get<int>(), row["views"].get<int>());
  if (row.contains("position_mm")) {
    fmt::print("; mean (95 % below):");
    for (const char* what : {"position_mm", "yaw_degree", "pitch_degree", "roll_degree", "rotation_degree"})
      fmt::print(" {} {:.2f} ({:.2f})", what, row[what]["mean"].get<double>(),
                 row[what]["most"].get<double>());
    fmt::print("; {:.0f} a second", row["per_second"].get<double>());
  }
  fmt::print("\n");
  std::fflush(stdout);  // who waits sees each as it comes
}

/// Heads of a file, their middle about where that of our heads is.
Figure figure_of(const std::string& file) {
  Figure figure{read_gltf(file), {}};
  Eigen::AlignedBox3f box;
  for (const auto& vertex : figure.mesh.vertices) box.extend(vertex);
  const Eigen::Vector3f middle(box.center().x(), box.min().y() + 160, box.max().z() - 105);
  for (auto& vertex : figure.mesh.vertices) vertex -= middle;
  return figure;
}

/// How often a head is found where there is none.
ordered_json measure_no_heads(const std::string& name, const HeadForest& forest, int views,
                              std::uint64_t seed) {
  Draw draw(seed, 0);
  std::vector<Figure> figures;
  for (const FigureKind& kind : figure_kinds())
    if (kind.name == "sheet" || kind.name == "hand" || kind.name == "bag")
      figures.push_back(random_figure(kind, draw));
  int found = 0;
  for (int i = 0; i < views; ++i) {
    const Figure& figure = figures[static_cast<std::size_t>(i) % figures.size()];
    const HeadView view = draw_figure(figure, HeadViewOptions(), draw);
    found += find_head(forest, view.depth, head_camera(), {}) ? 1 : 0;
  }
  return {{"name", name}, {"seed", seed}, {"views", views}, {"found", found}};
}

}  // namespace

int run_head_forest_mode(const Options& options) {
  const HeadForest forest = own_head_forest();
  const int views = options.quick ? 40 : 300;
  HeadViewOptions alone;
  alone.variety = 0;
  alone.company = 0;
  HeadViewOptions exact = alone;
  exact.noise = 0;
  auto rows = ordered_json::array();
  const auto asked_for = [&](const std::string& name) {
    return name.find(options.only) != std::string::npos;
  };
  const auto measure = [&](const std::string& name, const HeadViews& heads, std::uint64_t seed,
                           bool is_foreign) {
    if (!asked_for(name)) return;
    rows.push_back(row_of(name, seed, try_head_forest(forest, {}, heads, views, seed + 1, is_foreign)));
    print_row(rows.back());
  };
  for (const std::uint64_t seed : seeds) {
    const std::vector<Figure> heads = random_heads(options.quick ? 2 : 10, seed, 0);
    measure("unseen heads, exact", {heads, exact}, seed, false);
    measure("unseen heads, Kinect", {heads, alone}, seed, false);
    measure("varied, shoulders, clutter", {heads, HeadViewOptions()}, seed, false);
    const std::string scanned = "ict_face/ict_face.glb";
    if (const auto folder = find_data(data_folders(options.data), scanned))
      measure("ict_face without its mean offset", {{figure_of((*folder / scanned).string())}, alone}, seed,
              true);
    const std::string no_heads = "sheets, hands, bags";
    if (!asked_for(no_heads)) continue;
    rows.push_back(measure_no_heads(no_heads, forest, views, seed));
    print_row(rows.back());
  }
  write_json(options, rows);
  return 0;
}

}  // namespace pliant::bench
