#include "framework/io/surface_mesh.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <random>

#include "framework/io/ply.h"
#include "tests/io/test_files.h"

namespace pliant {
namespace {

using test::data_error_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class SurfaceFile : public test::TestFiles {
 protected:
  SurfaceMesh read(const std::string& name, const std::string& text, double unit = 1) const {
    return read_surface_mesh(write(name, text), unit);
  }
  /// Of a file with this text.
  std::string error_of(const std::string& name, const std::string& text) const {
    const std::string path = write(name, text);
    const std::string error = data_error_of([&] { read_surface_mesh(path, 1); });
    EXPECT_THAT(error, HasSubstr(path));
    return error.substr(std::min(error.find(path) + path.size(), error.size()));
  }
  void never_does_harm(const std::string& name, const std::string& whole, int trials) const;
};

/// Reads it if it can be read; anything but a sound mesh or a DataError of one line is a failure.
void read_or_refuse(const std::string& path) {
  try {
    const SurfaceMesh mesh = read_surface_mesh(path, 1);
    ASSERT_FALSE(mesh.triangles.empty());
    for (const Eigen::Vector3f& vertex : mesh.vertices) ASSERT_TRUE(vertex.allFinite());
    for (const Eigen::Vector3i& triangle : mesh.triangles) {
      ASSERT_GE(triangle.minCoeff(), 0);
      ASSERT_LT(triangle.maxCoeff(), static_cast<int>(mesh.vertices.size()));
    }
    ASSERT_TRUE(mesh.colors.empty() || mesh.colors.size() == mesh.vertices.size());
  } catch (const DataError& error) {
    const std::string message = error.what();
    ASSERT_THAT(message, HasSubstr(path));
    ASSERT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

void SurfaceFile::never_does_harm(const std::string& name, const std::string& whole, int trials) const {
  std::mt19937 generator(1);
  for (int trial = 0; trial < trials; ++trial) {
    std::string text = whole;
    for (std::size_t i = 0; i < 1 + trial % 3U; ++i) {
      const std::size_t at = generator() % text.size();
      const std::string printable = "0123456789 -/.\nef";
      switch (generator() % 4) {
        case 0:
          text[at] = static_cast<char>(generator());
          break;
        case 1:
          text[at] = printable[generator() % printable.size()];
          break;
        case 2:
          text.erase(at, 1 + generator() % 5);
          break;
        default:
          text.insert(at, 1, printable[generator() % printable.size()]);
      }
      if (text.empty()) text = "p";
    }
    std::filesystem::remove(file(name));
    ASSERT_NO_FATAL_FAILURE(read_or_refuse(write(name, text))) << "trial " << trial << "\n" << text;
  }
}

const std::string square_obj =
    "# a square\nmtllib x.mtl\nv 0 0 0\nv 1 0 0\r\nv 1 1 0 1.0\nv 0 1 0\nvt 0 0\nvn 0 0 1\ng front\n"
    "f 1/1/1 2/1/1 3//1 4/1\n";

TEST_F(SurfaceFile, ObjPolygonsBecomeTriangles) {
  const SurfaceMesh mesh = read("square.obj", square_obj, 1000);
  EXPECT_EQ(mesh.vertices.at(2), Eigen::Vector3f(1000, 1000, 0));
  EXPECT_THAT(mesh.triangles, ElementsAre(Eigen::Vector3i(0, 1, 2), Eigen::Vector3i(0, 2, 3)));
  EXPECT_THAT(mesh.colors, IsEmpty());
}

TEST_F(SurfaceFile, ObjCornersMayCountBackwards) {
  const SurfaceMesh mesh =
      read("a.OBJ", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 0 0 1\nf -1//-1 -4/2 -2/2/2\n");
  EXPECT_THAT(mesh.triangles, ElementsAre(Eigen::Vector3i(0, 1, 2), Eigen::Vector3i(3, 0, 2)));
}

TEST_F(SurfaceFile, ObjVerticesMayHaveColours) {
  const SurfaceMesh mesh = read("a.obj", "v 0 0 0 1 0 0\nv 1 0 0 0 0.5 0\nv 0 1 0 0 0 1\nf 1 2 3\n");
  EXPECT_THAT(mesh.colors, ElementsAre(Rgb{255, 0, 0}, Rgb{0, 128, 0}, Rgb{0, 0, 255}));
}

TEST_F(SurfaceFile, TrianglesThatNameAVertexTwiceAreLeftOut) {
  EXPECT_THAT(read("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 1 2\nf 1 2 2 3\n").triangles,
              ElementsAre(Eigen::Vector3i(0, 1, 2)));
}

TEST_F(SurfaceFile, WhatIsWrongInAnObjIsToldWithItsLine) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  const auto error = [&](const std::string& rest) { return error_of("a.obj", vertices + rest); };
  EXPECT_THAT(error("f 1 2 4\n"), HasSubstr(":4: a face names vertex 4, but 3 are before it"));
  EXPECT_THAT(error("f 1 2 -4\n"), HasSubstr(":4: a face names vertex -4, but 3 are before it"));
  EXPECT_THAT(error("f 1 2 0\n"), HasSubstr("names vertex 0"));
  EXPECT_THAT(error("f 1 2\n"), HasSubstr(":4: a face of 2 corners"));
  for (const char* corner : {"1/", "1//", "1/2/", "1/2/3/4", "x", "/1", "1.5", "1/x", "1//x"})
    EXPECT_THAT(error(fmt::format("f 2 3 {}\n", corner)), HasSubstr(":4: a corner of a face")) << corner;
  EXPECT_THAT(error("v 1 x 0\n"), HasSubstr(":4: 'x' is not a number"));
  EXPECT_THAT(error("v 1 0\n"), HasSubstr(":4: a vertex of 2 numbers"));
  EXPECT_THAT(error("v 1 0 nan\n"), HasSubstr("'nan' is not a number"));
  EXPECT_THAT(error("v 1 0 0 2\n"), HasSubstr("a weight that is not 1"));
  EXPECT_THAT(error("v 1 0 0 1 1 2\n"), HasSubstr("a colour of 2"));
  EXPECT_THAT(error("v 1 0 0 1 1 1\nf 1 2 3\n"), HasSubstr("1 of 4 vertices have colours"));
  EXPECT_THAT(error("v 1e39 0 0\n"), HasSubstr("too far away"));
  EXPECT_THAT(error("curv 0 1 1 2\n"), HasSubstr(":4: a line that is no vertex"));
  EXPECT_THAT(error(""), HasSubstr("3 vertices without faces"));
}

TEST_F(SurfaceFile, DamagedObjsNeverDoHarm) { never_does_harm("damaged.obj", square_obj, 3000); }

/// A square of 8-bit colours in ascii, properties and elements in an unusual order.
const std::string square_ply =
    "ply\nformat ascii 1.0\ncomment odd # 1\nelement face 1\nproperty uchar flags\n"
    "property list uchar uint vertex_index\nelement other 2\nproperty list int float numbers\n"
    "element vertex 4\nproperty uchar red\nproperty double y\nproperty float x\nproperty uchar green\n"
    "property short z\nproperty uchar blue\nend_header\n"
    "7 4 0 1 2 3\n0\n2 1.5 2.5\n255 0 0 1 0 0\n255 0 1.5 1 0 0\n255 1 1.5 1 0 0\n\n255 1 0 1 2 0\n";

TEST_F(SurfaceFile, PlyPropertiesMayComeInAnyOrder) {
  const SurfaceMesh mesh = read("a.ply", square_ply, 10);
  EXPECT_THAT(mesh.vertices, ElementsAre(Eigen::Vector3f(0, 0, 0), Eigen::Vector3f(15, 0, 0),
                                         Eigen::Vector3f(15, 10, 0), Eigen::Vector3f(0, 10, 20)));
  EXPECT_THAT(mesh.triangles, ElementsAre(Eigen::Vector3i(0, 1, 2), Eigen::Vector3i(0, 2, 3)));
  EXPECT_EQ(mesh.colors.at(3), (Rgb{255, 1, 0}));
}

/// The same in either byte order.
std::string binary_ply(bool is_big_endian) {
  std::string text = square_ply.substr(0, square_ply.find("7 4 0"));
  text.replace(text.find("ascii"), 5, is_big_endian ? "binary_big_endian" : "binary_little_endian");
  const auto add = [&](auto number) {
    std::string bytes(sizeof(number), '\0');
    std::memcpy(bytes.data(), &number, sizeof(number));
    if (is_big_endian) std::reverse(bytes.begin(), bytes.end());
    text += bytes;
  };
  add(std::uint8_t{7});
  add(std::uint8_t{4});
  for (std::uint32_t i = 0; i < 4; ++i) add(i);
  add(std::int32_t{0});
  add(std::int32_t{1});
  add(1.5F);
  const std::vector<std::array<double, 3>> vertices{{0, 0, 0}, {1.5, 0, 0}, {1.5, 1, 0}, {0, 1, 2}};
  for (const auto& [x, y, z] : vertices) {
    add(std::uint8_t{255});
    add(y);
    add(static_cast<float>(x));
    add(std::uint8_t{1});
    add(static_cast<std::int16_t>(z));
    add(std::uint8_t{0});
  }
  return text;
}

TEST_F(SurfaceFile, PlyMayBeBinaryInEitherOrder) {
  const SurfaceMesh expected = read("a.ply", square_ply);
  for (const bool is_big_endian : {false, true}) {
    const SurfaceMesh mesh = read("b.ply", binary_ply(is_big_endian));
    EXPECT_EQ(mesh.vertices, expected.vertices);
    EXPECT_EQ(mesh.triangles, expected.triangles);
    EXPECT_EQ(mesh.colors, expected.colors);
  }
}

TEST_F(SurfaceFile, EveryTruncationOfABinaryPlyIsAnError) {
  const std::string whole = binary_ply(false);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    std::filesystem::remove(file("cut.ply"));
    const std::string path = write("cut.ply", whole.substr(0, size));
    EXPECT_THAT(data_error_of([&] { read_surface_mesh(path, 1); }), HasSubstr(path)) << size;
  }
  EXPECT_THAT(error_of("long.ply", whole + "x"), HasSubstr("too long: 1 bytes"));
}

TEST_F(SurfaceFile, WhatIsWrittenIsReadBack) {
  PlySurface written;
  written.surface.points = {{1, 2, 3}, {4, 5, 6}, {7, 8, 10}};
  written.surface.normals.assign(3, Eigen::Vector3f::UnitZ());
  written.surface.pixels.assign(3, Eigen::Vector2i::Zero());
  written.surface.colors = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  written.errors.assign(3, 0.5F);
  written.triangles = {{0, 1, 2}};
  write_ply(file("own.ply"), written);
  const SurfaceMesh mesh = read_surface_mesh(file("own.ply"), 1);
  EXPECT_EQ(mesh.vertices, written.surface.points);
  EXPECT_EQ(mesh.triangles, written.triangles);
  EXPECT_EQ(mesh.colors, written.surface.colors);
}

/// The square with some text replaced by another.
std::string changed(const std::string& from, const std::string& to) {
  std::string text = square_ply;
  text.replace(text.find(from), from.size(), to);
  return text;
}

TEST_F(SurfaceFile, WhatIsWrongInThePlyHeaderIsToldWithItsLine) {
  const auto error = [&](const std::string& from, const std::string& to) {
    return error_of("a.ply", changed(from, to));
  };
  EXPECT_THAT(error("ascii 1.0", "ascii 2.0"), HasSubstr(":2: expected 'format ascii 1.0'"));
  EXPECT_THAT(error("ascii", "binary_middle_endian"), HasSubstr(":2: expected"));
  EXPECT_THAT(error("element face 1", "element face"), HasSubstr(":4: expected 'element NAME COUNT'"));
  EXPECT_THAT(error("element face 1", "element face -1"), HasSubstr(":4: -1 elements"));
  EXPECT_THAT(error("element other", "element face"), HasSubstr(":7: an element of a name that another has"));
  EXPECT_THAT(error("double y", "quad y"), HasSubstr("a type that PLY does not have"));
  EXPECT_THAT(error("double y", "double x"), HasSubstr("a property of a name that another has"));
  EXPECT_THAT(error("double y", "double w"), HasSubstr("no x, y and z"));
  EXPECT_THAT(error("property uchar flags", "property uchar"),
              HasSubstr(":5: expected 'property TYPE NAME'"));
  EXPECT_THAT(error("list uchar uint", "list float uint"),
              HasSubstr(":6: a list whose length is no integer"));
  EXPECT_THAT(error("list uchar uint", "list uchar float"), HasSubstr("no list vertex_indices of integers"));
  EXPECT_THAT(error("end_header", "end_of_header"), HasSubstr(":16: expected an element"));
  EXPECT_THAT(error("element face 1\n", ""), HasSubstr(":4: a property before any element"));
  EXPECT_THAT(error_of("a.ply", "ply\nformat ascii 1.0\n"), HasSubstr(":3: the header ends"));
  EXPECT_THAT(error_of("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nend_header\n"),
              HasSubstr("element vertex has no property"));
}

TEST_F(SurfaceFile, WhatIsWrongInThePlyDataIsToldWithItsLine) {
  const auto error = [&](const std::string& from, const std::string& to) {
    return error_of("a.ply", changed(from, to));
  };
  EXPECT_THAT(error("7 4 0 1 2 3", "7 4 0 1 2 4"), HasSubstr(":17: a face names vertex 4, but there are 4"));
  EXPECT_THAT(error("7 4 0 1 2 3", "7 4 0 1 2 -1"), HasSubstr("vertex -1"));
  EXPECT_THAT(error("7 4 0 1 2 3", "7 4 0 1 2"), HasSubstr(":17: a number is missing"));
  EXPECT_THAT(error("7 4 0 1 2 3", "7 4 0 1 2 3 4"), HasSubstr(":17: 1 numbers too many"));
  EXPECT_THAT(error("7 4 0 1 2 3", "7 2 0 1"), HasSubstr("a face of 2 corners"));
  EXPECT_THAT(error("7 4 0 1 2 3", "7 -4"), HasSubstr("a list of -4 entries"));
  EXPECT_THAT(error("7 4 0 1 2 3", "7 4 0 1 2 2.5"), HasSubstr("2.5 is not a whole number"));
  EXPECT_THAT(error("255 0 1.5", "255 0 one"), HasSubstr("'one' is not a number"));
  EXPECT_THAT(error("255 0 1.5", "256 0 1.5"), HasSubstr("a colour that is not"));
  EXPECT_THAT(error("255 1 0 1 2 0\n", ""), HasSubstr("the file ends before vertex 3 of 4"));
  EXPECT_THAT(error_of("a.ply", square_ply + "1 2 3\n"), HasSubstr(":25: a line behind the last element"));
}

TEST_F(SurfaceFile, APointCloudAndOtherFilesAreNoSurface) {
  EXPECT_THAT(error_of("cloud.ply",
                       "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                       "property float z\nend_header\n1 2 3\n"),
              HasSubstr("1 vertices without faces"));
  EXPECT_THAT(error_of("a.stl", "solid x\n"), HasSubstr("neither a PLY file"));
}

TEST_F(SurfaceFile, DamagedPlysNeverDoHarm) {
  never_does_harm("ascii.ply", square_ply, 3000);
  never_does_harm("binary.ply", binary_ply(true), 3000);
}

}  // namespace
}  // namespace pliant
