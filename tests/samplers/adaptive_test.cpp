#include "samplers/adaptive/adaptive.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <set>

#include "framework/geometry/pixel_index.h"
#include "tests/geometry/holey_surface.h"
#include "tests/geometry/viewed_surface.h"

namespace pliant {
namespace {

constexpr double threshold = 2;

Surface square(int side) {
  Surface surface;
  for (int v = 0; v < side; ++v)
    for (int u = 0; u < side; ++u) {
      surface.pixels.emplace_back(u, v);
      surface.points.emplace_back(0.0F, 0.0F, 800.0F);
    }
  return surface;
}

using Mask = std::vector<int>;  ///< the points in it

std::map<std::pair<int, int>, Mask> masks_of(const Surface& surface, int step) {
  std::map<std::pair<int, int>, Mask> masks;
  for (std::size_t i = 0; i < surface.size(); ++i)
    masks[{surface.pixels[i].y() / step, surface.pixels[i].x() / step}].push_back(static_cast<int>(i));
  return masks;
}

/// Which places of a full mask the case in the middle takes, as the selection itself shows them.
std::set<std::pair<int, int>> spread_places(Device& device, int step) {
  const Surface mask = square(step);
  const auto samples = AdaptiveSampler(step, threshold, false).select(device, ViewedSurface(mask));
  samples->adapt(device, Array<float>(std::vector<float>(mask.size(), 1.5F)));
  std::set<std::pair<int, int>> places;
  for (const int point : samples->points()) {
    const Eigen::Vector2i& pixel = mask.pixels[static_cast<std::size_t>(point)];
    places.insert({pixel.x(), pixel.y()});
  }
  return places;
}

/// [thesis 4.5], mask by mask; `spread`: the places of the case in the middle.
std::vector<int> select_reference(const Surface& surface, int step, const std::vector<float>& residuals,
                                  const std::set<std::pair<int, int>>& spread) {
  std::vector<int> selected;
  const std::vector<int> centres = points_on_grid(index_pixels(surface), step);
  for (const auto& [place, mask] : masks_of(surface, step)) {
    double sum = 0;
    int known = 0;
    for (const int point : mask)
      if (const float residual = residuals[static_cast<std::size_t>(point)]; residual >= 0) {
        sum += residual;
        ++known;
      }
    const double mean = known > 0 ? sum / known : 0;
    for (const int point : mask) {
      const Eigen::Vector2i& pixel = surface.pixels[static_cast<std::size_t>(point)];
      const std::pair<int, int> within(pixel.x() % step, pixel.y() % step);
      const bool is_centre = std::binary_search(centres.begin(), centres.end(), point);
      if (mean > threshold || (mean >= threshold / 2 ? spread.count(within) > 0 : is_centre))
        selected.push_back(point);
    }
  }
  std::sort(selected.begin(), selected.end());
  return selected;
}

class AdaptiveSamplerTest : public testing::Test {
 protected:
  std::unique_ptr<PointSelection> select(const Surface& surface, int step) {
    return AdaptiveSampler(step, threshold, false).select(device_, ViewedSurface(surface));
  }

  std::size_t count_after(const Surface& surface, int step, float residual) {
    const auto samples = select(surface, step);
    samples->adapt(device_, Array<float>(std::vector<float>(surface.size(), residual)));
    return samples->points().size();
  }

  Device device_;
};

TEST_F(AdaptiveSamplerTest, IsUniformAtFirst) {
  const Surface surface = holey_surface(96, 70, 1);
  EXPECT_EQ(select(surface, 4)->points(), points_on_grid(index_pixels(surface), 4));
}

TEST_F(AdaptiveSamplerTest, TakesAllPointsOfAMaskOrAsManyAsItIsWideOrItsCentre) {
  const Surface surface = square(24);
  EXPECT_EQ(count_after(surface, 4, 2.125F), 36U * 16);
  EXPECT_EQ(count_after(surface, 4, 2), 36U * 4);
  EXPECT_EQ(count_after(surface, 4, 1), 36U * 4);
  EXPECT_EQ(count_after(surface, 4, 0.875F), 36U);
}

TEST_F(AdaptiveSamplerTest, TakesTheCentreWhereNoResidualIsKnown) {
  const Surface surface = holey_surface(96, 70, 1);
  const auto samples = select(surface, 4);
  samples->adapt(device_, Array<float>(std::vector<float>(surface.size(), 9)));
  EXPECT_EQ(samples->points().size(), surface.size());
  EXPECT_TRUE(samples->adapt(device_, Array<float>(std::vector<float>(surface.size(), -1))));
  EXPECT_EQ(samples->points(), points_on_grid(index_pixels(surface), 4));
}

TEST_F(AdaptiveSamplerTest, LooksAtTheResidualsThatAreKnownOnly) {
  const Surface surface = square(4);
  std::vector<float> residuals(16, -1);
  residuals[5] = 3;
  const auto samples = select(surface, 4);
  samples->adapt(device_, Array<float>(residuals));
  EXPECT_EQ(samples->points().size(), 16U);
}

TEST_F(AdaptiveSamplerTest, SpreadsPointsOverEveryColumnAndRow) {
  for (const int step : {1, 2, 3, 4, 5, 7, 8, 16}) {
    const auto places = spread_places(device_, step);
    std::set<int> columns;
    std::set<int> rows;
    for (const auto& [column, row] : places) {
      columns.insert(column);
      rows.insert(row);
    }
    EXPECT_EQ(places.size(), static_cast<std::size_t>(step));
    EXPECT_EQ(columns.size(), static_cast<std::size_t>(step));
    EXPECT_EQ(rows.size(), static_cast<std::size_t>(step));
  }
}

TEST_F(AdaptiveSamplerTest, KeepsSpreadPointsApart) {
  // A diagonal would have neighbours at a squared distance of 2.
  for (const int step : {4, 5, 7, 8, 11, 16}) {
    const auto places = spread_places(device_, step);
    for (const auto& [u, v] : places)
      for (const auto& [x, y] : places)
        EXPECT_TRUE(u == x || (u - x) * (u - x) + (v - y) * (v - y) >= 5) << step;
  }
}

TEST_F(AdaptiveSamplerTest, IsThatOfTheReference) {
  for (const int step : {1, 3, 4, 7}) {
    const auto spread = spread_places(device_, step);
    for (unsigned object = 1; object <= 2; ++object) {
      const Surface surface = holey_surface(96, 70, object);
      const auto samples = select(surface, step);
      for (unsigned seed = 1; seed <= 3; ++seed) {
        const std::vector<float> residuals = patchy_residuals(surface, seed);
        const std::vector<int> before = samples->points();
        const bool has_changed = samples->adapt(device_, Array<float>(residuals));
        EXPECT_EQ(samples->points(), select_reference(surface, step, residuals, spread));
        EXPECT_EQ(has_changed, samples->points() != before);
        EXPECT_FALSE(samples->adapt(device_, Array<float>(residuals)));
      }
    }
  }
}

TEST_F(AdaptiveSamplerTest, ConstraintsWeighTheSameUnlessMasksDo) {
  const Surface surface = square(24);
  const auto samples = select(surface, 4);
  samples->adapt(device_, Array<float>(std::vector<float>(surface.size(), 9)));
  EXPECT_THAT(samples->weights(), testing::IsEmpty());
}

TEST_F(AdaptiveSamplerTest, TheConstraintsOfAMaskWeighOneTogetherWhereMasksAreEqual) {
  const Surface surface = holey_surface(96, 70, 2);
  const auto samples = AdaptiveSampler(4, threshold, true).select(device_, ViewedSurface(surface));
  EXPECT_THAT(samples->weights(), testing::IsEmpty());  // one a mask at first
  for (unsigned seed = 1; seed <= 3; ++seed) {
    samples->adapt(device_, Array<float>(patchy_residuals(surface, seed)));
    const std::vector<float> weights = samples->weights();
    ASSERT_EQ(weights.size(), samples->points().size());
    std::map<std::pair<int, int>, double> sums;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      const Eigen::Vector2i& pixel = surface.pixels[static_cast<std::size_t>(samples->points()[i])];
      sums[{pixel.y() / 4, pixel.x() / 4}] += weights[i];
    }
    EXPECT_LT(sums.size(), weights.size());
    for (const auto& [mask, sum] : sums) EXPECT_NEAR(sum, 1, 1e-5) << mask.first << ", " << mask.second;
  }
}

TEST_F(AdaptiveSamplerTest, GivesTheSameBitsTwice) {
  const Surface surface = holey_surface(96, 70, 3);
  const auto once = select(surface, 4);
  const auto again = select(surface, 4);
  const Array<float> residuals(patchy_residuals(surface, 1));
  once->adapt(device_, residuals);
  again->adapt(device_, residuals);
  EXPECT_EQ(once->points(), again->points());
  EXPECT_THAT(std::set<int>(once->points().begin(), once->points().end()),
              testing::ElementsAreArray(once->points()));
}

}  // namespace
}  // namespace pliant
