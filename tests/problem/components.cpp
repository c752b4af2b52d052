#include "tests/problem/components.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "framework/config/config.h"

namespace pliant::test {

Parameters section_of(const Registry& registry, const std::string& kind, const std::string& yaml) {
  const auto file =
      std::filesystem::temp_directory_path() / ("pliant_component_" + std::to_string(getpid()) + ".yaml");
  std::ofstream(file) << "made: " << yaml << "\n";
  const auto experiment = load_experiment({file, {}, {}}, {component("made", kind)}, registry);
  std::filesystem::remove(file);
  return experiment.values.section("made");
}

std::vector<Energy> all_energies(const Registry& registry) {
  std::vector<Energy> energies;
  for (const auto* info : registry.components(Energy::kind))
    energies.push_back(*make<Energy>(registry, "{type: " + info->name + "}"));
  return energies;
}

}  // namespace pliant::test
