#include "framework/core/registry.h"

#include <algorithm>

namespace pliant {
std::vector<std::string> Registry::kinds() const {
  std::vector<std::string> kinds;
  for (const auto& entry : entries_) {
    const auto& kind = entry->info.kind;
    if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end()) kinds.push_back(kind);
  }
  return kinds;
}

std::vector<const ComponentInfo*> Registry::components(const std::string& kind) const {
  std::vector<const ComponentInfo*> found;
  for (const auto& entry : entries_) {
    if (entry->info.kind == kind) found.push_back(&entry->info);
  }
  return found;
}

const ComponentInfo* Registry::find(const std::string& kind, const std::string& name) const {
  for (const auto& entry : entries_) {
    if (entry->info.kind == kind && entry->info.name == name) return &entry->info;
  }
  return nullptr;
}

void Registry::insert(ComponentInfo info, std::any factory) {
  const std::string who = info.kind + " '" + info.name + "'";
  if (find(info.kind, info.name) != nullptr) throw std::logic_error(who + " is registered twice");
  if (info.parameters.find("type") != nullptr)
    throw std::logic_error(who + " has a parameter 'type', the key that names the component itself");
  // They lie over the whole experiment, the component's own section included, and would never end.
  const auto& rows = info.parameters.rows();
  if (std::any_of(rows.begin(), rows.end(), holds_overrides))
    throw std::logic_error(who + " may not have overrides");
  entries_.push_back(std::make_unique<Entry>(Entry{std::move(info), std::move(factory)}));
}

const Registry::Entry& Registry::at(const std::string& kind, const std::string& name) const {
  for (const auto& entry : entries_) {
    if (entry->info.kind == kind && entry->info.name == name) return *entry;
  }
  throw std::logic_error("no " + kind + " '" + name + "' is registered");
}

}  // namespace pliant
