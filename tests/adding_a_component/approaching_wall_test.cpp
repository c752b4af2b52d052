#include <gmock/gmock.h>

#include <cstdlib>

#include "experiments/datasets/datasets.h"
#include "experiments/datasets/frame_source.h"
#include "framework/config/config.h"

// What the reader of docs/adding-a-component.md has after the section on frame sources. Built by follow.cmake
// in a copy of the room `experiments/datasets` that was changed as the document says.
namespace pliant::test {
namespace {

class ApproachingWall : public testing::Test {
 protected:
  ApproachingWall() { register_datasets(registry_); }

  /// The stream that the experiment of the document opens.
  std::unique_ptr<DataStream> open() {
    const char* file = std::getenv("PLIANT_FRAMES_EXAMPLE");
    if (file == nullptr) throw std::runtime_error("PLIANT_FRAMES_EXAMPLE is not set");
    const auto experiment =
        load_experiment({file, {}, {}}, {component("data", FrameSource::kind)}, registry_);
    return registry_.make<FrameSource>(experiment.values.section("data"))->open(device_, 1);
  }

  Registry registry_;
  Device device_;
};

TEST_F(ApproachingWall, IsListed) {
  const auto* info = registry_.find("data", "approaching_wall");
  ASSERT_NE(info, nullptr);
  EXPECT_THAT(registry_.components("data"), testing::Contains(info));
}

TEST_F(ApproachingWall, IsAStreamThatKeepsToTheRules) {
  const auto stream = open();
  CheckedStream frames(*stream);
  int count = 0;
  float depth = 1001;
  while (const auto frame = frames.next()) {
    ++count;
    EXPECT_LT(frame->depth(0, 0), depth);
    depth = frame->depth(0, 0);
  }
  EXPECT_EQ(count, 10);
  EXPECT_FLOAT_EQ(depth, 910);
}

TEST_F(ApproachingWall, IsAPairWithItsTruth) {
  const auto stream = open();
  const FramePair pair = read_pair(*stream);
  const PairTruth truth = stream->truth(2).value();
  EXPECT_NO_THROW(check(truth, pair));
  EXPECT_FLOAT_EQ(pair.source.depth(3, 4) + truth.scene_flow(3, 4).z(), pair.target.depth(3, 4));
}

}  // namespace
}  // namespace pliant::test
