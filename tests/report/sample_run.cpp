#include "tests/report/sample_run.h"

#include <gtest/gtest.h>

#include "experiments/report/reports.h"

namespace pliant {
namespace {

std::vector<Eigen::Vector3f> moved(std::vector<Eigen::Vector3f> points, float z) {
  for (Eigen::Vector3f& point : points) point.z() += z;
  return points;
}

}  // namespace

SampleRun::SampleRun(float left) {
  pair.name = "planes & more";
  pair.camera = {50, 50, 19.5, 14.5, 40, 30};
  pair.source.depth = DepthImage(40, 30, 800);
  for (int v = 0; v < 30; ++v) pair.source.depth(10, v) = 0;
  pair.target.depth = DepthImage(40, 30, target_depth);
  const PairTruth truth{Image<Eigen::Vector3f>(40, 30, Eigen::Vector3f(0, 0, target_depth - 800))};
  target = make_surface_image(pair.target, pair.camera);
  RegistrationResult& result = run.result;
  result.source = make_surface(make_surface_image(pair.source, pair.camera), {});
  result.aligned_points = moved(result.source.points, 10);
  result.points = moved(result.source.points, target_depth - 800 - left);
  result.normals = result.source.normals;
  result.alignment.motion = Eigen::Translation3d(0, 0, 10);
  result.alignment.matches = 123;
  result.alignment.inliers = 87;
  result.counts = {static_cast<int>(result.source.size()), 256, 1534, 2002, 3072, 14, 51};
  result.energy = {81234.5, 1021.25, {5000, 1021.25}};
  result.solver = {"gauss_newton", "cholesky", "converged"};
  result.termination = "residual_settled";
  result.time_ms = {{"solve", 90.25}, {"match", 12.5}};
  result.total_ms = 110.75;
  const Evaluation evaluation(pair, truth, result.source, target);
  nearest = {evaluation.nearest(result.source.points), evaluation.nearest(result.aligned_points),
             evaluation.nearest(result.points)};
  run.name = "sheet/<fast>";
  run.initial = evaluation.measure(result.source.points);
  run.aligned = evaluation.measure(result.aligned_points);
  run.metrics = evaluation.measure(result.points);
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
