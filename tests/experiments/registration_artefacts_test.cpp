#include "experiments/tasks/registration_artefacts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>
#include <opencv2/imgcodecs.hpp>
#include <tuple>

#include "experiments/report/page.h"

namespace pliant {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

std::vector<Eigen::Vector3f> moved(std::vector<Eigen::Vector3f> points, float z) {
  for (Eigen::Vector3f& point : points) point.z() += z;
  return points;
}

/// A plane at 800 mm registered to one at 830 by moving it straight there but for `left` mm. 40 x 30 pixels;
/// the column 10 has no source depth and no colour is known.
struct SampleRun {
  explicit SampleRun(float left);
  RunArtefacts artefacts() const {
    const SurfaceImage target = make_surface_image(pair.target, pair.camera);
    const Evaluation evaluation(pair, truth, result.source, target);
    const Measured measured = measure(evaluation, result, [](const Progress&) {});
    return registration_artefacts(run, pair, target, result, measured, growth, timing);
  }
  std::vector<Picture> pictures() const { return artefacts().pictures; }

  static constexpr float target_depth = 830;
  ExperimentRun run{"sheet/<fast>", {}, "sheet.yaml"};
  FramePair pair;
  std::optional<PairTruth> truth;
  RegistrationResult result;
  GraphGrowth growth;
  Timing timing{1, 110.75, {{"solve", 90.25}, {"match", 12.5}}, 110.75, 110.75, false};
};

SampleRun::SampleRun(float left) {
  pair.name = "planes & more";
  pair.camera = {50, 50, 19.5, 14.5, 40, 30};
  pair.source.depth = DepthImage(40, 30, 800);
  for (int v = 0; v < 30; ++v) pair.source.depth(10, v) = 0;
  pair.target.depth = DepthImage(40, 30, target_depth);
  truth = PairTruth{Image<Eigen::Vector3f>(40, 30, Eigen::Vector3f(0, 0, target_depth - 800))};
  result.source = make_surface(make_surface_image(pair.source, pair.camera), {});
  result.aligned_points = moved(result.source.points, 10);
  result.points = moved(result.source.points, target_depth - 800 - left);
  result.normals = result.source.normals;
  result.matched.assign(result.source.size(), 1);
  result.alignment.motion = Eigen::Translation3d(0, 0, 10);
  result.alignment.matches = 123;
  result.alignment.inliers = 87;
  result.counts = {static_cast<int>(result.source.size()), 256, 1534, 2002, 3072, 14, 51};
  result.energy = {81234.5, 1021.25, {5000, 1021.25}};
  result.history = {{20, 20.5, 1170}, {4, 4.5, 1170}};
  result.returned_iteration = 1;
  result.solver = {"gauss_newton", "cholesky", "converged"};
  result.termination = "residual_settled";
}

const Picture& find(const std::vector<Picture>& pictures, const std::string& name) {
  for (const Picture& picture : pictures) {
    if (picture.name() == name) return picture;
  }
  throw std::out_of_range(name);
}

/// The brightness of the pixel (u, v) of the source, where pictures are enlarged twelvefold.
int brightness(const Picture& picture, int u, int v) {
  const cv::Mat image = cv::imdecode(picture.png(), cv::IMREAD_COLOR);
  const int scale = 12;
  const cv::Vec3b color = image.at<cv::Vec3b>(72 + scale * v + scale / 2, 20 + scale * u + scale / 2);
  return color[0] + color[1] + color[2];
}

TEST(Pictures, HaveOneSizeButForTheGraph) {
  const std::vector<Picture> pictures = SampleRun(4).pictures();
  std::vector<std::string> names;
  std::vector<cv::Size> sizes;
  for (const Picture& picture : pictures) {
    names.push_back(picture.name());
    sizes.push_back(cv::imdecode(picture.png(), cv::IMREAD_COLOR).size());
  }
  EXPECT_THAT(names, ElementsAre("depth_source", "depth_target", "error_initial", "error_aligned",
                                 "error_final", "graph"));
  EXPECT_GT(sizes[0].area(), 480 * 360);
  for (std::size_t i = 0; i + 1 < sizes.size(); ++i) EXPECT_EQ(sizes[i], sizes[0]) << names[i];
  EXPECT_EQ(sizes.back().height, 72 + 48 * 17 + 20);
}

TEST(Pictures, ErrorsFallOnOneScale) {
  const std::vector<Picture> pictures = SampleRun(4).pictures();
  const int initial = brightness(find(pictures, "error_initial"), 20, 15);
  const int aligned = brightness(find(pictures, "error_aligned"), 20, 15);
  const int final = brightness(find(pictures, "error_final"), 20, 15);
  EXPECT_GT(initial, aligned);
  EXPECT_GT(aligned, final);
}

TEST(Pictures, ChangeWithTheError) {
  const std::vector<Picture> better = SampleRun(2).pictures();
  const std::vector<Picture> worse = SampleRun(9).pictures();
  EXPECT_LT(brightness(find(better, "error_final"), 20, 15), brightness(find(worse, "error_final"), 20, 15));
  EXPECT_EQ(find(better, "error_initial").png(), find(worse, "error_initial").png());
}

TEST(Pictures, ShowThePixelsOfTheSource) {
  const std::vector<Picture> pictures = SampleRun(4).pictures();
  const Picture& final = find(pictures, "error_final");
  EXPECT_NE(brightness(final, 10, 15), brightness(final, 9, 15));  // the empty column
  EXPECT_NE(brightness(final, 10, 15), brightness(final, 11, 15));
}

TEST(Pictures, TheSourceIsNearerThanTheTarget) {
  const std::vector<Picture> pictures = SampleRun(4).pictures();
  EXPECT_LT(brightness(find(pictures, "depth_source"), 20, 15),
            brightness(find(pictures, "depth_target"), 20, 15));
}

TEST(Pictures, OmitTheAlignmentThatMovedNothing) {
  SampleRun sample(4);
  sample.result.aligned_points = sample.result.source.points;
  for (const Picture& picture : sample.pictures()) EXPECT_NE(picture.name(), "error_aligned");
}

TEST(Pictures, PerfectRegistrationHasAScaleToo) {
  SampleRun sample(0);
  sample.result.aligned_points = sample.result.points;
  EXPECT_EQ(sample.pictures().size(), 6u);
}

/// The colour of a place in pixels of the source: the graph's picture is the square of 48 pixels around it,
/// enlarged seventeenfold.
cv::Vec3b color_at(const Picture& picture, double u, double v) {
  const cv::Mat image = cv::imdecode(picture.png(), cv::IMREAD_COLOR);
  return image.at<cv::Vec3b>(72 + static_cast<int>(17 * (v + 9)), 20 + static_cast<int>(17 * (u + 4)));
}

bool is_grey(const cv::Vec3b& color) { return color[0] == color[1] && color[1] == color[2]; }

TEST(Pictures, ShowTheCellsOfTheGraphByLevelAndCrossVirtualOnesOut) {
  SampleRun sample(4);
  sample.result.graph_cells = {
      {12, 4, 20, 12, 2, false}, {20, 4, 28, 12, 2, true}, {12, 12, 16, 16, 3, false}};
  const Picture graph = find(sample.pictures(), "graph");
  const cv::Vec3b second = color_at(graph, 14, 7);
  EXPECT_TRUE(is_grey(color_at(graph, 30, 20)));
  EXPECT_FALSE(is_grey(second));
  EXPECT_EQ(color_at(graph, 22, 7), second);
  EXPECT_NE(color_at(graph, 13, 14), second);
  EXPECT_EQ(color_at(graph, 16, 8), second);  // no cross where there is a node
  EXPECT_NE(color_at(graph, 24, 8), second);
}

TEST(Pictures, ShowTheNodesOfTheGraphWhereTheSourceWasGiven) {
  SampleRun sample(4);
  const std::size_t point = 500;
  const Eigen::Vector2i pixel = sample.result.source.pixels[point];
  const auto color_there = [&] {
    return color_at(find(sample.pictures(), "graph"), pixel.x() + 0.5, pixel.y() + 0.5);
  };
  const cv::Vec3b without = color_there();
  sample.result.node_positions = {sample.result.aligned_points[point]};
  EXPECT_NE(color_there(), without);
}

TEST(Registration, TellsItsNumbers) {
  const RunArtefacts made = SampleRun(4).artefacts();
  const std::string page = make_page(made);
  for (const char* text :
       {"1534", "2002", "3072", "gauss_newton", "cholesky", "converged", "residual_settled",
        "87 of 123 agree", "10.0 mm", "From 81234.5 to 1021.25", "solve", "90.25", "12.50", "110.75",
        "100.0 %", "The result is that of iteration 1."})
    EXPECT_THAT(page, HasSubstr(text));
  // EPE: 30 mm at first, 20 after the alignment, 4 at the end.
  EXPECT_THAT(page, HasSubstr("<td>30.00</td><td>20.00</td><td class=\"final\">4.00</td>"));
  const auto& cells = made.summary.rows.at(0).cells;
  EXPECT_THAT(cells, ElementsAre("sheet/<fast>", "1534", "3072", "51", "31.22 -> 8.37", "30.90 -> 8.21",
                                 "30.00 -> 4.00", "111"));
  EXPECT_EQ(made.failure, "");
}

TEST(Registration, OmitsTruthThatIsNotKnown) {
  SampleRun sample(4);
  EXPECT_THAT(make_page(sample.artefacts()), HasSubstr(">EPE"));
  sample.truth.reset();
  const RunArtefacts made = sample.artefacts();
  EXPECT_THAT(make_page(made), Not(HasSubstr(">EPE")));
  EXPECT_EQ(made.summary.rows.at(0).cells.at(6), "unknown");
}

TEST(Registration, TellsEnergyAndResidualStepByStep) {
  const RunArtefacts made = SampleRun(4).artefacts();
  ASSERT_EQ(made.series.size(), 2U);
  EXPECT_THAT(made.series[0].values, ElementsAre(81234.5, 5000, 1021.25));
  EXPECT_THAT(made.series[1].values, ElementsAre(20.5, 4.5));
}

TEST(Registration, NotesHowItEndedWarningsAndTheBuildingOfKernels) {
  SampleRun sample(4);
  sample.result.warnings = {"dark"};
  sample.timing.built_kernels = true;
  EXPECT_THAT(sample.artefacts().notes, ElementsAre(HasSubstr("residual_settled after 51 outer iterations"),
                                                    "warning: dark", HasSubstr("building kernels")));
}

TEST(Registration, ThatFailedSaysWhereItCameFromAndWhatItGives) {
  SampleRun sample(4);
  sample.result.termination = "failed";
  sample.result.reason = "nothing finite";
  EXPECT_EQ(sample.artefacts().failure, "sheet.yaml: nothing finite; the result is that of iteration 1");
}

TEST(Registration, GivesTheSurfacesWithTheDistancesThatAreShown) {
  const RunArtefacts made = SampleRun(4).artefacts();
  ASSERT_EQ(made.surfaces.size(), 3U);
  const auto& [source, target, registered] = std::tie(made.surfaces[0], made.surfaces[1], made.surfaces[2]);
  EXPECT_EQ(source.name + " " + target.name + " " + registered.name, "source target registered");
  EXPECT_EQ(source.surface.points[0].z(), 800);
  EXPECT_EQ(registered.surface.points[0].z(), 826);
  EXPECT_EQ(registered.rest, source.surface.points);
  const auto mean = [](const std::vector<float>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  };
  EXPECT_NEAR(mean(source.errors), made.json["initial"]["nearest_mean"], 1e-4);
  EXPECT_NEAR(mean(registered.errors), made.json["metrics"]["nearest_mean"], 1e-4);
  EXPECT_EQ(target.errors, std::vector<float>(40 * 30, 0));
  EXPECT_EQ(registered.matched.size(), source.surface.size());
}

TEST(RegistrationArtefacts, ShowHowGraphAndConstraintsGrewWhereTheyDid) {
  const auto titles = [](const SampleRun& run) {
    std::vector<std::string> titles;
    for (const Series& series : run.artefacts().series) titles.push_back(series.title);
    return titles;
  };
  SampleRun run(0);
  run.growth = {{48, 48, 48}, {130, 130, 130}};
  EXPECT_THAT(titles(run), Not(::testing::Contains("Graph")));
  run.growth = {{48, 48, 96}, {130, 130, 130}};
  EXPECT_THAT(titles(run), ::testing::Contains("Graph"));
  EXPECT_THAT(titles(run), Not(::testing::Contains("Constraints")));
  run.growth = {{48, 48, 96}, {130, 130, 700}};
  EXPECT_EQ(run.artefacts().series.back().values, (std::vector<double>{130, 130, 700}));
}

}  // namespace
}  // namespace pliant
