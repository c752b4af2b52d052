#include "experiments/api/register_depth.h"

#include <algorithm>
#include <array>
#include <map>
#include <string_view>
#include <utility>

#include "experiments/api/depth_pair.h"
#include "experiments/methods/ad_nodes.yaml.embed.h"
#include "experiments/methods/ad_nodes_ad_cons.yaml.embed.h"
#include "experiments/methods/best.yaml.embed.h"
#include "experiments/methods/best_depth.yaml.embed.h"
#include "experiments/methods/ed.yaml.embed.h"
#include "experiments/methods/tracking.yaml.embed.h"
#include "experiments/runner/components.h"
#include "experiments/runner/experiment.h"
#include "experiments/tasks/workbench.h"
#include "framework/tracking/register_pair.h"

namespace pliant {
namespace {

const std::map<std::string, std::string>& methods() {
  static const std::map<std::string, std::string> texts{
      {"methods/ad_nodes.yaml", std::string(embedded::experiments_methods_ad_nodes_yaml)},
      {"methods/ad_nodes_ad_cons.yaml", std::string(embedded::experiments_methods_ad_nodes_ad_cons_yaml)},
      {"methods/best.yaml", std::string(embedded::experiments_methods_best_yaml)},
      {"methods/best_depth.yaml", std::string(embedded::experiments_methods_best_depth_yaml)},
      {"methods/ed.yaml", std::string(embedded::experiments_methods_ed_yaml)},
      {"methods/tracking.yaml", std::string(embedded::experiments_methods_tracking_yaml)}};
  return texts;
}

/// The keys of an experiment without those that say what it is made on.
ParameterTable recipe_table() {
  constexpr std::array<std::string_view, 3> others{"data", "handles", "runs"};
  std::vector<Parameter> rows = experiment_table().rows();
  std::erase_if(rows, [&](const Parameter& row) {
    return std::find(others.begin(), others.end(), row.name()) != others.end();
  });
  return ParameterTable(std::move(rows));
}

Parameters load_recipe(const DepthRegistrationOptions& options, const Registry& components) {
  ConfigSource source{ConfigText{options.recipe, "recipe", ""}, options.sets, {}};
  source.base_texts = methods();
  return load_experiment(source, recipe_table(), components).values;
}

Registry everything() {
  Registry registry;
  register_everything(registry);
  return registry;
}

DepthRegistrationResult to_depth_result(RegistrationResult result) {
  DepthRegistrationResult depth;
  depth.pixels = std::move(result.source.pixels);
  depth.before = std::move(result.source.points);
  depth.after = std::move(result.points);
  depth.normals = std::move(result.normals);
  depth.matched = std::move(result.matched);
  depth.rigid_motion = result.alignment.motion;
  depth.residual_before = result.history.front().residual_mean;
  depth.residual_after = result.history.at(static_cast<std::size_t>(result.returned_iteration)).residual_mean;
  depth.nodes = result.counts.nodes;
  depth.iterations = result.counts.outer_iterations;
  depth.time_ms = result.total_ms;
  depth.termination = std::move(result.termination);
  depth.reason = std::move(result.reason);
  depth.warnings = std::move(result.warnings);
  return depth;
}

}  // namespace

struct DepthRegistration::Parts {
  Parts(const DepthRegistrationOptions& options, const Registry& components)
      : Parts(load_recipe(options, components), options.progress, components) {}
  Parts(const Parameters& recipe, const ProgressSink& sink, const Registry& components)
      : method(make_method(recipe, components)),
        seed(static_cast<std::uint64_t>(recipe.integer("seed"))),
        progress(sink),
        device(recipe.text("device"), device_options(recipe)) {
    device.tell_of_building(progress);
  }

  Method method;
  std::uint64_t seed;
  ProgressSink progress;
  Device device;
};

DepthRegistration::DepthRegistration(const DepthRegistrationOptions& options)
    : DepthRegistration(options, everything()) {}
DepthRegistration::DepthRegistration(const DepthRegistrationOptions& options, const Registry& components)
    : parts_(std::make_unique<Parts>(options, components)) {}
DepthRegistration::DepthRegistration(DepthRegistration&&) noexcept = default;
DepthRegistration& DepthRegistration::operator=(DepthRegistration&&) noexcept = default;
DepthRegistration::~DepthRegistration() = default;

DepthRegistrationResult DepthRegistration::run(const DepthView& source, const DepthView& target,
                                               const Camera& camera) {
  const FramePair pair = make_depth_pair(source, target, camera);
  const Method& method = parts_->method;
  return to_depth_result(register_pair(pair, method, parts_->device, parts_->seed,
                                       telling(parts_->progress, pair.name, method.stopping.max_iterations)));
}

DepthRegistrationResult register_depth(const DepthView& source, const DepthView& target, const Camera& camera,
                                       const DepthRegistrationOptions& options) {
  return DepthRegistration(options).run(source, target, camera);
}

}  // namespace pliant
