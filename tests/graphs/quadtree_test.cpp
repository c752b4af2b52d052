#include "graphs/quadtree/quadtree.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <functional>
#include <map>
#include <random>
#include <set>

#include "framework/core/error.h"
#include "framework/geometry/pixel_index.h"
#include "tests/geometry/holey_surface.h"
#include "tests/geometry/viewed_surface.h"
#include "tests/graphs/quadtree_reference.h"

namespace pliant {
namespace {

using Settings = QuadtreeGraph::Settings;

std::vector<Surface> objects() {
  return {holey_surface(96, 70, 1), holey_surface(61, 97, 2), holey_surface(64, 64, 3)};
}

Surface full_rectangle(int width, int height) {
  Surface surface;
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      surface.pixels.emplace_back(u, v);
      surface.points.emplace_back(0.0F, 0.0F, 800.0F);
    }
  return surface;
}

void remove_points(Surface& surface, const std::function<bool(const Eigen::Vector2i&)>& is_removed) {
  Surface kept;
  for (const Eigen::Vector2i& pixel : surface.pixels)
    if (!is_removed(pixel)) {
      kept.pixels.push_back(pixel);
      kept.points.emplace_back(0.0F, 0.0F, 800.0F);
    }
  surface = kept;
}

/// Removes what point_at could give in the place of a point at `centre`.
void remove_points_around(Surface& surface, const Eigen::Vector2i& centre) {
  remove_points(surface, [&](const Eigen::Vector2i& pixel) {
    return (pixel - centre).cwiseAbs().maxCoeff() <= gap_radius;
  });
}

Array<float> everywhere(const Surface& surface, float residual) {
  return Array<float>(std::vector<float>(surface.size(), residual));
}

bool contains(const GraphCell& cell, const Eigen::Vector2i& pixel) {
  return pixel.x() >= cell.left && pixel.x() < cell.right && pixel.y() >= cell.top && pixel.y() < cell.bottom;
}

class QuadtreeTest : public testing::Test {
 protected:
  std::unique_ptr<NodeSelection> select(const Settings& settings, const Surface& surface) {
    return QuadtreeGraph(settings).select_nodes(device_, ViewedSurface(surface));
  }

  /// Hands `check` the tree of each object as it is built and after each of several adaptations.
  void over_adaptations(const std::function<void(const Surface&, const NodeSelection&)>& check) {
    for (const Surface& surface : objects()) {
      const auto nodes = select({5, 2, 10, 2, 1.5}, surface);
      check(surface, *nodes);
      for (unsigned seed = 1; seed <= 5; ++seed) {
        nodes->adapt(device_, Array<float>(patchy_residuals(surface, seed)));
        check(surface, *nodes);
      }
    }
  }

  Device device_;
};

TEST_F(QuadtreeTest, IsThatOfTheReference) {
  for (const Surface& surface : objects())
    for (const Settings& settings :
         {Settings{5, 2, 10, 2, 1.5}, Settings{6, 3, 10, 1.75, 1.25}, Settings{4, 1, 10, 2, 1},
          Settings{6, 2, 2, 2, 1.5}, Settings{5, 1, 1, 2, 1.5}, Settings{6, 3, 4, 1.75, 1.25}}) {
      const auto nodes = select(settings, surface);
      QuadtreeReference reference(settings, surface);
      EXPECT_EQ(nodes->points(), reference.points());
      EXPECT_EQ(nodes->cells(), reference.cells());
      for (unsigned seed = 1; seed <= 6; ++seed) {
        const std::vector<int> before = nodes->points();
        const std::vector<float> residuals = patchy_residuals(surface, seed);
        const bool has_changed = nodes->adapt(device_, Array<float>(residuals));
        reference.adapt(residuals);
        EXPECT_EQ(nodes->points(), reference.points());
        EXPECT_EQ(nodes->cells(), reference.cells());
        EXPECT_EQ(has_changed, nodes->points() != before);
      }
    }
}

TEST_F(QuadtreeTest, HasItsCentresRightWhereCellsReachBeyondTheObject) {
  for (const auto& [width, height] : {std::pair(21, 50), {37, 50}, {61, 22}, {50, 33}}) {
    Surface surface = full_rectangle(width, height);
    for (Eigen::Vector2i& pixel : surface.pixels) pixel += Eigen::Vector2i(100, 100);
    const Settings settings{4, 4, 10, 2, 1};
    EXPECT_EQ(select(settings, surface)->cells(), QuadtreeReference(settings, surface).cells())
        << width << " x " << height;
  }
}

// A test of the tests: residuals under which nothing refines or collapses would prove nothing.
TEST_F(QuadtreeTest, IsComparedWhereItBothRefinesAndCollapses) {
  const Surface surface = holey_surface(96, 70, 1);
  QuadtreeReference tree({5, 2, 10, 2, 1.5}, surface);
  bool refined = false;
  bool collapsed = false;
  bool is_virtual = false;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const auto before = tree.cells();
    tree.adapt(patchy_residuals(surface, seed));
    for (const GraphCell& now : tree.cells()) {
      is_virtual = is_virtual || now.is_virtual;
      for (const GraphCell& then : before)
        if (contains(then, {now.left, now.top}) || contains(now, {then.left, then.top})) {
          refined = refined || now.level > then.level;
          collapsed = collapsed || now.level < then.level;
        }
    }
  }
  EXPECT_TRUE(refined);
  EXPECT_TRUE(collapsed);
  EXPECT_TRUE(is_virtual);
}

TEST_F(QuadtreeTest, LeavesTileTheObject) {
  over_adaptations([](const Surface& surface, const NodeSelection& nodes) {
    std::map<std::pair<int, int>, int> covered;
    for (const GraphCell& cell : nodes.cells())
      for (int v = cell.top; v < cell.bottom; ++v)
        for (int u = cell.left; u < cell.right; ++u) ++covered[{u, v}];
    for (const auto& [pixel, times] : covered) EXPECT_EQ(times, 1) << pixel.first << ", " << pixel.second;
    for (const Eigen::Vector2i& pixel : surface.pixels)
      EXPECT_EQ(covered.count({pixel.x(), pixel.y()}), 1U) << pixel.transpose();
  });
}

TEST_F(QuadtreeTest, NodesAreThePointsAtTheCentresOfCells) {
  over_adaptations([](const Surface& surface, const NodeSelection& nodes) {
    std::set<int> expected;
    const PixelIndex index = index_pixels(surface);
    for (const GraphCell& cell : nodes.cells()) {
      const Eigen::Vector2i centre((cell.left + cell.right) / 2, (cell.top + cell.bottom) / 2);
      const int found = point_at(index, centre, {cell.left, cell.top, cell.right, cell.bottom});
      EXPECT_EQ(cell.is_virtual, found < 0);
      if (!cell.is_virtual) expected.insert(found);
    }
    EXPECT_THAT(nodes.points(), testing::ElementsAreArray(expected));  // ascending, without repetition
  });
}

TEST_F(QuadtreeTest, NoCellIsInTheGraphTogetherWithOneInsideIt) {
  over_adaptations([](const Surface&, const NodeSelection& nodes) {
    const auto cells = nodes.cells();
    for (const GraphCell& cell : cells)
      for (const GraphCell& other : cells)
        EXPECT_FALSE(other.level > cell.level && contains(cell, {other.left, other.top}));
  });
}

TEST_F(QuadtreeTest, HasAtMostFourToTheLNodesOnLevelL) {
  const Surface surface = full_rectangle(64, 64);
  const auto nodes = select({5, 3, 10, 2, 1}, surface);
  EXPECT_EQ(nodes->points().size(), 64U);  // 4^3: full where nothing is missing
  EXPECT_TRUE(nodes->adapt(device_, everywhere(surface, 3)));
  EXPECT_EQ(nodes->points().size(), 256U);  // one level an adaptation
  EXPECT_TRUE(nodes->adapt(device_, everywhere(surface, 3)));
  EXPECT_EQ(nodes->points().size(), 1024U);
  EXPECT_FALSE(nodes->adapt(device_, everywhere(surface, 3)));
  over_adaptations([](const Surface&, const NodeSelection& selection) {
    std::map<int, int> counts;
    for (const GraphCell& cell : selection.cells()) ++counts[cell.level];
    for (const auto& [level, count] : counts) EXPECT_LE(count, 1 << (2 * level));
  });
}

TEST_F(QuadtreeTest, SettlesAtTheSameResidual) {
  for (const Surface& surface : objects()) {
    const auto nodes = select({6, 2, 10, 2, 1.5}, surface);
    for (unsigned seed = 1; seed <= 5; ++seed) {
      const Array<float> residuals(patchy_residuals(surface, seed));
      int calls = 0;
      while (nodes->adapt(device_, residuals) && calls < 6) ++calls;
      EXPECT_LT(calls, 6);
      const auto settled = nodes->cells();
      EXPECT_FALSE(nodes->adapt(device_, residuals));
      EXPECT_EQ(nodes->cells(), settled);
    }
  }
}

TEST_F(QuadtreeTest, ChangesOnlyBeyondTheThresholds) {
  const Surface surface = holey_surface(96, 70, 4);
  const auto nodes = select({5, 2, 10, 2, 1}, surface);
  while (nodes->adapt(device_, everywhere(surface, 2.5))) {
  }
  EXPECT_EQ(nodes->cells().back().level, 5);
  const auto refined = nodes->points();
  for (const float residual : {2.0F, 1.5F, 1.0F, -1.0F})
    EXPECT_FALSE(nodes->adapt(device_, everywhere(surface, residual)));
  EXPECT_TRUE(nodes->adapt(device_, everywhere(surface, 0.5F)));
  EXPECT_LT(nodes->points().size(), refined.size() / 2);
}

bool is_within(const GraphCell& inner, const GraphCell& outer) {
  return inner.level >= outer.level && contains(outer, {inner.left, inner.top});
}

int count_within(const std::vector<GraphCell>& leaves, const GraphCell& cell, bool with_node) {
  return static_cast<int>(std::count_if(leaves.begin(), leaves.end(), [&](const GraphCell& leaf) {
    return is_within(leaf, cell) && !(with_node && leaf.is_virtual);
  }));
}

/// A cell that is in the tree before and after, divided or not, and had a node, has one. Returns how many
/// cells were joined.
int expect_no_cell_without_its_nodes(const std::vector<GraphCell>& before,
                                     const std::vector<GraphCell>& after) {
  int joined = 0;
  for (const auto* leaves : {&before, &after})
    for (const GraphCell& cell : *leaves) {
      if (count_within(before, cell, false) == 0 || count_within(after, cell, false) == 0) continue;
      const bool is_kept = count_within(before, cell, true) == 0 || count_within(after, cell, true) > 0;
      EXPECT_TRUE(is_kept) << "level " << cell.level << " at " << cell.left << ", " << cell.top;
      joined += static_cast<int>(leaves == &after && count_within(before, cell, false) > 1);
    }
  return joined;
}

/// An object of which a share of the pixels, or of blocks of pixels, is missing at random.
Surface ragged_surface(unsigned seed) {
  std::mt19937 random(seed);
  const auto block = 1 + static_cast<int>(random() % 9);
  const auto missing = random() % 10;
  Surface surface =
      full_rectangle(40 + static_cast<int>(random() % 50), 40 + static_cast<int>(random() % 50));
  remove_points(surface, [&](const Eigen::Vector2i& pixel) {
    const auto place = static_cast<unsigned>(pixel.y() / block * 100 + pixel.x() / block);
    return std::mt19937(seed + 1000 * place)() % 12 < missing;
  });
  return surface;
}

TEST_F(QuadtreeTest, NoCellLosesAllOfItsNodesOnWhateverMaskUnderWhateverResidual) {
  int joined = 0;
  int is_virtual = 0;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const Surface surface = ragged_surface(seed);
    for (const int virtual_levels : {2, 10}) {
      const auto nodes = select({6, 1 + static_cast<int>(seed % 3), virtual_levels, 2, 1.75}, surface);
      for (unsigned round = 0; round < 8; ++round) {
        SCOPED_TRACE(testing::Message()
                     << "mask " << seed << ", " << virtual_levels << " virtual levels, round " << round);
        const auto before = nodes->cells();
        nodes->adapt(device_, Array<float>(patchy_residuals(surface, 100 * seed + round / 2)));
        joined += expect_no_cell_without_its_nodes(before, nodes->cells());
        is_virtual += static_cast<int>(std::count_if(before.begin(), before.end(),
                                                     [](const GraphCell& cell) { return cell.is_virtual; }));
      }
    }
  }
  EXPECT_GT(joined, 100);  // or it would prove nothing
  EXPECT_GT(is_virtual, 100);
}

TEST_F(QuadtreeTest, AVirtualParentTakesNoNodesBack) {
  Surface surface = full_rectangle(64, 64);
  remove_points_around(surface, {8, 8});
  const auto nodes = select({3, 2, 10, 2, 1}, surface);
  EXPECT_EQ(nodes->points().size(), 15U);
  nodes->adapt(device_, everywhere(surface, 3));
  EXPECT_EQ(nodes->points().size(), 64U);
  nodes->adapt(device_, everywhere(surface, 0));
  EXPECT_EQ(nodes->points().size(), 15U + 4U);
}

TEST_F(QuadtreeTest, BelowItsVirtualLevelsACellWithoutANodeIsNoPartOfTheTree) {
  Surface surface = full_rectangle(64, 64);
  remove_points_around(surface, {4, 4});
  EXPECT_EQ(select({3, 3, 3, 2, 1}, surface)->cells().size(), 64U);
  EXPECT_EQ(select({3, 3, 2, 2, 1}, surface)->cells().size(), 63U);
}

TEST_F(QuadtreeTest, CollapsesToWhereItBeganWhereNoParentIsVirtual) {
  for (const int side : {64, 61, 97}) {
    const Surface surface = full_rectangle(side, side);
    const auto nodes = select({5, 2, 10, 2, 1}, surface);
    const auto at_first = nodes->cells();
    for (int level = 2; level < 5; ++level) EXPECT_TRUE(nodes->adapt(device_, everywhere(surface, 5)));
    EXPECT_TRUE(nodes->adapt(device_, everywhere(surface, 0)));
    EXPECT_EQ(nodes->cells(), at_first);
  }
}

TEST_F(QuadtreeTest, RefinesOnlyWhereItDoesNotFit) {
  const Surface surface = full_rectangle(64, 64);
  const auto nodes = select({4, 2, 10, 2, 1}, surface);
  std::vector<float> residuals;
  for (const Eigen::Vector2i& pixel : surface.pixels) residuals.push_back(pixel.x() < 16 ? 4.0F : 1.5F);
  while (nodes->adapt(device_, Array<float>(residuals))) {
  }
  for (const GraphCell& cell : nodes->cells()) EXPECT_EQ(cell.level, cell.left < 16 ? 4 : 2);
}

TEST_F(QuadtreeTest, GrowsThroughVirtualNodesIntoRegionsWhoseCentreIsAHole) {
  Surface surface = full_rectangle(64, 64);
  // A hole over the centre of the cell (0, 0) of level 1, and of all of its children's.
  remove_points(surface, [](const Eigen::Vector2i& pixel) {
    return pixel.x() >= 6 && pixel.x() <= 26 && pixel.y() >= 6 && pixel.y() <= 26;
  });
  const auto nodes = select({4, 1, 10, 2, 1}, surface);
  EXPECT_EQ(nodes->points().size(), 3U);
  EXPECT_TRUE(nodes->cells().front().is_virtual);
  for (int level = 1; level < 4; ++level) nodes->adapt(device_, everywhere(surface, 3));
  const auto grown = std::count_if(nodes->points().begin(), nodes->points().end(), [&](int node) {
    const Eigen::Vector2i& pixel = surface.pixels[static_cast<std::size_t>(node)];
    return pixel.x() < 32 && pixel.y() < 32;
  });
  EXPECT_EQ(grown, 64 - 36);  // all of the deepest level but those in the hole
}

TEST_F(QuadtreeTest, HasNoMoreLevelsThanPixelsAllow) {
  const Surface surface = full_rectangle(5, 4);
  const auto nodes = select({10, 10, 10, 2, 1}, surface);
  for (const GraphCell& cell : nodes->cells()) EXPECT_LE(cell.level, 2);
  EXPECT_FALSE(nodes->points().empty());
}

TEST_F(QuadtreeTest, OfOnePointIsThatPoint) {
  const Surface surface = full_rectangle(1, 1);
  const auto nodes = select({6, 3, 10, 2, 1}, surface);
  EXPECT_THAT(nodes->points(), testing::ElementsAre(0));
  EXPECT_FALSE(nodes->adapt(device_, everywhere(surface, 9)));
}

TEST_F(QuadtreeTest, GivesTheSameBitsTwice) {
  const Surface surface = holey_surface(96, 70, 5);
  const auto once = select({6, 2, 10, 2, 1.5}, surface);
  const auto again = select({6, 2, 10, 2, 1.5}, surface);
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const Array<float> residuals(patchy_residuals(surface, seed));
    EXPECT_EQ(once->adapt(device_, residuals), again->adapt(device_, residuals));
    EXPECT_EQ(once->points(), again->points());
    EXPECT_EQ(once->cells(), again->cells());
  }
}

TEST(QuadtreeSettings, ThresholdsInTheWrongOrderAreAnError) {
  for (const double collapse : {2.0, 3.0})
    EXPECT_THAT(
        [&] {
          QuadtreeGraph(Settings{6, 3, 10, 2, collapse});
        },
        testing::ThrowsMessage<ConfigError>(testing::HasSubstr("collapse_threshold")));
}

TEST(QuadtreeSettings, MoreInitialLevelsThanLevelsAreAnError) {
  EXPECT_THAT(
      [] {
        QuadtreeGraph(Settings{3, 4, 10, 2, 1});
      },
      testing::ThrowsMessage<ConfigError>(testing::HasSubstr("initial_levels is 4")));
}

}  // namespace
}  // namespace pliant
