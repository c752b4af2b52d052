#include "experiments/datasets/surface_pair.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "tests/datasets/data_of.h"
#include "tests/io/test_files.h"

namespace pliant {
namespace {

using test::data_error_of;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A square of 200 mm that looks along +z, in metres, and the same 20 mm nearer to who looks at it.
class SurfacePairFiles : public test::TestFiles {
 protected:
  SurfacePairFiles() {
    write("a.obj", square(0.1, 0));
    write("b.obj", square(0.1, 0.02));
  }

  static std::string square(double half, double z) {
    return fmt::format(
        "v -{0} -{0} {1} 1 0 0\nv {0} -{0} {1} 1 0 0\nv {0} {0} {1} 0 0 1\nv -{0} {0} {1} 0 0 1\nf 1 2 3 4\n",
        half, z);
  }

  std::string section(const std::string& rest = "") const {
    return fmt::format(
        "{{type: surface_pair, source: '{}', target: '{}', unit: 1000, image_width: 80, image_height: 60, "
        "focal_length: "
        "60{}}}",
        file("a.obj"), file("b.obj"), rest);
  }
  test::LoadedPair load(const std::string& rest = "") const {
    return test::load(*test::data_of(section(rest)), 0);
  }
  std::string error(const std::string& rest = "") const {
    return data_error_of([&] { load(rest); });
  }
};

TEST_F(SurfacePairFiles, AreSeenFromTheFrontAndFillTheImage) {
  const auto pair = load();
  EXPECT_EQ(pair.name, "a to b");
  const float middle = pair.source.depth(40, 30);
  EXPECT_NEAR(pair.target.depth(40, 30), middle - 20, 1e-3);
  // The target, which is nearer, reaches from edge to edge but for the margin: 29.5 * 0.9 rows from the
  // middle.
  EXPECT_GT(pair.target.depth(40, 4), 0);
  EXPECT_EQ(pair.target.depth(40, 2), 0);
  EXPECT_GT(pair.source.color(40, 10).b, pair.source.color(40, 10).r) << "what is up in the file is up";
  EXPECT_GT(pair.source.color(40, 50).r, pair.source.color(40, 50).b);
  EXPECT_FALSE(pair.truth);
  EXPECT_THAT(pair.warnings, IsEmpty());
}

TEST_F(SurfacePairFiles, TheCameraMayStandElsewhere) {
  const auto pair = load(", distance: 500");
  EXPECT_NEAR(pair.source.depth(40, 30), 510, 1e-3);  // the middle is between both
  EXPECT_EQ(load(", distance: 500, rotation_y: 90").source.depth(40, 30), 0) << "seen from its edge";
  const auto given = load(", camera_from_surface: [1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 400, 0, 0, 0, 1]");
  EXPECT_NEAR(given.source.depth(40, 30), 400, 1e-3);
  EXPECT_NEAR(given.target.depth(40, 30), 380, 1e-3);
}

TEST_F(SurfacePairFiles, CorrespondingOnesHaveTheirExactMotion) {
  const auto pair = load(", corresponding: true");
  ASSERT_TRUE(pair.truth);
  EXPECT_LT((pair.motion(40, 30) - Eigen::Vector3f(0, 0, -20)).norm(), 1e-3);
  EXPECT_TRUE(pair.motion(0, 0).hasNaN());
}

TEST_F(SurfacePairFiles, WhatDoesNotCorrespondIsAnError) {
  write("b.obj", square(0.1, 0) + "v 0 0 0 1 1 1\n");
  EXPECT_THAT(error(", corresponding: true"),
              AllOf(HasSubstr("b.obj: 5 vertices"), HasSubstr("a.obj has 4")));
  std::string other = square(0.1, 0);
  other.replace(other.find("f 1 2 3 4"), 9, "f 2 3 4 1");
  write("b.obj", other);
  EXPECT_THAT(error(", corresponding: true"), HasSubstr("triangle 0 is not that of"));
  EXPECT_FALSE(load().truth);
}

TEST_F(SurfacePairFiles, SuspiciousSizesAreDoubted) {
  const auto in_unit = [&](const std::string& unit) {
    std::string other = section();
    other.replace(other.find("unit: 1000"), 10, "unit: " + unit);
    return other;
  };
  EXPECT_THAT(test::load(*test::data_of(in_unit("1e5")), 0).warnings,
              ElementsAre(AllOf(HasSubstr("a.obj: it is 20000 x 20000 x 0 mm"),
                                HasSubstr("another unit than 100000 mm")),
                          HasSubstr("b.obj")));
  EXPECT_THAT(data_error_of([&] { test::load(*test::data_of(in_unit("1")), 0); }),
              HasSubstr("it is 0.2 x 0.2 x 0 mm; if the file counts in another unit than 1 mm"));
  write("b.obj", square(0.4, 0));
  EXPECT_THAT(load().warnings,
              ElementsAre(AllOf(HasSubstr("b.obj is 4 times as large as"), HasSubstr("one unit?"))));
}

TEST_F(SurfacePairFiles, WhatIsNotSeenIsAnErrorThatTellsTheSize) {
  EXPECT_THAT(error(", camera_from_surface: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -500, 0, 0, 0, 1]"),
              AllOf(HasSubstr("no pixel of the camera sees"), HasSubstr("a.obj: it is 200 x 200 x 0 mm")));
  EXPECT_THAT(error(", distance: 5"), HasSubstr("the camera is inside"));
}

TEST_F(SurfacePairFiles, WhatIsNoSurfaceOrNoCameraIsAnError) {
  EXPECT_THROW(load(", cx: -3"), ConfigError);
  write("b.obj", std::string("v 0 0 0\n"));
  EXPECT_THAT(error(), HasSubstr("b.obj: 1 vertices without faces"));
  EXPECT_THAT(test::config_error_of(
                  section(", camera_from_surface: [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1]")),
              HasSubstr("no rigid motion"));
}

}  // namespace
}  // namespace pliant
