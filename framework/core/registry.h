#pragma once

#include <any>
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "framework/core/parameters.h"

namespace pliant {

/// What the world may know of a component: its documentation is made of this and nothing else.
struct ComponentInfo {
  std::string kind;  ///< e.g. "energy"
  std::string name;  ///< e.g. "rotation", the word in experiment files
  std::string doc;   ///< one line
  ParameterTable parameters;
};

/// The components that experiment files can name. Filled by explicit lists (`register_energies(registry)`
/// and its like), never by static constructors, so that what is in it and in which order can be read.
class Registry {
 public:
  template <class Interface>
  using Factory = std::function<std::unique_ptr<Interface>(const Parameters&, const Registry&)>;

  /// Adds a component of kind `Interface::kind`.
  /// Throws std::logic_error when the name is taken.
  template <class Interface>
  void add(std::string name, std::string doc, ParameterTable parameters, Factory<Interface> factory) {
    insert({Interface::kind, std::move(name), std::move(doc), std::move(parameters)}, std::move(factory));
  }

  /// Makes the component that `section` configures.
  template <class Interface>
  std::unique_ptr<Interface> make(const Parameters& section) const {
    const auto& entry = at(Interface::kind, section.component());
    return std::any_cast<const Factory<Interface>&>(entry.factory)(section, *this);
  }

  /// The kinds in the order in which their first component was added.
  std::vector<std::string> kinds() const;
  /// The components of a kind in the order in which they were added (empty for an unknown kind).
  std::vector<const ComponentInfo*> components(const std::string& kind) const;
  /// Null when there is none.
  const ComponentInfo* find(const std::string& kind, const std::string& name) const;

 private:
  struct Entry {
    ComponentInfo info;
    std::any factory;
  };
  void insert(ComponentInfo info, std::any factory);
  const Entry& at(const std::string& kind, const std::string& name) const;

  std::vector<std::unique_ptr<Entry>> entries_;
};

}  // namespace pliant
