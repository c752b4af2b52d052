#pragma once

#include <map>
#include <string>
#include <string_view>

namespace pliant {

/// Whether a text stands before another one where numbers in them count as such: `a2` before `a10`. Texts
/// that differ in zeros before numbers only are alike.
struct NaturalOrder {
  bool operator()(std::string_view a, std::string_view b) const;
};

/// Files of one kind, by what tells them apart.
using FilesByKey = std::map<std::string, std::string, NaturalOrder>;

/// The files in `folder` whose path below it fits `pattern`, which has one `*` in its last part, as
/// "depth/*.png": what the star stands for, and the whole path. Empty where the folder does not exist. Throws
/// DataError when it cannot be listed or when two files differ in zeros only.
FilesByKey matching_files(const std::string& folder, const std::string& pattern);

}  // namespace pliant
