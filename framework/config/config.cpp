#include "framework/config/config.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "framework/config/config_overlay.h"
#include "framework/config/config_overrides.h"
#include "framework/config/config_reader.h"
#include "framework/config/config_resolver.h"
#include "framework/config/config_sweep.h"
#include "framework/config/config_tree.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using Kind = ConfigNode::Kind;

constexpr std::size_t max_file_size = std::size_t{1} << 20;
constexpr int any_line = std::numeric_limits<int>::max();

/// What an experiment is read from, or why it cannot be.
struct Document {
  std::string text;
  std::string problem;
  const char* what = "the file";
};

Document limited(std::string text) {
  if (text.size() > max_file_size)
    return {"", fmt::format("more than {} bytes; expected an experiment", max_file_size)};
  return {std::move(text), ""};
}

Document read_file(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (!fs::exists(status)) return {"", "the file does not exist"};
  if (fs::is_directory(status)) return {"", "is a folder; expected a YAML file"};
  std::ifstream stream(file, std::ios::binary);
  std::string text(max_file_size + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (!stream.is_open() || stream.bad()) return {"", "the file cannot be read"};
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return limited(std::move(text));
}

/// The one name of a file; the path as it is where the file system cannot say.
fs::path canonical_name(const fs::path& file) {
  std::error_code error;
  const fs::path name = fs::weakly_canonical(file, error);
  return error ? file : name;
}

/// Reads an experiment and, beneath it, the files that it extends.
class FileLoader {
 public:
  /// All of them must outlive this.
  FileLoader(const ParameterTable& root, const ConfigOverlay& overlay, const ConfigSource& source,
             ConfigErrors& errors)
      : root_(root), overlay_(overlay), source_(source), errors_(errors) {}

  /// Empty when the file or one beneath it cannot be used; why is then among the errors.
  std::optional<ConfigNode> load(const fs::path& file) {
    const auto origin = new_origin(file.string(), fs::absolute(file).parent_path(), file.parent_path());
    return load(file, origin, {origin, 0, 0}, "");
  }

  std::optional<ConfigNode> load(const ConfigText& text) {
    return load(text.text, new_origin(text.name, fs::current_path() / text.folder, text.folder), {});
  }

  const std::vector<fs::path>& files() const { return files_; }
  /// How many files and texts were named.
  int origins() const { return origins_; }

 private:
  struct Link {
    std::string shown;
    fs::path canonical;  ///< of a base text its path; empty for another text, which nothing can extend
  };

  std::shared_ptr<const ConfigOrigin> new_origin(std::string name, fs::path folder, fs::path shown_folder) {
    return std::make_shared<const ConfigOrigin>(
        ConfigOrigin{std::move(name), std::move(folder), true, origins_++, std::move(shown_folder)});
  }

  /// Problems of the file as a whole are told at `named`, where it is named, and begin with `prefix`.
  std::optional<ConfigNode> load(const fs::path& file, const std::shared_ptr<const ConfigOrigin>& origin,
                                 const ConfigMark& named, const std::string& prefix) {
    auto tree = read(read_file(file), origin, named, prefix);
    if (!tree) return {};
    files_.push_back(canonical_name(file));
    return extended(std::move(*tree), {origin->name, files_.back()});
  }

  std::optional<ConfigNode> load(const std::string& text, const std::shared_ptr<const ConfigOrigin>& origin,
                                 const fs::path& canonical) {
    Document document = limited(text);
    document.what = "the text";
    auto tree = read(document, origin, {origin, 0, 0}, "");
    if (!tree) return {};
    return extended(std::move(*tree), {origin->name, canonical});
  }

  std::optional<ConfigNode> read(const Document& document, const std::shared_ptr<const ConfigOrigin>& origin,
                                 const ConfigMark& named, const std::string& prefix) {
    if (!document.problem.empty()) {
      errors_.add(named, prefix + document.problem);
      return {};
    }
    auto tree = read_yaml(document.text, origin, errors_);
    if (!tree) return {};
    tree->mark = {origin, 1, 1};
    if (tree->kind == Kind::scalar && report_slip(document.text, any_line, origin, errors_)) return {};
    if (tree->kind == Kind::map) return tree;
    errors_.add(tree->mark, fmt::format("{}; expected the keys of an experiment",
                                        tree->kind == Kind::null ? document.what + std::string(" is empty")
                                                                 : "not a map"));
    return {};
  }

  /// `tree` laid over what it extends; `link` is what it was read from.
  std::optional<ConfigNode> extended(ConfigNode tree, Link link) {
    chain_.push_back(std::move(link));
    extend_overrides(tree);
    const auto extends = tree.take("extends");
    auto base = extends ? load_base(*extends) : std::nullopt;
    chain_.pop_back();
    if (!extends) return tree;
    if (base) overlay_.lay_over(*base, tree, {});
    return base;
  }

  /// Lays the overrides of a file, also those of a sweep, over what they extend.
  void extend_overrides(ConfigNode& tree) {
    for (const auto& row : root_.rows()) {
      if (row.type() != ParameterType::overrides) continue;
      if (ConfigEntry* overrides = tree.find(row.name())) extend_each(overrides->value);
      ConfigEntry* sweep = row.swept_by().empty() ? nullptr : tree.find(row.swept_by());
      if (sweep == nullptr) continue;
      for (auto& axis : sweep->value.entries) extend_each(axis.value);
    }
  }

  void extend_each(ConfigNode& overrides) {
    for (auto& part : overrides.entries) {
      const auto extends = part.value.take("extends");
      if (!extends) continue;
      auto base = load_base(*extends);
      if (!base || has_overrides(*base, *extends)) continue;
      overlay_.lay_over(*base, part.value, {});
      part.value = std::move(*base);
    }
  }

  /// Whether an override extends an experiment that has some itself, which is told.
  bool has_overrides(const ConfigNode& base, const ConfigEntry& extends) {
    for (const auto& row : root_.rows()) {
      if (row.type() != ParameterType::overrides) continue;
      for (const std::string& key : {row.name(), row.swept_by()}) {
        if (key.empty() || base.find(key) == nullptr) continue;
        errors_.add(extends.mark, fmt::format("{} has {}; expected an experiment of one run",
                                              in_quotes(extends.value.text), in_quotes(key)));
        return true;
      }
    }
    return false;
  }

  std::optional<ConfigNode> load_base(const ConfigEntry& extends) {
    const ConfigNode& value = extends.value;
    if (value.kind != Kind::scalar || value.text.empty()) {
      errors_.add(extends.mark, "'extends' names no file; expected the path of a YAML file");
      return {};
    }
    const ConfigOrigin& here = *value.mark.origin;
    const fs::path within = here.folder.empty() ? here.shown_folder : "";  // of a base text
    const fs::path name = (within / value.text).lexically_normal();
    if (const auto text = source_.base_texts.find(name.string()); text != source_.base_texts.end()) {
      if (goes_in_circle(name, value.mark)) return {};
      return load(text->second, new_origin(name.string(), "", name.parent_path()), name);
    }
    const fs::path beside = (here.folder / value.text).lexically_normal();
    const fs::path file = find_base(beside, value.text);
    if (goes_in_circle(canonical_name(file), value.mark)) return {};
    const fs::path shown = file == beside ? (here.shown_folder / value.text).lexically_normal() : file;
    const auto origin = new_origin(shown.string(), file.parent_path(), shown.parent_path());
    return load(file, origin, value.mark, "cannot extend " + in_quotes(file.string()) + ": ");
  }

  /// `beside` unless the file is not there but in one of the base folders.
  fs::path find_base(const fs::path& beside, const fs::path& text) const {
    std::error_code error;
    if (text.is_absolute() || fs::exists(beside, error)) return beside;
    for (const auto& folder : source_.base_folders) {
      fs::path candidate = fs::absolute(folder / text).lexically_normal();
      if (fs::exists(candidate, error)) return candidate;
    }
    return beside;
  }

  /// Whether extending the file or base text would close a circle, "a.yaml -> b.yaml -> a.yaml"; told at
  /// `mark`.
  bool goes_in_circle(const fs::path& canonical, const ConfigMark& mark) {
    std::string chain;
    for (const auto& link : chain_) chain += link.shown + " -> ";
    for (const auto& link : chain_) {
      if (link.canonical != canonical) continue;
      errors_.add(mark, "'extends' goes in a circle: " + chain + link.shown);
      return true;
    }
    return false;
  }

  const ParameterTable& root_;
  const ConfigOverlay& overlay_;
  const ConfigSource& source_;
  ConfigErrors& errors_;
  std::vector<Link> chain_;
  std::vector<fs::path> files_;  ///< that were read
  int origins_ = 0;
};

/// One `--set` as an experiment that gives this one value.
std::optional<ConfigNode> read_set(const std::string& set, int order, ConfigErrors& errors) {
  const auto equals = set.find('=');
  const std::string path = set.substr(0, equals);
  const auto origin =
      std::make_shared<const ConfigOrigin>(ConfigOrigin{"--set " + path, fs::current_path(), false, order});
  const ConfigMark mark{origin, 0, 0};
  const auto keys = split_keys(path);
  if (equals == std::string::npos || keys.empty() || !is_utf8(path)) {
    errors.add(mark, "not understood; expected KEY=VALUE with a key like a.b.c");
    return {};
  }
  if (keys.front() == "extends") {
    errors.add(mark, "'extends' cannot be set; expected it in an experiment file");
    return {};
  }
  auto value = read_yaml(set.substr(equals + 1), origin, errors);
  if (!value) return {};
  value->mark.origin = origin;
  return under_keys(keys, mark, std::move(*value));
}

void lay_sets_over(ConfigNode& tree, const std::vector<std::string>& sets, int order,
                   const ConfigOverlay& overlay, ConfigErrors& errors) {
  ConfigNode all;
  all.kind = Kind::map;
  for (const auto& set : sets) {
    if (const auto one = read_set(set, order++, errors))
      overlay.lay_over(all, *one, {.fragments = true, .keep_places = false});
  }
  overlay.lay_over(tree, all, {.fragments = false, .keep_places = true});
}

/// The keys of an experiment file that are gone before the experiment is resolved.
std::vector<std::string> file_keys(const ParameterTable& root) {
  std::vector<std::string> keys;
  for (const auto& row : root.rows()) {
    if (!row.swept_by().empty()) keys.push_back(row.swept_by());
  }
  keys.emplace_back("extends");
  return keys;
}

/// Whether YAML takes the bare text for nothing but this text.
bool is_plain(const std::string& text) {
  if (text.empty() || !(std::isalpha(static_cast<unsigned char>(text.front())) != 0 || text.front() == '/'))
    return false;
  const bool is_tame = std::all_of(text.begin(), text.end(), [](unsigned char letter) {
    return std::isalnum(letter) != 0 || letter == '/' || letter == '_' || letter == '-' || letter == '.';
  });
  std::string lower = text;
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  for (const char* word : {"true", "false", "null", "yes", "no", "on", "off", "y", "n"})
    if (lower == word) return false;
  return is_tame;
}

std::string yaml_scalar(const ordered_json& value) {
  if (value.is_number_float()) {
    std::string text = fmt::format("{}", value.get<double>());
    // A real number shall look like one to whoever reads the file next.
    return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
  }
  if (value.is_string() && is_plain(value.get_ref<const std::string&>())) return value.get<std::string>();
  // What JSON escapes in a text, YAML escapes the same way.
  return value.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

void write_yaml(const ordered_json& map, const std::string& indent, std::string& yaml) {
  for (const auto& [key, value] : map.items()) {
    yaml += indent + yaml_scalar(key) + ":";
    if (value.is_object() && !value.empty()) {
      yaml += "\n";
      write_yaml(value, indent + "  ", yaml);
    } else if (value.is_array()) {
      std::string items;
      for (const auto& item : value) items += (items.empty() ? "" : ", ") + yaml_scalar(item);
      yaml += " [" + items + "]\n";
    } else {
      yaml += " " + yaml_scalar(value) + "\n";
    }
  }
}

}  // namespace

std::string ConfigSource::name() const {
  if (const auto* text = std::get_if<ConfigText>(&from)) return text->name;
  return std::get<fs::path>(from).string();
}

std::string Experiment::to_yaml() const {
  std::string yaml;
  write_yaml(tree, "", yaml);
  return yaml;
}

Experiment load_experiment(const ConfigSource& source, const ParameterTable& root, const Registry& registry) {
  ConfigErrors errors;
  const ConfigOverlay overlay(root, registry);
  FileLoader loader(root, overlay, source, errors);
  auto tree = std::visit([&](const auto& from) { return loader.load(from); }, source.from);
  if (!tree) errors.throw_if_any();
  lay_sets_over(*tree, source.sets, loader.origins(), overlay, errors);
  expand_sweeps(*tree, root, overlay, errors);
  ConfigResolver resolver(root, registry, source.data_folders, errors);
  ResolvedSection resolved =
      resolver.experiment(complete_overrides(*tree, root, overlay, errors), file_keys(root));
  errors.throw_if_any();
  keep_given_overrides(resolved.tree, *tree, root);
  std::vector<fs::path> files = loader.files();
  files.insert(files.end(), resolver.files().begin(), resolver.files().end());
  return {std::move(resolved.values), std::move(resolved.tree), std::move(files)};
}

}  // namespace pliant
