#pragma once

#include <string>
#include <vector>

#include "framework/config/config_overlay.h"
#include "framework/config/config_tree.h"
#include "framework/core/parameters.h"

namespace pliant {

/// Whether the letter may stand in a folder's name on any system, and in a link: ASCII signs that mean
/// something to either may not.
bool is_of_folder_name(unsigned char letter);

/// Writes out the sweeps of an experiment: lists of values, each under the dotted key that takes them in
/// turn, become overrides with one value of each list; so do axes, partial experiments each under a name of
/// its own. The last list or axis changes fastest. Where the experiment has overrides already, each of them
/// is combined with all of that, and the values of the sweep win.
///
/// An override is named after its values, "method=fine,step=2" (behind the name of the one that it comes
/// from), with "_" for letters that no folder's name may have. Every value keeps its place. What is wrong
/// with a sweep is reported; the experiment is then of use only to find further errors.
void expand_sweeps(ConfigNode& experiment, const ParameterTable& root, const ConfigOverlay& overlay,
                   ConfigErrors& errors);

/// A value that a swept override has.
struct SweptValue {
  std::string name;  ///< of the key or axis; empty for the override that was swept
  std::string value;
  bool operator==(const SweptValue&) const = default;
};

/// What the name of a swept override tells, in its order.
std::vector<SweptValue> swept_values(const std::string& name);

}  // namespace pliant
