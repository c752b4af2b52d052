#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "framework/core/error.h"
#include "framework/io/little_endian.h"
#include "framework/pose/head_forest.h"

// magic, 8 bytes; version, length of what follows the header, its checksum, trees that vote, trees that
// refine, each uint32; then every tree in preorder, a byte before each node saying what it is:
//   split          two boxes of four uint8, threshold int16 (1/32 mm); what is below, what is above
//   leaf of heads  share uint8 (1/255), offset 3 int16 (1/32 mm), angles 3 int16 (1e-4 rad), spreads 2 uint16
//   other leaf     nothing

namespace pliant {
namespace {

constexpr std::array<std::uint8_t, 8> magic{'P', 'L', 'N', 'T', 'H', 'E', 'A', 'D'};
constexpr std::uint32_t version = 1;
constexpr float length_step = 1 / 32.0F;  // mm
constexpr float angle_step = 1e-4F;       // radians
constexpr int deepest = 64;               // a tree that is deeper is none that was trained

enum class Kind : std::uint8_t { other, head, split };

/// FNV-1a of 32 bits [Fowler, Noll, Vo], which sees every single byte that was changed.
std::uint32_t checksum(const std::uint8_t* bytes, std::size_t size) {
  std::uint32_t sum = 2166136261U;
  for (std::size_t i = 0; i < size; ++i) sum = (sum ^ bytes[i]) * 16777619U;
  return sum;
}

class TreeWriter {
 public:
  explicit TreeWriter(std::vector<std::uint8_t>& bytes) : bytes_(bytes) {}

  void write(const HeadTree& tree, int at) {
    if (at < 0) return write(tree.leaves[static_cast<std::size_t>(~at)]);
    const HeadTree::Node& node = tree.nodes[static_cast<std::size_t>(at)];
    put(Kind::split);
    put(node.test.first);
    put(node.test.second);
    put(node.test.threshold, length_step);
    write(tree, node.below);
    write(tree, node.above);
  }

 private:
  void write(const HeadLeaf& leaf) {
    const auto share = static_cast<std::uint8_t>(std::lround(255 * leaf.head_share));
    if (share == 0) return put(Kind::other);
    put(Kind::head);
    bytes_.push_back(share);
    for (int i = 0; i < 3; ++i) put(leaf.offset[i], length_step);
    for (int i = 0; i < 3; ++i) put(leaf.angles[i], angle_step);
    put(leaf.offset_spread, length_step);
    put(leaf.angle_spread, angle_step);
  }
  void put(Kind kind) { bytes_.push_back(static_cast<std::uint8_t>(kind)); }
  void put(const CellBox& box) { bytes_.insert(bytes_.end(), {box.left, box.top, box.right, box.bottom}); }
  void put(float value, float step) {
    const auto number = static_cast<std::int16_t>(std::lround(std::clamp(value / step, -32767.0F, 32767.0F)));
    const auto bits = static_cast<std::uint16_t>(number);
    bytes_.push_back(static_cast<std::uint8_t>(bits));
    bytes_.push_back(static_cast<std::uint8_t>(bits >> 8));
  }

  std::vector<std::uint8_t>& bytes_;
};

class Reader {
 public:
  Reader(const std::vector<std::uint8_t>& bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  HeadForest read() {
    check_header();
    HeadForest forest;
    const std::uint32_t voting = number();
    const std::uint32_t refining = number();
    if (voting == 0 || refining == 0) fail("there are no trees of one kind; expected at least one of each");
    for (std::uint32_t i = 0; i < voting; ++i) read_node(forest.voting.emplace_back(), 0);
    for (std::uint32_t i = 0; i < refining; ++i) read_node(forest.refining.emplace_back(), 0);
    if (at_ != bytes_.size()) fail(fmt::format("{} bytes follow its last tree", bytes_.size() - at_));
    return forest;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw DataError(name_ + ": " + what); }

  void check_header() {
    if (bytes_.size() < magic.size() || !std::equal(magic.begin(), magic.end(), bytes_.begin()))
      fail("this is no head forest; expected a file made by 'pliant train head_forest'");
    at_ = magic.size();
    const std::uint32_t its_version = number();
    if (its_version != version)
      fail(fmt::format(
          "the head forest is of version {}; expected {}: train it anew by 'pliant train head_forest'",
          its_version, version));
    const std::uint32_t size = number();
    const std::uint32_t sum = number();
    const std::size_t there = bytes_.size() - at_;
    if (there != size)
      fail(fmt::format("the head forest is {}: it has {} bytes; expected {}",
                       there < size ? "truncated" : "followed by something else", bytes_.size(), at_ + size));
    if (checksum(bytes_.data() + at_, there) != sum)
      fail("the head forest is damaged: its checksum is wrong");
  }

  /// Its index, or ~index of a leaf.
  int read_node(HeadTree& tree, int depth) {
    if (depth > deepest) fail(fmt::format("a tree is deeper than {} questions", deepest));
    const std::uint8_t kind = byte();
    if (kind == static_cast<std::uint8_t>(Kind::split)) return read_split(tree, depth);
    if (kind > static_cast<std::uint8_t>(Kind::split))
      fail(fmt::format("a node is of the unknown kind {}", kind));
    tree.leaves.push_back(kind == static_cast<std::uint8_t>(Kind::head) ? read_leaf() : HeadLeaf{});
    return ~static_cast<int>(tree.leaves.size() - 1);
  }

  int read_split(HeadTree& tree, int depth) {
    const std::size_t index = tree.nodes.size();
    HeadTree::Node node;
    node.test.first = box();
    node.test.second = box();
    node.test.threshold = value(length_step);
    tree.nodes.push_back(node);
    const int below = read_node(tree, depth + 1);
    const int above = read_node(tree, depth + 1);
    tree.nodes[index].below = below;
    tree.nodes[index].above = above;
    return static_cast<int>(index);
  }

  HeadLeaf read_leaf() {
    HeadLeaf leaf;
    leaf.head_share = static_cast<float>(byte()) / 255;
    for (int i = 0; i < 3; ++i) leaf.offset[i] = value(length_step);
    for (int i = 0; i < 3; ++i) leaf.angles[i] = value(angle_step);
    leaf.offset_spread = value(length_step);
    leaf.angle_spread = value(angle_step);
    return leaf;
  }

  CellBox box() {
    CellBox box;
    box.left = byte();
    box.top = byte();
    box.right = byte();
    box.bottom = byte();
    if (box.left >= box.right || box.top >= box.bottom || std::max(box.right, box.bottom) > DepthPatch::cells)
      fail(fmt::format("a question is about columns {} to {} of rows {} to {}; expected some of {}", box.left,
                       box.right, box.top, box.bottom, DepthPatch::cells));
    return box;
  }

  std::uint8_t byte() {
    if (at_ == bytes_.size()) fail(fmt::format("the head forest ends within a tree, after {} bytes", at_));
    return bytes_[at_++];
  }
  float value(float step) {
    const std::uint32_t low = byte();
    return static_cast<float>(static_cast<std::int16_t>(low | std::uint32_t{byte()} << 8)) * step;
  }
  std::uint32_t number() {
    std::uint32_t value = 0;
    for (int shift = 0; shift < 32; shift += 8) value |= std::uint32_t{byte()} << shift;
    return value;
  }

  const std::vector<std::uint8_t>& bytes_;
  const std::string& name_;
  std::size_t at_ = 0;
};

}  // namespace

std::vector<std::uint8_t> write_head_forest(const HeadForest& forest) {
  std::vector<std::uint8_t> body;
  for (const auto* trees : {&forest.voting, &forest.refining})
    append(body, static_cast<std::uint32_t>(trees->size()));
  for (const auto* trees : {&forest.voting, &forest.refining})
    for (const HeadTree& tree : *trees) TreeWriter(body).write(tree, tree.nodes.empty() ? -1 : 0);
  std::vector<std::uint8_t> bytes(magic.begin(), magic.end());
  append(bytes, version);
  append(bytes, static_cast<std::uint32_t>(body.size()));
  append(bytes, checksum(body.data(), body.size()));
  bytes.insert(bytes.end(), body.begin(), body.end());
  return bytes;
}

HeadForest read_head_forest(const std::vector<std::uint8_t>& bytes, const std::string& name) {
  return Reader(bytes, name).read();
}

}  // namespace pliant
