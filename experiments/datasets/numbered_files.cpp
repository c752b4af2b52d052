#include "experiments/datasets/numbered_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "framework/core/error.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

bool is_digit(char letter) { return std::isdigit(static_cast<unsigned char>(letter)) != 0; }

/// The number that a text begins with, without zeros before it, taken off the text.
std::string_view take_number(std::string_view& text) {
  const auto end = std::find_if_not(text.begin(), text.end(), is_digit);
  std::string_view digits = text.substr(0, static_cast<std::size_t>(end - text.begin()));
  text.remove_prefix(digits.size());
  digits.remove_prefix(std::min(digits.find_first_not_of('0'), digits.size()));
  return digits;
}

}  // namespace

bool NaturalOrder::operator()(std::string_view a, std::string_view b) const {
  while (!a.empty() && !b.empty()) {
    if (is_digit(a.front()) && is_digit(b.front())) {
      const std::string_view number_a = take_number(a);
      const std::string_view number_b = take_number(b);
      if (number_a.size() != number_b.size()) return number_a.size() < number_b.size();
      if (number_a != number_b) return number_a < number_b;
    } else {
      if (a.front() != b.front()) return a.front() < b.front();
      a.remove_prefix(1);
      b.remove_prefix(1);
    }
  }
  return a.empty() && !b.empty();
}

FilesByKey matching_files(const std::string& folder, const std::string& pattern) {
  const fs::path whole = fs::path(folder) / pattern;
  const std::string name = whole.filename().string();
  const std::size_t star = name.find('*');
  const std::string before = name.substr(0, star);
  const std::string after = name.substr(star + 1);
  FilesByKey files;
  if (!fs::is_directory(whole.parent_path())) return files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(whole.parent_path(), error)) {
    const std::string found = entry.path().filename().string();
    if (found.size() < before.size() + after.size() || !found.starts_with(before) || !found.ends_with(after))
      continue;
    const std::string key = found.substr(before.size(), found.size() - before.size() - after.size());
    const auto [entry_of_key, is_new] = files.try_emplace(key, entry.path().lexically_normal().string());
    if (!is_new)
      throw DataError(fmt::format("{}: differs from {} in zeros only; which comes first?",
                                  entry.path().string(), entry_of_key->second));
  }
  if (error)
    throw DataError(fmt::format("{}: cannot be listed: {}", whole.parent_path().string(), error.message()));
  return files;
}

}  // namespace pliant
