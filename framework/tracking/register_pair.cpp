#include "framework/tracking/register_pair.h"

#include <utility>

#include "framework/core/stopwatch.h"
#include "framework/tracking/scene.h"

namespace pliant {
namespace {

/// Moves each point that was given as the filtered one in its place was moved. The transforms are not applied
/// to it: nothing determines what they do across the surface they were fitted to, and noise would be
/// stretched by that.
void move_unfiltered(const ScenePoints& at_rest, std::vector<Eigen::Vector3f>& points) {
  for (std::size_t i = 0; i < at_rest.unfiltered.size(); ++i)
    points[i] += at_rest.unfiltered[i] - at_rest.aligned[i];
}

}  // namespace

RegistrationResult register_pair(const FramePair& pair, const Method& method, Device& device,
                                 std::uint64_t seed, const Observer& observer) {
  const Stopwatch watch;
  device.take_stage_times();  // of whatever came before
  StageTimes times;
  Scene scene = make_scene(pair, method, device, seed, times);
  NonRigidResult deformed = NonRigid(method, device).run(input_of(scene), observer);
  ScenePoints at_rest = read_points(scene);
  move_unfiltered(at_rest, deformed.points);
  for (const auto& [stage, time] : times) deformed.time_ms[stage] += time;
  if (scene.alignment.failed)
    deformed.warnings.insert(
        deformed.warnings.begin(),
        "no alignment was found, and the source stays where it is: " + scene.alignment.reason);
  deformed.warnings.insert(deformed.warnings.begin(), pair.warnings.begin(), pair.warnings.end());
  return {std::move(deformed), std::move(at_rest.source),
          std::move(at_rest.unfiltered.empty() ? at_rest.aligned : at_rest.unfiltered),
          std::move(scene.alignment), watch.milliseconds()};
}

std::unique_ptr<Problem> freeze_problem(const FramePair& pair, const Method& method, Device& device,
                                        std::uint64_t seed) {
  StageTimes times;
  const Scene scene = make_scene(pair, method, device, seed, times);
  return NonRigid(method, device).freeze(input_of(scene));
}

}  // namespace pliant
