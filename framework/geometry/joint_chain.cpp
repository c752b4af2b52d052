#include "framework/geometry/joint_chain.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <map>
#include <utility>

namespace pliant {
namespace {

using Words = std::vector<std::string>;

/// The words of a name in lower case, in the order of the alphabet.
Words words_of(const std::string& name) {
  Words words;
  bool is_inside = false;
  bool was_lower = false;
  for (const char letter : name) {
    const auto code = static_cast<unsigned char>(letter);
    const bool is_gap = letter == '-' || letter == '_' || letter == '.' || std::isspace(code) != 0;
    const bool is_upper = std::isupper(code) != 0;
    if (!is_gap) {
      if (!is_inside || (was_lower && is_upper)) words.emplace_back();
      words.back() += static_cast<char>(std::tolower(code));
    }
    is_inside = !is_gap;
    was_lower = !is_gap && !is_upper;
  }
  std::sort(words.begin(), words.end());
  return words;
}

/// A joint's place in a chain: which chain, and where.
struct Place {
  Words chain;
  std::size_t order = 0;
};

constexpr std::array<const char*, 5> bones{"metacarpal", "proximal", "intermediate", "distal", "tip"};

/// None (an empty chain's order past the last bone) for what is no bone.
bool bone_place(const std::string& name, Place& place) {
  place.chain = words_of(name);
  std::erase(place.chain, "phalanx");
  for (std::size_t i = 0; i < bones.size(); ++i) {
    if (std::erase(place.chain, bones[i]) == 0) continue;
    place.order = i;
    return true;
  }
  return false;
}

/// A name without a number is before those that have one.
Place numbered_place(const std::string& name) {
  const std::size_t end = name.find_last_not_of("0123456789") + 1;
  constexpr std::size_t longest = 9;  // digits
  if (end == name.size() || name.size() - end > longest) return {{name}, 0};
  std::string stem = name.substr(0, end);
  while (!stem.empty() && (stem.back() == '_' || stem.back() == '.' || stem.back() == '-')) stem.pop_back();
  return {{stem}, 1 + std::stoul(name.substr(end))};
}

class Chains {
 public:
  Chains(const std::vector<std::string>& names, const std::vector<int>& parents)
      : names_(names), parents_(parents), chained_(parents) {}

  std::vector<int> build() {
    std::map<int, std::vector<int>> children;
    for (std::size_t i = 0; i < parents_.size(); ++i) children[parents_[i]].push_back(static_cast<int>(i));
    for (const auto& [parent, siblings] : children)
      if (parent >= 0) chain(siblings);
    return std::move(chained_);
  }

 private:
  /// By chain, then by order within it.
  using Links = std::map<Words, std::map<std::size_t, int>>;

  const std::string& name(int joint) const { return names_[static_cast<std::size_t>(joint)]; }

  void chain(const std::vector<int>& siblings) {
    Links numbered;
    Links fingers;
    for (const int joint : siblings) {
      Place place;
      const bool is_bone = bone_place(name(joint), place);
      if (!is_bone) place = numbered_place(name(joint));
      (is_bone ? fingers : numbered)[place.chain].emplace(place.order, joint);
    }
    for (const auto& [words, links] : numbered) hang_together(links);
    for (const auto& [words, links] : fingers) {
      hang_together(links);
      hang_on_wrist(links.begin()->second, words, siblings);
    }
  }

  void hang_together(const std::map<std::size_t, int>& links) {
    for (auto link = links.begin(); std::next(link) != links.end(); ++link)
      chained_[static_cast<std::size_t>(std::next(link)->second)] = link->second;
  }

  void hang_on_wrist(int joint, const Words& chain, const std::vector<int>& siblings) {
    for (const int wrist : siblings) {
      Words others = words_of(name(wrist));
      if (std::erase(others, "wrist") == 0) continue;
      if (!std::includes(chain.begin(), chain.end(), others.begin(), others.end())) continue;
      chained_[static_cast<std::size_t>(joint)] = wrist;
      return;
    }
  }

  const std::vector<std::string>& names_;
  const std::vector<int>& parents_;
  std::vector<int> chained_;
};

}  // namespace

std::vector<int> chained_parents(const std::vector<std::string>& names, const std::vector<int>& parents) {
  return Chains(names, parents).build();
}

}  // namespace pliant
