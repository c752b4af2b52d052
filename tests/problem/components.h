#pragma once

#include <memory>
#include <string>
#include <vector>

#include "framework/core/parameters.h"
#include "framework/core/registry.h"
#include "framework/problem/energy.h"

namespace pliant::test {

/// What an experiment file would make of a component of `kind` written as `yaml`, e.g.
/// `{type: ceres_lm, threads: 1}`; defaults are filled in.
Parameters section_of(const Registry& registry, const std::string& kind, const std::string& yaml);

template <class Interface>
std::unique_ptr<Interface> make(const Registry& registry, const std::string& yaml) {
  return registry.make<Interface>(section_of(registry, Interface::kind, yaml));
}

/// Every registered energy as it is by default.
std::vector<Energy> all_energies(const Registry& registry);

}  // namespace pliant::test
