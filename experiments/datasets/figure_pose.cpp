#include "experiments/datasets/figure_pose.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <optional>
#include <set>

#include "framework/core/error.h"
#include "framework/core/nearest.h"

namespace pliant {
namespace {

constexpr std::size_t most_names_told = 40;

struct Word {
  std::string name;
  double value = 0;
};

std::optional<Word> parse(const std::string& text) {
  const std::size_t equals = text.rfind('=');
  if (equals == std::string::npos) return std::nullopt;
  Word word{text.substr(0, equals)};
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data() + equals + 1, end, word.value);
  if (error != std::errc() || stop != end || !std::isfinite(word.value)) return std::nullopt;
  return word;
}

template <class Named>
std::optional<std::size_t> find(const std::vector<Named>& list, const std::string& name) {
  const auto found =
      std::find_if(list.begin(), list.end(), [&](const Named& item) { return item.name == name; });
  if (found == list.end()) return std::nullopt;
  return static_cast<std::size_t>(found - list.begin());
}

/// Which of a joint's angles a name like "index_1.x" means.
struct JointAxis {
  std::size_t joint = 0;
  Eigen::Index axis = 0;
};

std::optional<JointAxis> find_axis(const std::vector<Joint>& joints, const std::string& name) {
  if (name.size() < 3 || name[name.size() - 2] != '.') return std::nullopt;
  const std::size_t axis = std::string("xyz").find(name.back());
  const auto joint = find(joints, name.substr(0, name.size() - 2));
  if (axis == std::string::npos || !joint) return std::nullopt;
  return JointAxis{*joint, static_cast<Eigen::Index>(axis)};
}

/// Adds what a word asks for; false when the figure has nothing of that name.
bool add(const Figure& figure, const Word& word, FigurePose& pose) {
  if (const auto named = find(figure.poses, word.name))
    add_pose(figure.mesh, figure.poses[*named], word.value, pose);
  else if (const auto target = find(figure.mesh.targets, word.name))
    pose.weights[*target] += word.value;
  else if (const auto turned = find_axis(figure.mesh.joints, word.name))
    pose.degrees[turned->joint][turned->axis] += word.value;
  else
    return false;
  return true;
}

std::vector<std::string> all_names(const Figure& figure) {
  std::vector<std::string> names;
  for (const NamedPose& pose : figure.poses) names.push_back(pose.name);
  for (const MorphTarget& target : figure.mesh.targets) names.push_back(target.name);
  for (const Joint& joint : figure.mesh.joints)
    for (const char axis : {'x', 'y', 'z'}) names.push_back(fmt::format("{}.{}", joint.name, axis));
  return names;
}

[[noreturn]] void throw_unknown(const Figure& figure, const std::string& name, const std::string& place) {
  const std::vector<std::string> names = all_names(figure);
  std::string expected = "none, for there is nothing that moves";
  if (names.size() > most_names_told)
    expected = fmt::format("one of {} names", names.size());
  else if (!names.empty())
    expected = fmt::format("one of {}", fmt::join(names, ", "));
  throw ConfigError(fmt::format("{} names '{}', which is no pose, morph target or angle; expected {}{}",
                                place, name, expected, suggestion(name, names)));
}

}  // namespace

FigurePose read_pose(const Figure& figure, const std::vector<std::string>& words, const std::string& place) {
  FigurePose pose = rest_of(figure.mesh);
  std::set<std::string> given;
  for (const std::string& text : words) {
    const auto word = parse(text);
    if (!word)
      throw ConfigError(fmt::format("{} has '{}'; expected name=value, as in smile=0.5", place, text));
    if (!given.insert(word->name).second)
      throw ConfigError(fmt::format("{} gives '{}' twice; expected it once", place, word->name));
    if (!add(figure, *word, pose)) throw_unknown(figure, word->name, place);
  }
  return pose;
}

std::string name_of_pose(const std::vector<std::string>& words) {
  return words.empty() ? "neutral" : fmt::format("{}", fmt::join(words, " "));
}

FigurePose between(const FigurePose& from, const FigurePose& to, double share) {
  FigurePose pose = from;
  for (std::size_t i = 0; i < pose.weights.size(); ++i)
    pose.weights[i] += share * (to.weights[i] - from.weights[i]);
  for (std::size_t i = 0; i < pose.degrees.size(); ++i)
    pose.degrees[i] += share * (to.degrees[i] - from.degrees[i]);
  return pose;
}

}  // namespace pliant
