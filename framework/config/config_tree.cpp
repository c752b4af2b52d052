#include "framework/config/config_tree.h"

#include <algorithm>
#include <tuple>

#include <fmt/format.h>

namespace pliant {
namespace {

// Beyond this a list of errors helps nobody, and a hostile file could make it endless.
constexpr std::size_t max_errors = 200;
constexpr std::size_t max_shown_length = 80;

}  // namespace

std::string to_string(const ConfigMark& mark) {
  if (mark.origin->has_lines && mark.line > 0)
    return fmt::format("{}:{}:{}", mark.origin->name, mark.line, mark.column);
  return mark.origin->name;
}

const ConfigEntry* ConfigNode::find(const std::string& key) const {
  const auto entry =
      std::find_if(entries.begin(), entries.end(), [&](const ConfigEntry& e) { return e.key == key; });
  return entry == entries.end() ? nullptr : &*entry;
}

ConfigEntry* ConfigNode::find(const std::string& key) {
  return const_cast<ConfigEntry*>(static_cast<const ConfigNode*>(this)->find(key));
}

std::optional<ConfigEntry> ConfigNode::take(const std::string& key) {
  const auto entry =
      std::find_if(entries.begin(), entries.end(), [&](const ConfigEntry& e) { return e.key == key; });
  if (entry == entries.end()) return std::nullopt;
  ConfigEntry taken = std::move(*entry);
  entries.erase(entry);
  return taken;
}

std::vector<std::string> split_keys(const std::string& path) {
  std::vector<std::string> keys{""};
  for (const char letter : path) {
    if (letter == '.')
      keys.emplace_back();
    else
      keys.back() += letter;
  }
  const bool is_good = std::none_of(keys.begin(), keys.end(), [](const auto& key) { return key.empty(); });
  return is_good ? keys : std::vector<std::string>{};
}

ConfigNode under_keys(const std::vector<std::string>& keys, const ConfigMark& mark, ConfigNode value) {
  for (auto key = keys.rbegin(); key != keys.rend(); ++key) {
    ConfigNode section;
    section.kind = ConfigNode::Kind::map;
    section.mark = mark;
    section.entries.push_back({*key, mark, std::move(value)});
    value = std::move(section);
  }
  return value;
}

std::size_t count_nodes(const ConfigNode& node) {
  std::size_t count = 1;
  for (const auto& item : node.items) count += count_nodes(item);
  for (const auto& entry : node.entries) count += count_nodes(entry.value);
  return count;
}

std::string in_quotes(const std::string& text) {
  std::string shown = "'";
  for (const char letter : text.substr(0, max_shown_length)) {
    const auto code = static_cast<unsigned char>(letter);
    if (code < 0x20 || code == 0x7f)
      shown += fmt::format("\\x{:02x}", code);
    else
      shown += letter;
  }
  if (text.size() > max_shown_length) {
    // Do not end in the middle of a UTF-8 letter.
    std::size_t cut = max_shown_length;
    while (cut > 0 && (static_cast<unsigned char>(text[cut]) & 0xc0) == 0x80) {
      --cut;
      shown.pop_back();
    }
    shown += "...";
  }
  return shown + "'";
}

std::string shown(const ConfigNode& node) {
  switch (node.kind) {
    case ConfigNode::Kind::null:
      return "empty";
    case ConfigNode::Kind::list:
      return "a list";
    case ConfigNode::Kind::map:
      return "a section";
    default:
      return (node.quoted ? "the quoted text " : "") + in_quotes(node.text);
  }
}

void ConfigErrors::add(const ConfigMark& mark, const std::string& message) {
  std::string line = to_string(mark) + ": " + message;
  const bool known =
      std::any_of(errors_.begin(), errors_.end(), [&](const Item& item) { return item.line == line; });
  if (known) return;
  if (errors_.size() < max_errors)
    errors_.push_back({mark, std::move(line)});
  else
    ++dropped_;
}

void ConfigErrors::add_unexpected(const ConfigEntry& entry, const std::string& path,
                                  const std::string& expected) {
  // An empty value has no place of its own: the parser puts it where the next key begins.
  const ConfigMark& mark = entry.value.kind == ConfigNode::Kind::scalar ? entry.value.mark : entry.mark;
  add(mark, fmt::format("{} is {}; expected {}", in_quotes(path), shown(entry.value), expected));
}

void ConfigErrors::throw_if_any() const {
  if (errors_.empty()) return;
  std::vector<Item> sorted = errors_;
  std::stable_sort(sorted.begin(), sorted.end(), [](const Item& a, const Item& b) {
    return std::make_tuple(a.mark.origin->order, a.mark.line, a.mark.column) <
           std::make_tuple(b.mark.origin->order, b.mark.line, b.mark.column);
  });
  std::string message;
  for (const auto& item : sorted) message += (message.empty() ? "" : "\n") + item.line;
  if (dropped_ > 0) message += fmt::format("\n... and {} more errors", dropped_);
  throw ConfigError(message);
}

}  // namespace pliant
