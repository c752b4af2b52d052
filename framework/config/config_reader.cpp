#include "framework/config/config_reader.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <sstream>
#include <vector>

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

namespace pliant {
namespace {

// Far above any experiment; they keep nested aliases and endless brackets from eating the machine.
constexpr std::size_t max_nodes = 20000;
constexpr std::size_t max_depth = 64;
constexpr std::size_t max_key_length = 200;

/// How many bytes the UTF-8 letter that begins at `at` has; 0 where there is no proper one.
std::size_t letter_size(const std::string& text, std::size_t at) {
  const auto byte = [&](std::size_t i) -> unsigned {
    return at + i < text.size() ? static_cast<unsigned char>(text[at + i]) : 0;
  };
  if (byte(0) < 0x80) return 1;
  const std::size_t size = byte(0) >= 0xf0 ? 4 : byte(0) >= 0xe0 ? 3 : 2;
  unsigned letter = byte(0) & (0xffu >> (size + 1));
  for (std::size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return 0;
    letter = letter << 6 | (byte(i) & 0x3f);
  }
  // The smallest letter that needs so many bytes: a shorter one spelt long is not proper.
  constexpr std::array<unsigned, 5> smallest{0, 0, 0x80, 0x800, 0x10000};
  const bool is_surrogate = letter >= 0xd800 && letter < 0xe000;
  const bool is_proper = byte(0) >= 0xc0 && byte(0) < 0xf8 && letter >= smallest[size] && letter <= 0x10ffff;
  return is_proper && !is_surrogate ? size : 0;
}

/// Where the first byte stands that is not UTF-8; the size of the text where there is none.
std::size_t first_not_utf8(const std::string& text) {
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t size = letter_size(text, at);
    if (size == 0) return at;
    at += size;
  }
  return at;
}

/// Columns in letters: yaml-cpp counts bytes, an editor does not.
class Columns {
 public:
  explicit Columns(const std::string& text) : letters_(text.size() + 1) {
    for (std::size_t i = 0; i < text.size(); ++i)
      letters_[i + 1] = letters_[i] + ((static_cast<unsigned char>(text[i]) & 0xc0) != 0x80 ? 1 : 0);
  }

  /// The column, from 1, of a mark of the text.
  int of(const YAML::Mark& mark) const {
    const bool is_inside = mark.column <= mark.pos && mark.pos < static_cast<int>(letters_.size());
    if (!is_inside) return mark.column + 1;
    return letters_[mark.pos] - letters_[mark.pos - mark.column] + 1;
  }

 private:
  std::vector<int> letters_;  ///< how many begin before each byte
};

struct KeyAndValue {
  std::string key, value;
};

/// The two halves of "key:value", which YAML takes for one word. Where a slash follows it is the name of a
/// place, as in "http://".
std::optional<KeyAndValue> glued_pair(const std::string& word) {
  const auto is_of_key = [](unsigned char letter) { return std::isalnum(letter) != 0 || letter == '_'; };
  const auto colon =
      static_cast<std::size_t>(std::find_if_not(word.begin(), word.end(), is_of_key) - word.begin());
  if (colon == 0 || colon + 1 >= word.size() || word[colon] != ':') return std::nullopt;
  if (std::isdigit(static_cast<unsigned char>(word.front())) != 0) return std::nullopt;
  const std::string value = word.substr(colon + 1);
  if (std::string(" \t\r/\\").find(value.front()) != std::string::npos) return std::nullopt;
  return KeyAndValue{word.substr(0, colon), value};
}

std::string glued_message(const KeyAndValue& pair) {
  return fmt::format("no space after the colon of {}; expected {}", in_quotes(pair.key),
                     in_quotes(pair.key + ": " + pair.value));
}

/// YAML that is well-formed and yet no experiment.
struct Refused {
  ConfigMark mark;
  std::string why;
};

/// Builds the tree from the parser's events: unlike YAML::Node they show keys that stand twice.
class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(const std::string& text, std::shared_ptr<const ConfigOrigin> origin, ConfigErrors& errors)
      : columns_(text), origin_(std::move(origin)), errors_(errors) {}

  ConfigNode take() { return std::move(root_); }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (seen_document_) throw Refused{place(mark), "a second document begins; expected only one"};
    seen_document_ = true;
  }
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    finish({make(ConfigNode::Kind::null, mark), anchor});
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto found = anchors_.find(anchor);
    if (found == anchors_.end()) throw Refused{place(mark), "an alias stands inside its own anchor"};
    count(mark, found->second.size);
    add(ConfigNode(found->second.node));
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    check_tag(mark, tag);
    ConfigNode node = make(ConfigNode::Kind::scalar, mark);
    node.text = value;
    node.quoted = tag == "!";
    finish({std::move(node), anchor});
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value /*style*/) override {
    open(ConfigNode::Kind::list, mark, tag, anchor);
  }
  void OnSequenceEnd() override { close(); }

  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value /*style*/) override {
    open(ConfigNode::Kind::map, mark, tag, anchor);
  }
  void OnMapEnd() override { close(); }

  ConfigMark place(const YAML::Mark& mark) const { return {origin_, mark.line + 1, columns_.of(mark)}; }

 private:
  struct Key {
    std::string text;
    ConfigMark mark;
  };
  struct Frame {
    ConfigNode node;
    YAML::anchor_t anchor = 0;
    bool has_key = false;  ///< a key has been read and its value comes next
    Key key;
    std::map<std::string, ConfigMark> keys;
  };
  struct Anchored {
    ConfigNode node;
    std::size_t size = 0;
  };

  void check_tag(const YAML::Mark& mark, const std::string& tag) const {
    if (!tag.empty() && tag != "?" && tag != "!")
      throw Refused{place(mark), "the tag " + in_quotes(tag) + " is not supported"};
  }

  ConfigNode make(ConfigNode::Kind kind, const YAML::Mark& mark) {
    count(mark, 1);
    ConfigNode node;
    node.kind = kind;
    node.mark = place(mark);
    return node;
  }

  void count(const YAML::Mark& mark, std::size_t nodes) {
    nodes_ += nodes;
    if (nodes_ > max_nodes)
      throw Refused{place(mark), fmt::format("more than {} values; expected an experiment", max_nodes)};
  }

  void open(ConfigNode::Kind kind, const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor) {
    check_tag(mark, tag);
    if (stack_.size() >= max_depth)
      throw Refused{place(mark), fmt::format("nested more than {} levels deep", max_depth)};
    Frame frame;
    frame.node = make(kind, mark);
    frame.anchor = anchor;
    stack_.push_back(std::move(frame));
  }

  void close() {
    Frame frame = std::move(stack_.back());
    stack_.pop_back();
    finish({std::move(frame.node), frame.anchor});
  }

  struct Finished {
    ConfigNode node;
    YAML::anchor_t anchor;
  };

  void finish(Finished finished) {
    if (finished.anchor != 0) anchors_[finished.anchor] = {finished.node, count_nodes(finished.node)};
    add(std::move(finished.node));
  }

  void add(ConfigNode node) {
    if (stack_.empty()) {
      root_ = std::move(node);
      return;
    }
    Frame& frame = stack_.back();
    if (frame.node.kind == ConfigNode::Kind::list)
      frame.node.items.push_back(std::move(node));
    else if (!frame.has_key)
      begin_entry(frame, std::move(node));
    else
      end_entry(frame, std::move(node));
  }

  static void begin_entry(Frame& frame, ConfigNode key) {
    if (key.kind != ConfigNode::Kind::scalar || key.text.empty())
      throw Refused{key.mark, "a key is missing or no word; expected 'key: value'"};
    if (key.text.size() > max_key_length)
      throw Refused{key.mark, fmt::format("a key of more than {} letters", max_key_length)};
    frame.key = {std::move(key.text), key.mark};
    frame.has_key = true;
  }

  void end_entry(Frame& frame, ConfigNode value) {
    frame.has_key = false;
    if (const auto pair = glued_pair(frame.key.text); pair && value.kind == ConfigNode::Kind::null) {
      errors_.add(frame.key.mark, glued_message(*pair));
      frame.key.text = pair->key;
      value.kind = ConfigNode::Kind::scalar;
      value.text = pair->value;
    }
    const auto [first, is_new] = frame.keys.emplace(frame.key.text, frame.key.mark);
    if (is_new)
      frame.node.entries.push_back({frame.key.text, frame.key.mark, std::move(value)});
    else
      errors_.add(frame.key.mark,
                  fmt::format("duplicate key {}; expected it once, it stands at {}:{} already",
                              in_quotes(frame.key.text), first->second.line, first->second.column));
  }

  Columns columns_;
  std::shared_ptr<const ConfigOrigin> origin_;
  ConfigErrors& errors_;
  bool seen_document_ = false;
  std::size_t nodes_ = 0;
  ConfigNode root_;
  std::vector<Frame> stack_;
  std::map<YAML::anchor_t, Anchored> anchors_;
};

}  // namespace

bool is_utf8(const std::string& text) { return first_not_utf8(text) == text.size(); }

bool report_slip(const std::string& text, int last_line, const std::shared_ptr<const ConfigOrigin>& origin,
                 ConfigErrors& errors) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; static_cast<int>(lines.size()) < last_line && std::getline(stream, line);)
    lines.push_back(line);
  for (auto number = static_cast<int>(lines.size()); number > 0; --number) {
    const std::string& line = lines[static_cast<std::size_t>(number) - 1];
    const std::size_t first = std::min(line.find_first_not_of(" \t"), line.size());
    const std::size_t tab = line.find('\t');
    if (number == last_line && tab < first) {
      errors.add({origin, number, static_cast<int>(tab) + 1}, "a tab in the indentation; expected spaces");
      return true;
    }
    if (const auto pair = glued_pair(line.substr(first))) {
      errors.add({origin, number, static_cast<int>(first) + 1}, glued_message(*pair));
      return true;
    }
  }
  return false;
}

std::optional<ConfigNode> read_yaml(const std::string& text,
                                    const std::shared_ptr<const ConfigOrigin>& origin, ConfigErrors& errors) {
  TreeBuilder builder(text, origin, errors);
  if (const std::size_t at = first_not_utf8(text); at < text.size()) {
    YAML::Mark mark;
    mark.pos = static_cast<int>(at);
    mark.line = static_cast<int>(std::count(text.begin(), text.begin() + mark.pos, '\n'));
    mark.column = mark.pos - static_cast<int>(text.rfind('\n', at) + 1);
    errors.add(builder.place(mark), "a letter that is not UTF-8; expected a text in UTF-8");
    return std::nullopt;
  }
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(builder)) {
    }
  } catch (const YAML::Exception& error) {
    const ConfigMark mark = error.mark.is_null() ? ConfigMark{origin, 0, 0} : builder.place(error.mark);
    if (report_slip(text, mark.line, origin, errors)) return std::nullopt;
    errors.add(mark, "not valid YAML: " + error.msg);
    return std::nullopt;
  } catch (const Refused& refused) {
    errors.add(refused.mark, refused.why);
    return std::nullopt;
  }
  return builder.take();
}

}  // namespace pliant
