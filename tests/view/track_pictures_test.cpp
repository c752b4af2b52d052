// What is made of a whole stream: strip, film, and the view in three dimensions.
#include <gmock/gmock.h>

#include <numeric>
#include <opencv2/imgcodecs.hpp>
#include <set>

#include "experiments/view/clustered_mesh.h"
#include "experiments/view/error_pictures.h"
#include "experiments/view/even_choice.h"
#include "experiments/view/picture_strip.h"
#include "experiments/view/track_video.h"
#include "experiments/view/track_view.h"
#include "tests/io/test_files.h"
#include "tests/view/sample_tracked.h"

namespace pliant::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<int> chosen(int length, std::size_t most) {
  EvenChoice<int> choice(most);
  for (int i = 0; i < length; ++i)
    if (choice.takes_next()) choice.keep(i);
  return choice.kept();
}

TEST(EvenChoice, KeepsAllOfFewAndEvenlySpacedOnesOfMany) {
  EXPECT_THAT(chosen(4, 4), ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(chosen(5, 4), ElementsAre(0, 2, 4));
  EXPECT_THAT(chosen(8, 4), ElementsAre(0, 2, 4, 6));
  for (const std::size_t most : {5U, 8U})
    for (int length = 1; length < 100; ++length) {
      const auto kept = chosen(length, most);
      ASSERT_LE(kept.size(), most);
      ASSERT_GE(2 * kept.size(), std::min<std::size_t>(most, static_cast<std::size_t>(length)));
      for (std::size_t i = 2; i < kept.size(); ++i) ASSERT_EQ(kept[i] - kept[i - 1], kept[1] - kept[0]);
      ASSERT_EQ(kept[0], 0);
    }
}

cv::Mat strip_of(int frames) {
  SampleTracked sample;
  PictureStrip strip;
  strip.show(sample.waiting());
  EXPECT_TRUE(strip.empty());
  for (int i = 0; i < frames; ++i) {
    sample.record.number = i + 1;
    EXPECT_TRUE(strip.show(sample.tracked()));
  }
  return cv::imdecode(strip.png(), cv::IMREAD_COLOR);
}

TEST(PictureStrip, HasAPairOfPicturesAMoment) {
  const cv::Mat one = strip_of(1);
  const cv::Mat three = strip_of(3);
  EXPECT_EQ(one.rows, three.rows);
  EXPECT_GT(three.cols, 2 * one.cols);
  EXPECT_GT(strip_of(8).rows, one.rows);
  EXPECT_EQ(strip_of(100).cols, strip_of(8).cols);
}

TEST(PictureStrip, ShowsTheModelAndItsErrors) {
  const cv::Mat strip = strip_of(1);
  std::set<int> colors;
  for (int y = 0; y < strip.rows; ++y)
    for (int x = 0; x < strip.cols; ++x) {
      const auto& pixel = strip.at<cv::Vec3b>(y, x);
      colors.insert(pixel[0] << 16 | pixel[1] << 8 | pixel[2]);
    }
  const auto shows = [&](const Rgb& color) {
    return colors.count(color.b << 16 | color.g << 8 | color.r) == 1;
  };
  const auto error = colors_of(ColorScale::Map::error);
  EXPECT_TRUE(shows(error[255]) && shows(error[0]) && shows(no_color));
}

TEST(ErrorPictures, ShowsTheFramesThatAreAskedForOnAScaleOfTheirOwn) {
  SampleTracked sample;
  const auto widths_and_colors = [&](std::set<int> frames, float highest) {
    ErrorPictures pictures(std::move(frames), highest);
    EXPECT_TRUE(pictures.empty());
    for (int i = 1; i <= 5; ++i) {
      sample.record.number = i;
      EXPECT_TRUE(pictures.show(i == 1 ? sample.waiting() : sample.tracked()));
    }
    if (pictures.empty()) return std::pair(0, false);
    const cv::Mat picture = cv::imdecode(pictures.png(), cv::IMREAD_COLOR);
    const Rgb wall = colors_of(ColorScale::Map::error)[color_index({ColorScale::Map::error, 0, highest}, 4)];
    bool has_wall = false;
    for (int y = 0; y < picture.rows; ++y)
      for (int x = 0; x < picture.cols; ++x)
        has_wall |= picture.at<cv::Vec3b>(y, x) == cv::Vec3b(wall.b, wall.g, wall.r);
    return std::pair(picture.cols, has_wall);
  };
  const auto [one, one_has_wall] = widths_and_colors({3}, 10);
  const auto [two, two_has_wall] = widths_and_colors({2, 5, 99}, 40);
  EXPECT_TRUE(one_has_wall && two_has_wall) << "4 mm in the colour that they have on each scale";
  EXPECT_GT(two, 1.5 * one);
  EXPECT_EQ(widths_and_colors({2, 3, 4, 5}, 10).first, two) << "two a row";
  EXPECT_EQ(widths_and_colors({1, 6}, 10).first, 0) << "no model yet, and past the end";
}

/// The pictures of a film, in their order; its chunks are walked through as players do.
std::vector<cv::Mat> pictures_of(const std::string& film) {
  const std::vector<std::uint8_t> bytes = read_file(film);
  const auto number = [&](std::size_t at) {
    return bytes[at] | static_cast<std::size_t>(bytes[at + 1]) << 8 |
           static_cast<std::size_t>(bytes[at + 2]) << 16 | static_cast<std::size_t>(bytes[at + 3]) << 24;
  };
  const auto word = [&](std::size_t at) { return std::string(bytes.begin() + at, bytes.begin() + at + 4); };
  EXPECT_EQ(word(0) + word(8), "RIFFAVI ");
  EXPECT_EQ(number(4) + 8, bytes.size());
  std::size_t at = 12;
  while (word(at + 8) != "movi") at += 8 + number(at + 4);
  EXPECT_EQ(at + 8 + number(at + 4), bytes.size());
  std::vector<cv::Mat> pictures;
  for (at += 12; at < bytes.size(); at += 8 + (number(at + 4) + 1) / 2 * 2) {
    EXPECT_EQ(word(at), "00dc");
    const std::vector<std::uint8_t> jpeg(bytes.begin() + at + 8, bytes.begin() + at + 8 + number(at + 4));
    pictures.push_back(cv::imdecode(jpeg, cv::IMREAD_COLOR));
  }
  EXPECT_EQ(number(48), pictures.size()) << "as its head says";
  EXPECT_EQ(number(64), pictures.at(0).cols);
  EXPECT_EQ(number(68), pictures.at(0).rows);
  return pictures;
}

class TrackVideoTest : public TestFiles {
 protected:
  std::vector<cv::Mat> record(int frames, int every) {
    TrackVideo video(file("video.avi"), every);
    video.begin({sample_.camera});
    for (int i = 0; i < frames; ++i) {
      sample_.record.number = i + 1;
      video.show(sample_.tracked());
    }
    return pictures_of(file("video.avi"));  // while it is still being written
  }

  SampleTracked sample_;
};

TEST_F(TrackVideoTest, HasAPictureOfEveryNthFrameAsSoonAsItIsThere) {
  EXPECT_EQ(record(5, 1).size(), 5U);
  const auto pictures = record(5, 2);
  ASSERT_EQ(pictures.size(), 3U);
  const auto model = pictures[2].at<cv::Vec3b>(24 + 264 + 120, 6 + 160);
  EXPECT_NEAR(model[0], 207, 12) << "blue, of the model's chalk";
  EXPECT_NEAR(model[2], 225, 12);
}

TEST_F(TrackVideoTest, WhereItCannotBeWrittenSaysSo) {
  TrackVideo video(file("missing/video.avi"), 1);
  video.begin({sample_.camera});
  EXPECT_THAT(data_error_of([&] { video.show(sample_.tracked()); }), HasSubstr("missing/video.avi"));
}

/// A square of side x side vertices, 100 mm wide.
Mesh square(int side) {
  Mesh mesh;
  for (int v = 0; v < side; ++v)
    for (int u = 0; u < side; ++u) {
      mesh.vertices.emplace_back(100.0F * static_cast<float>(u) / static_cast<float>(side - 1),
                                 100.0F * static_cast<float>(v) / static_cast<float>(side - 1), 700);
      if (u + 1 == side || v + 1 == side) continue;
      const int here = v * side + u;
      mesh.triangles.emplace_back(here, here + side, here + 1);
      mesh.triangles.emplace_back(here + 1, here + side, here + side + 1);
    }
  return mesh;
}

double area(const ViewData::Mesh& mesh) {
  double sum = 0;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const auto corner = [&](int i) -> Eigen::Vector3f { return mesh.points[static_cast<std::size_t>(t[i])]; };
    sum += 0.5 * (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm();
  }
  return sum;
}

TEST(ClusteredMesh, KeepsTheSurfaceWithFewerVertices) {
  const ViewData::Mesh small = clustered_mesh(square(80), 500);
  EXPECT_LE(small.points.size(), 500U);
  EXPECT_GT(small.points.size(), 250U);
  EXPECT_NEAR(area(small), 100 * 100, 1200) << "but for its rim";
  EXPECT_EQ(clustered_mesh(square(20), 500).points.size(), 400U) << "few stay as they are";
}

TEST(TrackView, HasFramesInTheFrameOfTheModel) {
  SampleTracked sample;
  TrackView track;
  track.begin({sample.camera});
  track.show(sample.waiting());
  EXPECT_TRUE(track.empty());
  for (int i = 0; i < 3; ++i) {
    sample.record.number = i + 1;
    sample.record.camera_from_model = Eigen::Translation3d(0, 0, 50.0 * i);
    track.show(sample.tracked());
  }
  const ViewData view = track.view(square(10), {1, 2, 3});
  ASSERT_EQ(view.steps.size(), 3U);
  EXPECT_EQ(view.result, 2U);
  const ViewData::Step& last = view.steps[2];
  EXPECT_EQ(last.number, 3);
  EXPECT_EQ(last.state, "tracked");
  ASSERT_EQ(last.points.size(), 40U * 39);
  EXPECT_NEAR(last.points[0].z(), 600, 1e-3);
  EXPECT_NEAR(last.nearest[0], 4, 1e-3);
  EXPECT_EQ(last.cells[0], 1) << "none of the first column";
  EXPECT_EQ(last.cells[39], view.frames->columns + 1);
  ASSERT_EQ(last.camera.size(), 5U);
  EXPECT_NEAR(last.camera[0].z(), -100, 1e-3);
  EXPECT_NEAR(last.camera[1].z(), -44, 1e-3) << "a twelfth of the way to the wall";
  EXPECT_NEAR(view.frames->path[1].z(), -50, 1e-3);
  EXPECT_EQ(view.frames->path.size(), 3U);
  EXPECT_GT(view.frames->gap, 10.0) << "mm, the width of a pixel at the wall";
  EXPECT_EQ(view.target.points.size(), 100U);
  EXPECT_FLOAT_EQ(view.scale, 4);
}

TEST(TrackView, StaysSmall) {
  const Camera camera{525, 525, 319.5, 239.5, 640, 480};
  std::vector<Eigen::Vector3f> points;
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) points.emplace_back(camera.unproject(u, v, 2000).cast<float>());
  const std::vector<Eigen::Vector3f> normals(points.size(), Eigen::Vector3f(0, 0, -1));
  const SurfaceMap map(camera, whole_image(camera), PointSet{flatten(points), flatten(normals)});
  const SampleTracked sample;
  TrackView track;
  track.begin({camera});
  for (int i = 0; i < 24; ++i) track.show({sample.frame, sample.frame.color, sample.record, &map, &map});
  EXPECT_LT(view_json(track.view(square(200), {})).dump().size(), 1'300'000U);
}

}  // namespace
}  // namespace pliant::test
