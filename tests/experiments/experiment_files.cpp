#include "tests/experiments/experiment_files.h"

#include "experiments/runner/components.h"

namespace pliant::test {

ExperimentFiles::ExperimentFiles() { register_everything(registry_); }

ExperimentPlan ExperimentFiles::plan(const std::string& text, const std::vector<std::string>& sets) const {
  write("base.yaml",
        "extends: methods/ed.yaml\n"
        "alignment: none\n"
        "data: {type: synthetic_sheet, image_width: 160, image_height: 120, focal_length: 131.25}\n"
        "graph: {spacing: 12}\n");
  return plan_experiment({write("small.yaml", "extends: base.yaml\n" + text), sets, {}, {PLIANT_EXPERIMENTS}},
                         registry_);
}

std::string ExperimentFiles::text_of(const std::string& name) const {
  const auto bytes = read_file(file(name));
  return {bytes.begin(), bytes.end()};
}

std::vector<std::string> keys_of(const nlohmann::ordered_json& object) {
  std::vector<std::string> names;
  for (const auto& item : object.items()) names.push_back(item.key());
  return names;
}

}  // namespace pliant::test
