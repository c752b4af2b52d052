#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "framework/model/warp_field.h"
#include "framework/tracking/tracker.h"
#include "tests/device/host_bytes.h"
#include "tests/experiments/experiment_files.h"

// A rippled surface with two hills of which one comes out as the other goes in, and back, for 10,000 frames.
namespace pliant::test {
namespace {

constexpr Camera small{64, 64, 15.5, 11.5, 32, 24};
constexpr int frames = 10000;
constexpr int held = 40;   ///< frames that a form stays for
constexpr int warm = 200;  ///< frames after which every program and every buffer is there

/// `height`: mm, of the one hill, and depth of the other.
Frame with_hills(double height) {
  Frame frame;
  frame.depth = DepthImage(small.width, small.height, 0);
  for (int v = 0; v < small.height; ++v) {
    for (int u = 0; u < small.width; ++u) {
      const double x = 2.5 * (u - small.cx), y = 2.5 * (v - small.cy);
      const auto hill_at = [&](double middle) {
        return height * std::exp(-((x - middle) * (x - middle) + y * y) / (2 * 8 * 8));
      };
      frame.depth(u, v) =
          static_cast<float>(500 + (x * x + 2 * y * y) / 32 + 20 * std::sin(x / 7) * std::sin(y / 6) +
                             hill_at(-12) - hill_at(12));
    }
  }
  return frame;
}

std::size_t node_count(const Tracker& tracker) {
  const auto* const field = dynamic_cast<const WarpField*>(&tracker.model());
  return field == nullptr ? 0 : field->field().positions().size();
}

class EndlessStream : public ExperimentFiles,
                      public ::testing::WithParamInterface<std::array<const char*, 2>> {
 protected:
  TrackingMethod method() const {
    const auto [policy, update] = GetParam();
    const std::string text =
        "acquisition: {filter: none}\n"
        "pose: {type: icp_projective, levels: 1, iterations: 2}\n"
        "model: {type: tsdf, volume: fitted, resolution: 48, margin: 0}\n"
        "tracking_error: {radius: 1}\n"
        "graph: {type: uniform, spacing: 4}\n"
        "sampler: {type: uniform, points: 400}\n"
        "correspondence: closest\n"
        "energies:\n"
        "  rotation: {weight: 500}\n"
        "  regularization: {weight: 20}\n"
        "  point_to_plane: {weight: 100, loss: welsch, loss_scale: 7}\n"
        "  constraint: {weight: 0.3, loss: welsch, loss_scale: 7}\n"
        "  displacement: {weight: 4, loss: huber, loss_scale: 1}\n"
        "solver: {type: gauss_newton, max_iterations: 1}\n"
        "stopping: {max_iterations: 4}\n";
    return make_tracking_method(plan(text, {policy, update}).runs.at(0).values, registry_);
  }

  Device device_;
};

// That of drivers counts, too: PoCL keeps some megabytes for each program that is built.
TEST_P(EndlessStream, TenThousandFramesTakeNoMoreMemoryThanSome) {
  const std::vector<Frame> forms{with_hills(0), with_hills(6), with_hills(0), with_hills(-6)};
  const TrackingMethod registering = method();
  Tracker tracker(registering, Rig{small}, device_);
  std::uint64_t allocations = 0;
  std::size_t bytes = 0;
  std::size_t nodes = 0;
  int lost = 0;
  int registered_at_last = 0;
  for (int i = 0; i < frames; ++i) {
    Frame frame = forms[static_cast<std::size_t>(i / held) % forms.size()];
    frame.time = i;
    const FrameRecord record = tracker.track(frame);
    lost += record.state == FrameState::lost ? 1 : 0;
    if (i >= frames - 1000) registered_at_last += is_registered(record) ? 1 : 0;
    if (i != warm) continue;
    allocations = device_.counts().allocations;
    bytes = test::host_bytes();
    nodes = node_count(tracker);
  }
  EXPECT_EQ(lost, 0);
  EXPECT_GE(registered_at_last, 10) << "it is still followed";
  EXPECT_EQ(device_.counts().allocations, allocations);
  EXPECT_LT(test::host_bytes(), bytes + (1 << 18)) << "thirty bytes a frame would be more";
  EXPECT_LE(node_count(tracker), nodes + nodes / 10) << "the surface is the same all along";
}

INSTANTIATE_TEST_SUITE_P(PoliciesAndUpdates, EndlessStream,
                         ::testing::Values(std::array{"policy={type: every_n, n: 35}",
                                                      "update={type: reintegration, weight: 255}"},
                                           std::array{"policy={type: every_n, n: 35}",
                                                      "update={type: warp_field, node_spacing: 30}"},
                                           std::array{"policy={type: adaptive, threshold: 0.9, patience: 20}",
                                                      "update={type: reintegration, weight: 255}"},
                                           std::array{"policy={type: adaptive, threshold: 0.9, patience: 20}",
                                                      "update={type: warp_field, node_spacing: 30}"}));

}  // namespace
}  // namespace pliant::test
