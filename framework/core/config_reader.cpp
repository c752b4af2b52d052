#include "framework/core/config_reader.h"

#include <map>
#include <sstream>

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

/// Builds the tree from the parser's events: unlike YAML::Node they show keys that stand twice.
class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(std::shared_ptr<const ConfigOrigin> origin, ConfigErrors& errors)
      : origin_(std::move(origin)), errors_(errors) {}

  ConfigNode take() { return std::move(root_); }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (seen_document_) throw YAML::ParserException(mark, "a second document begins; expected only one");
    seen_document_ = true;
  }
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    finish({make(ConfigNode::Kind::null, mark), anchor});
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto found = anchors_.find(anchor);
    if (found == anchors_.end()) throw YAML::ParserException(mark, "an alias stands inside its own anchor");
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

  ConfigMark place(const YAML::Mark& mark) const { return {origin_, mark.line + 1, mark.column + 1}; }

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

  static void check_tag(const YAML::Mark& mark, const std::string& tag) {
    if (!tag.empty() && tag != "?" && tag != "!")
      throw YAML::ParserException(mark, "the tag " + in_quotes(tag) + " is not supported");
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
      throw YAML::ParserException(mark,
                                  fmt::format("more than {} values; expected an experiment", max_nodes));
  }

  void open(ConfigNode::Kind kind, const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor) {
    check_tag(mark, tag);
    if (stack_.size() >= max_depth)
      throw YAML::ParserException(mark, fmt::format("nested more than {} levels deep", max_depth));
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
    const YAML::Mark mark = yaml_mark(key.mark);
    if (key.kind != ConfigNode::Kind::scalar || key.text.empty())
      throw YAML::ParserException(mark, "a key is missing or no word; expected 'key: value'");
    if (key.text.size() > max_key_length)
      throw YAML::ParserException(mark, fmt::format("a key of more than {} letters", max_key_length));
    frame.key = {std::move(key.text), key.mark};
    frame.has_key = true;
  }

  void end_entry(Frame& frame, ConfigNode value) {
    frame.has_key = false;
    const auto [first, is_new] = frame.keys.emplace(frame.key.text, frame.key.mark);
    if (is_new)
      frame.node.entries.push_back({frame.key.text, frame.key.mark, std::move(value)});
    else
      errors_.add(frame.key.mark,
                  fmt::format("duplicate key {}; expected it once, it stands at {}:{} already",
                              in_quotes(frame.key.text), first->second.line, first->second.column));
  }

  static YAML::Mark yaml_mark(const ConfigMark& mark) {
    YAML::Mark yaml;
    yaml.line = mark.line - 1;
    yaml.column = mark.column - 1;
    return yaml;
  }

  std::shared_ptr<const ConfigOrigin> origin_;
  ConfigErrors& errors_;
  bool seen_document_ = false;
  std::size_t nodes_ = 0;
  ConfigNode root_;
  std::vector<Frame> stack_;
  std::map<YAML::anchor_t, Anchored> anchors_;
};

}  // namespace

std::optional<ConfigNode> read_yaml(const std::string& text, std::shared_ptr<const ConfigOrigin> origin,
                                    ConfigErrors& errors) {
  TreeBuilder builder(origin, errors);
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(builder)) {
    }
  } catch (const YAML::Exception& error) {
    const ConfigMark mark = error.mark.is_null() ? ConfigMark{origin, 0, 0} : builder.place(error.mark);
    errors.add(mark, "not valid YAML: " + error.msg);
    return std::nullopt;
  }
  return builder.take();
}

}  // namespace pliant
