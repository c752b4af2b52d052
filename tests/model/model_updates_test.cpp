#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "framework/core/error.h"
#include "framework/model/warp_field.h"

namespace pliant {
namespace {

class OtherModel : public ReferenceModel {
 public:
  void integrate(const DepthMap&, const Camera&, const Eigen::Isometry3d&, int) override {}
  const SurfaceMap& raycast(const Camera&, const PixelWindow&, const Eigen::Isometry3d&) override {
    return nothing_;
  }
  Mesh mesh() const override { return {}; }

 private:
  SurfaceMap nothing_{{}, {}, {}};
};

std::unique_ptr<ModelUpdate> warp_field() {
  Registry registry;
  register_model_updates(registry);
  return registry.make<ModelUpdate>(Parameters("warp_field", {{"node_spacing", 25.0}}, "tracked.yaml:7:3"));
}

TEST(ModelUpdates, MakeAWarpFieldAroundATsdf) {
  Device device;
  const auto model = warp_field()->make(
      device, std::make_unique<Tsdf>(device, TsdfGrid{{16, 16, 16}, {0, 0, 500}, 5, 20}, 64));
  EXPECT_NE(dynamic_cast<WarpField*>(model.get()), nullptr);
  EXPECT_TRUE(model->mesh().vertices.empty());
}

TEST(ModelUpdates, SayThatAWarpFieldNeedsVoxels) {
  Device device;
  try {
    warp_field()->make(device, std::make_unique<OtherModel>());
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("tracked.yaml:7:3"));
    EXPECT_THAT(error.what(), ::testing::HasSubstr("tsdf"));
  }
}

}  // namespace
}  // namespace pliant
