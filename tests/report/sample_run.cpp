#include "tests/report/sample_run.h"

#include <gtest/gtest.h>

#include "experiments/report/heat_map.h"
#include "experiments/report/reports.h"

namespace pliant {
namespace {

Surface plane() {
  Frame frame;
  frame.depth = DepthImage(40, 30, 800);
  for (int v = 0; v < 30; ++v) frame.depth(10, v) = 0;
  return make_surface(make_surface_image(frame, {50, 50, 19.5, 14.5, 40, 30}), {});
}

}  // namespace

RunArtefacts sample_run() {
  RunArtefacts run;
  run.name = "sheet/<fast>";
  run.lead = "Registration of planes & more";
  run.notes = {"ended <well>", "warning: dark & noisy"};
  run.tables = {
      {"Distances & more", {"", "before", "after"}, {{{"residual", "30.00 ± 2.00", "4.00"}}}, 2},
      {"Counts", {}, {{{"Nodes", "256"}}}},
      {"Time in ms", {}, {{{"solve", "90.25"}}, {{"match", "45.12"}}, {{"total", "110.75"}}}, {}, {8, 4}}};
  run.series = {{"Energy", "outer iteration", "energy", {1000, 10, 1, 5}, "From 1000 to 5."}};
  run.pictures = {{"depth", "Depth & more",
                   [] { return draw_heat_map(Image<float>(40, 30, 1), {}, "title", "subtitle"); }}};
  NamedSurface moved{"moved", plane(), {}, {}, plane().points};
  for (Eigen::Vector3f& point : moved.surface.points) point.z() += 26;
  moved.errors.assign(moved.surface.size(), 4);
  moved.matched.assign(moved.surface.size(), 1);
  moved.matched[3] = 0;
  run.surfaces = {{"rest", plane(), std::vector<float>(plane().size(), 30)}, moved};
  return run;
}

std::filesystem::path test_folder() {
  const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) /
                                       (std::string("pliant_") + test.test_suite_name() + "_" + test.name());
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

std::unique_ptr<Report> make_report(const std::string& name) {
  Registry registry;
  register_reports(registry);
  std::vector<Parameters::Value> values;
  if (name == "surfaces") values.push_back({"depth_step", 20.0});
  return registry.make<Report>(Parameters(name, values));
}

}  // namespace pliant
