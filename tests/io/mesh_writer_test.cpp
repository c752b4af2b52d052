#include "framework/io/mesh_writer.h"

#include <gmock/gmock.h>

#include <stdexcept>

#include "framework/io/gltf.h"
#include "framework/io/surface_mesh.h"
#include "tests/io/test_files.h"

namespace pliant::test {
namespace {

using MeshWriterTest = TestFiles;

const Mesh tetrahedron{{{0, 0, 500}, {100, 0, 500}, {0, 100, 500}, {0, 0, 650.5F}},
                       {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}},
                       {}};

TEST_F(MeshWriterTest, PlyReadsBackBitForBit) {
  write_mesh_ply(file("model.ply"), tetrahedron);
  const SurfaceMesh read = read_surface_mesh(file("model.ply"), 1);
  EXPECT_EQ(read.vertices, tetrahedron.vertices);
  EXPECT_EQ(read.triangles, tetrahedron.triangles);
}

TEST_F(MeshWriterTest, GltfIsTheSameInMetresTurnedUpright) {
  write_glb(file("model.glb"), tetrahedron);
  const Mesh read = read_gltf(file("model.glb"));
  EXPECT_EQ(read.triangles, tetrahedron.triangles);
  ASSERT_EQ(read.vertices.size(), tetrahedron.vertices.size());
  for (std::size_t i = 0; i < read.vertices.size(); ++i) {
    const Eigen::Vector3f& vertex = tetrahedron.vertices[i];
    const Eigen::Vector3f upright(vertex.x(), -vertex.y(), -vertex.z());
    EXPECT_LT((read.vertices[i] - upright).norm(), 1e-3F) << i;
  }
}

TEST_F(MeshWriterTest, AnAnimationMovesTheTargets) {
  Mesh mesh = tetrahedron;
  mesh.targets = {{"up", std::vector<Eigen::Vector3f>(4, {0, -30, 0})},
                  {"near", {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, -50}}}};
  const Track weights{Track::Interpolation::linear, 2, {0, 0.5, 2}, {0, 0, 1, 0, 0.25, 1}};
  write_animated_glb(file("moving.glb"), mesh, weights);
  const GltfScene read = read_gltf_scene(file("moving.glb"));
  EXPECT_EQ(read.mesh.target_names(), mesh.target_names());
  ASSERT_EQ(read.animations.size(), 1U);
  for (const double seconds : {0.0, 0.25, 0.5, 1.25, 2.0}) {
    const auto expected = mesh.deform(weights.at(seconds));
    const auto moved = read.mesh.deform(read.animations[0].pose(read.mesh, seconds));
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const Eigen::Vector3d upright(expected[i].x(), -expected[i].y(), -expected[i].z());
      EXPECT_LT((moved[i] - upright).norm(), 1e-3) << seconds << " s, vertex " << i;
    }
  }
  EXPECT_THROW(write_animated_glb(file("moving.glb"), tetrahedron, weights), std::invalid_argument);
}

TEST_F(MeshWriterTest, AnEmptyModelIsAFileWithoutMesh) {
  write_glb(file("empty.glb"), {});
  EXPECT_THAT(data_error_of([&] { read_gltf(file("empty.glb")); }), ::testing::HasSubstr("no triangle"));
  EXPECT_THAT(data_error_of([&] { write_glb(file("no/such/folder.glb"), tetrahedron); }),
              ::testing::HasSubstr("folder.glb"));
}

}  // namespace
}  // namespace pliant::test
