#include <gmock/gmock.h>

#include <filesystem>

#include "framework/core/error.h"
#include "framework/io/images.h"
#include "tests/io/test_files.h"
#include "tests/segmentation/rendered_face.h"

namespace pliant {
namespace {

using test::data_error_of;
using test::difference;
using test::rendered_face;
using test::RenderedFace;
using test::segmentation_of;
using ::testing::AllOf;
using ::testing::HasSubstr;

const std::vector<std::string> default_cascades{"haarcascade_frontalface_default",
                                                "haarcascade_frontalface_alt"};

std::unique_ptr<Segmentation> haar(const std::string& cascade = default_cascades[0]) {
  return segmentation_of("{type: haar, cascade: " + cascade + "}");
}

/// The colour camera's image with its own depth.
Frame seen_by_color_camera(const RenderedFace& face) { return {face.color_depth, face.frame.color, {}}; }

TEST(Haar, FindsARenderedFaceAndCarriesItToDepth) {
  const RenderedFace face = rendered_face();
  for (const std::string& cascade : default_cascades) {
    const auto in_color = haar(cascade)->find(seen_by_color_camera(face), {*face.rig.color});
    ASSERT_TRUE(in_color) << cascade;
    const PixelWindow& window = in_color->window;
    EXPECT_GT(window.width, 100) << cascade;
    EXPECT_TRUE(window.contains(410, 300)) << cascade << ": the nose";
    const auto found = haar(cascade)->find(face.frame, face.rig);
    ASSERT_TRUE(found) << cascade;
    EXPECT_TRUE(found->mask.empty());
    EXPECT_LE(difference(found->window, true_window(window, face)), 3) << cascade;
  }
}

TEST(Haar, FindsTheAstronaut) {
  if (!std::filesystem::exists(ASTRONAUT))
    GTEST_SKIP() << "needs apt-get download python3-skimage when CMake configures; configure again with it";
  Frame frame;
  frame.color = read_color(ASTRONAUT);
  const int width = frame.color.width();
  const int height = frame.color.height();
  frame.depth = DepthImage(width, height, 1000);
  const Rig rig{{500, 500, (width - 1) / 2.0, (height - 1) / 2.0, width, height}};
  for (const std::string& cascade : default_cascades) {
    const auto found = haar(cascade)->find(frame, rig);
    ASSERT_TRUE(found) << cascade;
    EXPECT_LE(difference(found->window, {175, 65, 99, 99}), 5) << cascade;
  }
}

TEST(Haar, OfTwoFacesTakesTheLarger) {
  const RenderedFace near = rendered_face();
  const RenderedFace far = rendered_face(", keys: {a: {at: 0, motion: {shift_z: 250}}, b: {at: 0.1}}");
  // Side by side, twice as wide.
  const Camera& camera = *near.rig.color;
  const int width = camera.width;
  Frame both{DepthImage(2 * width, camera.height), ColorImage(2 * width, camera.height), {}};
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < width; ++u) {
      both.depth(u, v) = far.color_depth(u, v);
      both.color(u, v) = far.frame.color(u, v);
      both.depth(u + width, v) = near.color_depth(u, v);
      both.color(u + width, v) = near.frame.color(u, v);
    }
  }
  Camera wide = camera;
  wide.width = 2 * width;
  const auto of_near = haar()->find(seen_by_color_camera(near), {camera});
  const auto of_far = haar()->find(seen_by_color_camera(far), {camera});
  ASSERT_TRUE(of_near && of_far);
  EXPECT_LT(of_far->window.width, of_near->window.width);
  const auto found = haar()->find(both, {wide});
  ASSERT_TRUE(found);
  PixelWindow expected = of_near->window;
  expected.left += width;
  constexpr int grid = 4;  // pixels: where the detector looks depends on the size of the image
  EXPECT_LE(difference(found->window, expected), grid);
  // A picture of a face on something that has no depth is not the one.
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < width; ++u) both.depth(u + width, v) = 0;
  EXPECT_LE(difference(haar()->find(both, {wide})->window, of_far->window), grid);
}

TEST(Haar, FindsNoneWhereThereIsNone) {
  RenderedFace face = rendered_face(", keys: {a: {at: 0, motion: {rotation_y: 180}}, b: {at: 0.1}}");
  EXPECT_FALSE(haar()->find(face.frame, face.rig)) << "the back of a head";
  face = rendered_face();
  face.frame.depth = DepthImage(face.rig.depth.width, face.rig.depth.height);
  EXPECT_FALSE(haar()->find(face.frame, face.rig)) << "empty depth";
}

TEST(Haar, WithoutColourIsAnError) {
  const Rig rig{{500, 500, 79.5, 59.5, 160, 120}};
  const Frame frame{DepthImage(160, 120, 800), {}, {}};
  EXPECT_THAT(data_error_of([&] { haar()->find(frame, rig); }), HasSubstr("no colour"));
}

TEST(Haar, ACascadeThatIsMissingNamesWhatToInstall) {
  EXPECT_THAT(data_error_of([] { haar("haarcascade_frontalface_al"); }),
              AllOf(HasSubstr("haarcascades/haarcascade_frontalface_al.xml"),
                    HasSubstr("did you mean 'haarcascade_frontalface_alt'"), HasSubstr("opencv-data")));
}

class CascadeFile : public test::TestFiles {};

TEST_F(CascadeFile, ThatIsNoneIsAnError) {
  for (const char* text : {"no XML", "<?xml version=\"1.0\"?><opencv_storage><a>1</a></opencv_storage>"}) {
    const std::string path = write("own.xml", text);
    EXPECT_THAT(data_error_of([&] { segmentation_of("{type: haar, cascade_file: " + path + "}"); }),
                AllOf(HasSubstr(path), HasSubstr("not a cascade")));
  }
}

}  // namespace
}  // namespace pliant
