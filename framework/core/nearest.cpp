#include "framework/core/nearest.h"

#include <algorithm>
#include <cctype>

namespace pliant {
namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return text;
}

/// How many edits still count as a slip of the fingers for words of this length.
std::size_t tolerance(std::size_t length) { return std::max<std::size_t>(1, length / 3); }

std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before_last(b.size() + 1);
  std::vector<std::size_t> last(b.size() + 1);
  std::vector<std::size_t> current(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) current[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before_last.swap(last);
    last.swap(current);
    current[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      current[j] = std::min({last[j] + 1, current[j - 1] + 1, replaced});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) current[j] = std::min(current[j], before_last[j - 2] + 1);
    }
  }
  return current[b.size()];
}

}  // namespace

std::string nearest(const std::string& word, const std::vector<std::string>& choices) {
  const std::string wanted = lower(word);
  std::string best;
  std::size_t best_distance = 0;
  for (const auto& choice : choices) {
    const std::size_t longer = std::max(word.size(), choice.size());
    const std::size_t shorter = std::min(word.size(), choice.size());
    // Words of very different length are never near; skipping them keeps huge keys cheap.
    if (longer - shorter > tolerance(longer)) continue;
    const std::size_t distance = edit_distance(wanted, lower(choice));
    if (distance > tolerance(longer) || distance >= longer) continue;
    if (best.empty() || distance < best_distance) {
      best = choice;
      best_distance = distance;
    }
  }
  return best;
}

std::string suggestion(const std::string& word, const std::vector<std::string>& choices) {
  const std::string near = nearest(word, choices);
  return near.empty() ? "" : "; did you mean '" + near + "'?";
}

}  // namespace pliant
