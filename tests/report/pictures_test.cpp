#include "experiments/report/pictures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "framework/core/error.h"
#include "framework/io/file.h"
#include "tests/report/sample_run.h"

namespace pliant {
namespace {

const Picture& find(const std::vector<Picture>& pictures, const std::string& file) {
  for (const Picture& picture : pictures) {
    if (picture.file == file) return picture;
  }
  throw std::out_of_range(file);
}

/// The brightness of the pixel (u, v) of the source, where pictures are enlarged twelvefold.
int brightness(const Picture& picture, int u, int v) {
  const cv::Mat image = cv::imdecode(picture.png, cv::IMREAD_COLOR);
  const int scale = 12;
  const cv::Vec3b color = image.at<cv::Vec3b>(72 + scale * v + scale / 2, 20 + scale * u + scale / 2);
  return color[0] + color[1] + color[2];
}

TEST(Pictures, WritesReadableFilesOfOneSize) {
  const SampleRun sample(4);
  const auto folder = test_folder();
  const auto files = make_report("pictures")->write(sample.input(), folder);
  EXPECT_THAT(files, testing::ElementsAre(folder / "depth_source.png", folder / "depth_target.png",
                                          folder / "error_initial.png", folder / "error_aligned.png",
                                          folder / "error_final.png", folder / "graph.png"));
  const cv::Size size = cv::imread(files[0].string()).size();
  EXPECT_GT(size.area(), 480 * 360);
  for (const auto& file : files)
    EXPECT_TRUE(file.filename() == "graph.png" || cv::imread(file.string()).size() == size) << file;
  EXPECT_EQ(cv::imread(files.back().string()).rows, 72 + 48 * 17 + 20);
}

TEST(Pictures, ErrorsFallOnOneScale) {
  const std::vector<Picture> pictures = draw_pictures(SampleRun(4).input());
  const int initial = brightness(find(pictures, "error_initial.png"), 20, 15);
  const int aligned = brightness(find(pictures, "error_aligned.png"), 20, 15);
  const int final = brightness(find(pictures, "error_final.png"), 20, 15);
  EXPECT_GT(initial, aligned);
  EXPECT_GT(aligned, final);
}

TEST(Pictures, ChangeWithTheError) {
  const std::vector<Picture> better = draw_pictures(SampleRun(2).input());
  const std::vector<Picture> worse = draw_pictures(SampleRun(9).input());
  EXPECT_LT(brightness(find(better, "error_final.png"), 20, 15),
            brightness(find(worse, "error_final.png"), 20, 15));
  EXPECT_EQ(find(better, "error_initial.png").png, find(worse, "error_initial.png").png);
}

TEST(Pictures, ShowThePixelsOfTheSource) {
  const std::vector<Picture> pictures = draw_pictures(SampleRun(4).input());
  const Picture& final = find(pictures, "error_final.png");
  EXPECT_NE(brightness(final, 10, 15), brightness(final, 9, 15));  // the empty column
  EXPECT_NE(brightness(final, 10, 15), brightness(final, 11, 15));
}

TEST(Pictures, TheSourceIsNearerThanTheTarget) {
  const std::vector<Picture> pictures = draw_pictures(SampleRun(4).input());
  EXPECT_LT(brightness(find(pictures, "depth_source.png"), 20, 15),
            brightness(find(pictures, "depth_target.png"), 20, 15));
}

TEST(Pictures, OmitTheAlignmentThatMovedNothing) {
  SampleRun sample(4);
  sample.run.result.aligned_points = sample.run.result.source.points;
  for (const Picture& picture : draw_pictures(sample.input())) EXPECT_NE(picture.file, "error_aligned.png");
}

TEST(Pictures, PerfectRegistrationHasAScaleToo) {
  SampleRun sample(0);
  sample.run.result.aligned_points = sample.run.result.points;
  EXPECT_EQ(draw_pictures(sample.input()).size(), 6u);
}

/// The colour of a place in pixels of the source: the graph's picture is the square of 48 pixels around it,
/// enlarged seventeenfold.
cv::Vec3b color_at(const Picture& picture, double u, double v) {
  const cv::Mat image = cv::imdecode(picture.png, cv::IMREAD_COLOR);
  return image.at<cv::Vec3b>(72 + static_cast<int>(17 * (v + 9)), 20 + static_cast<int>(17 * (u + 4)));
}

bool is_grey(const cv::Vec3b& color) { return color[0] == color[1] && color[1] == color[2]; }

TEST(Pictures, ShowTheCellsOfTheGraphByLevelAndCrossVirtualOnesOut) {
  SampleRun sample(4);
  sample.run.result.graph_cells = {
      {12, 4, 20, 12, 2, false}, {20, 4, 28, 12, 2, true}, {12, 12, 16, 16, 3, false}};
  const Picture graph = find(draw_pictures(sample.input()), "graph.png");
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
  const Eigen::Vector2i pixel = sample.run.result.source.pixels[point];
  const auto color_there = [&] {
    return color_at(find(draw_pictures(sample.input()), "graph.png"), pixel.x() + 0.5, pixel.y() + 0.5);
  };
  const cv::Vec3b without = color_there();
  sample.run.result.node_positions = {sample.run.result.aligned_points[point]};
  EXPECT_NE(color_there(), without);
}

TEST(Pictures, SayWhichFileCannotBeWritten) {
  const SampleRun sample(4);
  const auto missing = test_folder() / "missing";
  EXPECT_THAT([&] { make_report("pictures")->write(sample.input(), missing); },
              testing::ThrowsMessage<DataError>(testing::HasSubstr((missing / "depth_source.png").string())));
}

}  // namespace
}  // namespace pliant
