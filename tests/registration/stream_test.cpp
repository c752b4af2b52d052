#include <gtest/gtest.h>

#include <set>

#include "experiments/datasets/frame_source.h"
#include "framework/tracking/register_pair.h"
#include "tests/device/host_bytes.h"
#include "tests/experiments/experiment_files.h"

// Registrations one after the other, as of the frames of a stream, on one device.
namespace pliant::test {
namespace {

class StreamTest : public ExperimentFiles {
 protected:
  /// Registers the first frame to each of the others.
  template <class Look>
  void register_all(const std::vector<std::string>& sets, Look look) {
    const Parameters values = plan("", sets).runs[0].values;
    const Method method = make_method(values, registry_);
    const auto stream = registry_.make<FrameSource>(values.section("data"))->open(device_, 1);
    CheckedStream frames(*stream);
    FramePair pair{stream->name(), stream->rig().depth, frames.require("the source"), {}};
    int number = 0;
    while (auto frame = frames.next()) {
      pair.target = std::move(*frame);
      const RegistrationResult result = register_pair(pair, method, device_, 1);
      look(++number, result);
    }
  }

  Device device_;
};

// The deformation grows from frame to frame, and with it the graph and the number of iterations.
TEST_F(StreamTest, AllocatesNothingAfterTheThirdFrame) {
  const std::vector<std::string> sets{
      "data={frames: 301, noise: 0.3, amplitude: 20}",
      "graph={type: quadtree, refine_threshold: 1, collapse_threshold: 0.5}",
      "sampler={type: adaptive, threshold: 1}",
      "filter=bilateral",
      "alignment=automatic",
  };
  std::uint64_t after_third = 0;
  std::uint64_t last = 0;
  std::set<int> nodes;
  register_all(sets, [&](int number, const RegistrationResult& result) {
    last = device_.counts().allocations;
    if (number == 3) after_third = last;
    nodes.insert(result.counts.nodes);
  });
  EXPECT_GT(nodes.size(), 2U) << "frames differ in what they ask for";
  EXPECT_EQ(last, after_third);
}

TEST_F(StreamTest, TenThousandFramesTakeNoMoreMemoryThanAHundred) {
  const std::vector<std::string> sets{
      "data={frames: 10001, image_width: 32, image_height: 24, focal_length: 26}",
      "stopping.max_iterations=1", "graph.spacing=4", "sampler.step=2"};
  std::uint64_t allocations = 0;
  std::size_t bytes = 0;
  int frames = 0;
  register_all(sets, [&](int number, const RegistrationResult&) {
    frames = number;
    if (number != 100) return;
    allocations = device_.counts().allocations;
    bytes = test::host_bytes();
  });
  EXPECT_EQ(frames, 10000);
  EXPECT_EQ(device_.counts().allocations, allocations);
  EXPECT_LT(test::host_bytes(), bytes + (1 << 20)) << "a hundred bytes a frame would be as much";
}

}  // namespace
}  // namespace pliant::test
