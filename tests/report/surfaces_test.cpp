#include "experiments/report/surfaces.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "framework/core/error.h"
#include "framework/io/ply.h"
#include "tests/report/sample_run.h"

namespace pliant {
namespace {

struct Vertex {
  float position[3];
  float normal[3];
  std::int32_t pixel[2];
  float error;
  std::uint8_t color[3];
  std::uint8_t matched = 2;  // where none is told
};

struct Ply {
  std::string header;
  std::vector<Vertex> vertices;
  std::vector<Eigen::Vector3i> triangles;
};

template <class T>
void read(std::istream& stream, T& value) {
  stream.read(reinterpret_cast<char*>(&value), sizeof(T));
}

/// Reads the layout that the issue of PLY files to users promises, byte by byte.
Ply read_ply(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  Ply ply;
  std::size_t vertices = 0;
  std::size_t faces = 0;
  bool tells_matches = false;
  for (std::string line; std::getline(stream, line) && line != "end_header";) {
    ply.header += line + "\n";
    std::istringstream words(line);
    std::string element, what;
    words >> element >> what;
    tells_matches = tells_matches || line == "property uchar matched";
    if (element == "element") words >> (what == "vertex" ? vertices : faces);
  }
  ply.vertices.resize(vertices);
  for (Vertex& vertex : ply.vertices) {
    read(stream, vertex.position);
    read(stream, vertex.normal);
    read(stream, vertex.pixel);
    read(stream, vertex.error);
    read(stream, vertex.color);
    if (tells_matches) read(stream, vertex.matched);
  }
  for (std::size_t i = 0; i < faces; ++i) {
    std::uint8_t corners = 0;
    std::int32_t indices[3];
    read(stream, corners);
    read(stream, indices);
    EXPECT_EQ(corners, 3);
    ply.triangles.emplace_back(indices[0], indices[1], indices[2]);
  }
  EXPECT_TRUE(stream.good());
  EXPECT_EQ(stream.peek(), std::char_traits<char>::eof()) << "bytes left over";
  return ply;
}

TEST(Ply, HoldsWhatItWasGiven) {
  Surface surface;
  surface.points = {{1.5f, -2, 1000}, {3, 4, 1001}};
  surface.normals = {{0, 0, -1}, {0, 0.6f, -0.8f}};
  surface.pixels = {{3, 7}, {639, 479}};
  surface.colors = {{1, 2, 255}, {4, 5, 6}};
  const auto file = test_folder() / "a.ply";
  write_ply(file.string(), {surface, {0.25f, 7}, {{0, 1, 0}}});
  const Ply ply = read_ply(file);
  EXPECT_EQ(ply.header,
            "ply\nformat binary_little_endian 1.0\ncomment millimetres, camera frame\nelement vertex 2\n"
            "property float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\n"
            "property float nz\nproperty int u\nproperty int v\nproperty float error\nproperty uchar red\n"
            "property uchar green\nproperty uchar blue\nelement face 1\n"
            "property list uchar int vertex_indices\n");
  ASSERT_EQ(ply.vertices.size(), 2u);
  EXPECT_THAT(ply.vertices[0].position, testing::ElementsAre(1.5f, -2, 1000));
  EXPECT_THAT(ply.vertices[1].normal, testing::ElementsAre(0, 0.6f, -0.8f));
  EXPECT_THAT(ply.vertices[1].pixel, testing::ElementsAre(639, 479));
  EXPECT_EQ(ply.vertices[0].error, 0.25f);
  EXPECT_THAT(ply.vertices[0].color, testing::ElementsAre(1, 2, 255));
  EXPECT_EQ(ply.triangles[0], Eigen::Vector3i(0, 1, 0));
}

TEST(Ply, SaysWhichFileItCannotWrite) {
  const std::string path = (test_folder() / "missing" / "a.ply").string();
  EXPECT_THAT(
      [&] {
        write_ply(path, {{}, {}});
      },
      testing::ThrowsMessage<DataError>(testing::HasSubstr(path)));
}

TEST(Ply, RefusesListsOfDifferentLength) {
  Surface surface;
  surface.points.resize(2);
  surface.normals.resize(2);
  surface.pixels.resize(2);
  EXPECT_THROW(write_ply((test_folder() / "a.ply").string(), {surface, {1}}), std::invalid_argument);
}

TEST(Ply, TellsWhichPointsAreMatchedWhereThatIsKnown) {
  Surface surface;
  surface.points.resize(2);
  surface.normals.resize(2);
  surface.pixels.resize(2);
  const auto file = test_folder() / "a.ply";
  write_ply(file.string(), {surface, {0, 0}, {}, {1, 0}});
  const Ply ply = read_ply(file);
  EXPECT_EQ(ply.vertices[0].matched, 1);
  EXPECT_EQ(ply.vertices[1].matched, 0);
  EXPECT_THROW(write_ply(file.string(), {surface, {0, 0}, {}, {1}}), std::invalid_argument);
}

TEST(Triangulate, JoinsNeighboursTowardsTheCamera) {
  Surface square;
  square.points = {{0, 0, 100}, {1, 0, 100}, {0, 1, 100}, {1, 1, 100}};
  square.pixels = {{5, 5}, {6, 5}, {5, 6}, {6, 6}};
  const std::vector<Eigen::Vector3i> triangles = triangulate(square, 10);
  ASSERT_EQ(triangles.size(), 2u);
  for (const Eigen::Vector3i& corners : triangles) {
    const Eigen::Vector3f a = square.points[corners[1]] - square.points[corners[0]];
    const Eigen::Vector3f b = square.points[corners[2]] - square.points[corners[0]];
    EXPECT_LT(a.cross(b).z(), 0);
  }
}

TEST(Triangulate, SpansNoDepthStepAndNoHole) {
  Surface step;
  step.points = {{0, 0, 100}, {1, 0, 100}, {0, 1, 100}, {1, 1, 111}};
  step.pixels = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
  EXPECT_EQ(triangulate(step, 10).size(), 1u);
  step.pixels[3] = {2, 1};
  EXPECT_EQ(triangulate(step, 20).size(), 1u);
  EXPECT_TRUE(triangulate({}, 20).empty());
}

TEST(SurfacesReport, WritesEachSurfaceUnderItsName) {
  const RunArtefacts run = sample_run();
  const auto folder = test_folder();
  const auto files = make_report("surfaces")->write(run, folder);
  ASSERT_THAT(files, testing::ElementsAre(folder / "rest.ply", folder / "moved.ply"));
  EXPECT_THAT(make_report("surfaces")->files({{}, {"rest", "moved"}}),
              testing::ElementsAre("rest.ply", "moved.ply"));
  const Ply rest = read_ply(files[0]);
  const Ply moved = read_ply(files[1]);
  ASSERT_EQ(rest.vertices.size(), 39u * 30);
  ASSERT_EQ(moved.vertices.size(), rest.vertices.size());
  EXPECT_EQ(rest.triangles.size(), 2u * 37 * 29);  // none across the empty column
  for (std::size_t i = 0; i < rest.vertices.size(); ++i) {
    EXPECT_FLOAT_EQ(rest.vertices[i].position[2], 800);
    EXPECT_FLOAT_EQ(moved.vertices[i].position[2], 826);
    EXPECT_EQ(moved.vertices[i].pixel[0], rest.vertices[i].pixel[0]);
    EXPECT_EQ(moved.vertices[i].pixel[1], rest.vertices[i].pixel[1]);
  }
  EXPECT_THAT(rest.vertices[10].pixel, testing::ElementsAre(11, 0));
  EXPECT_EQ(rest.vertices[0].error, 30);
  EXPECT_EQ(moved.vertices[0].error, 4);
  EXPECT_EQ(moved.vertices[3].matched, 0);
  EXPECT_EQ(moved.vertices[4].matched, 1);
  EXPECT_EQ(rest.vertices[0].color[0], rest.vertices[0].color[2]) << "no colour: grey";
}

TEST(SurfacesReport, JoinsWhatWereNeighboursAtRest) {
  RunArtefacts run = sample_run();
  const auto folder = test_folder();
  NamedSurface& moved = run.surfaces[1];
  moved.surface.points[20].z() += 100;  // far beyond depth_step
  make_report("surfaces")->write(run, folder);
  EXPECT_EQ(read_ply(folder / "moved.ply").triangles.size(), 2u * 37 * 29);
  moved.rest.clear();
  make_report("surfaces")->write(run, folder);
  EXPECT_LT(read_ply(folder / "moved.ply").triangles.size(), 2u * 37 * 29);
}

}  // namespace
}  // namespace pliant
