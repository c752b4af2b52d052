#include "framework/pose/align_features.h"

#include <fmt/format.h>

#include <flann/algorithms/dist.h>
#include <flann/algorithms/kdtree_single_index.h>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <future>
#include <memory>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "framework/core/error.h"

namespace pliant {
namespace {

struct Features {
  cv::Mat descriptors;  // float, one row a feature
  std::vector<Eigen::Vector3d> points;
  std::vector<double> radii;  // mm on the surface
};

cv::Mat to_grey(const ColorImage& color) {
  const cv::Mat rgb(color.height(), color.width(), CV_8UC3, const_cast<Rgb*>(color.data()));
  cv::Mat grey;
  cv::cvtColor(rgb, grey, cv::COLOR_RGB2GRAY);
  return grey;
}

/// Where features may lie: on the object and with depth to back-project them.
cv::Mat usable_pixels(const Frame& frame) {
  cv::Mat usable(frame.depth.height(), frame.depth.width(), CV_8U);
  for (int v = 0; v < usable.rows; ++v) {
    for (int u = 0; u < usable.cols; ++u) {
      const bool inside = frame.mask.empty() || frame.mask(u, v) != 0;
      usable.at<std::uint8_t>(v, u) = inside && is_depth(frame.depth(u, v)) ? 255 : 0;
    }
  }
  return usable;
}

/// The usable part of an image with what descriptors reach beyond it: detection takes as long as the image is
/// large. It begins where the coarse levels of the scale space have their samples.
cv::Rect part_to_search(const cv::Mat& usable) {
  constexpr int margin = 32;
  constexpr int coarsest_sample = 16;
  const cv::Rect used = cv::boundingRect(usable);
  const int left = std::max(0, used.x - margin) / coarsest_sample * coarsest_sample;
  const int top = std::max(0, used.y - margin) / coarsest_sample * coarsest_sample;
  return {left, top, std::min(usable.cols, used.br().x + margin) - left,
          std::min(usable.rows, used.br().y + margin) - top};
}

const cv::Point2d centre(0.5, 0.5);  // of a pixel, from its corner

cv::Mat scaled(const cv::Mat& image, double scale, int interpolation) {
  cv::Mat result;
  cv::resize(image, result, {}, scale, scale, interpolation);
  return result;
}

/// The depth of the plane through the depths around a place in the image, without what lies in front or
/// behind: a single one carries all its noise, which is far greater than what a feature is astray in the
/// image.
double depth_around(const Frame& frame, const cv::Mat& usable, const cv::Point2d& at) {
  constexpr int radius = 2;            // pixels
  constexpr double same_surface = 30;  // mm
  const cv::Point middle(cvRound(at.x), cvRound(at.y));
  const auto depth = [&](const cv::Point& pixel) -> double { return frame.depth(pixel.x, pixel.y); };
  const auto is_near = [&](const cv::Point& pixel) {
    return pixel.inside({{0, 0}, usable.size()}) && usable.at<std::uint8_t>(pixel) != 0 &&
           std::abs(depth(pixel) - depth(middle)) < same_surface;
  };
  double sum = 0;
  int count = 0;
  cv::Point2d rise(0, 0);
  cv::Point2d run(0, 0);
  for (int dv = -radius; dv <= radius; ++dv) {
    for (int du = -radius; du <= radius; ++du) {
      const cv::Point step(du, dv);
      // Only with the pixel across, so that mean and slopes do not depend on each other.
      if (!is_near(middle + step) || !is_near(middle - step)) continue;
      sum += depth(middle + step);
      rise += cv::Point2d(step) * depth(middle + step);
      run += cv::Point2d(du * du, dv * dv);
      ++count;
    }
  }
  const cv::Point2d beside = at - cv::Point2d(middle);
  double result = sum / count;
  if (run.x > 0) result += beside.x * rise.x / run.x;
  if (run.y > 0) result += beside.y * rise.y / run.y;
  return result;
}

/// An object that covers few pixels is not shrunk as much as asked for: it would have no features left.
double scale_for(const Frame& source, double scale) {
  constexpr double fewest_pixels = 6000;
  const int pixels = cv::countNonZero(usable_pixels(source));
  return pixels > 0 ? std::clamp(std::sqrt(fewest_pixels / pixels), scale, 1.0) : scale;
}

Features find_features(const Frame& frame, const Camera& camera, double scale, const std::string& which) {
  if (frame.color.empty()) {
    throw DataError(fmt::format("{}: alignment `features` needs a colour image", which));
  }
  // A quarter of OpenCV's contrast threshold: cloth has little contrast, and the ratio test sorts out.
  const auto sift = cv::SIFT::create(0, 3, 0.01);
  std::vector<cv::KeyPoint> keypoints;
  cv::Mat descriptors;
  const cv::Mat usable = usable_pixels(frame);
  const cv::Rect part = part_to_search(usable);
  sift->detectAndCompute(scaled(to_grey(frame.color)(part), scale, cv::INTER_AREA),
                         scaled(usable(part), scale, cv::INTER_NEAREST), keypoints, descriptors);
  Features features;
  for (std::size_t i = 0; i < keypoints.size(); ++i) {
    const cv::Point2d at = (cv::Point2d(keypoints[i].pt) + centre) / scale - centre + cv::Point2d(part.tl());
    const cv::Point pixel(cvRound(at.x), cvRound(at.y));
    if (!pixel.inside({{0, 0}, usable.size()}) || usable.at<std::uint8_t>(pixel) == 0) continue;
    features.points.push_back(camera.unproject(at.x, at.y, depth_around(frame, usable, at)));
    features.radii.push_back(keypoints[i].size / 2 / scale * features.points.back().z() / camera.fx);
    features.descriptors.push_back(descriptors.row(static_cast<int>(i)));
  }
  if (features.points.size() < 2) {
    throw DataError(
        fmt::format("{}: {} colour features with depth, too few to align", which, features.points.size()));
  }
  return features;
}

flann::Matrix<float> rows_of(cv::Mat& descriptors) {
  return {descriptors.ptr<float>(), static_cast<std::size_t>(descriptors.rows),
          static_cast<std::size_t>(descriptors.cols)};
}

PointMatches match(Features& source, Features& target, double ratio) {
  // The single tree searches exactly; FLANN's randomised trees are shuffled by std::random_device and
  // give other matches in every run.
  flann::KDTreeSingleIndex<flann::L2<float>> index(rows_of(target.descriptors));
  index.buildIndex();
  std::vector<std::vector<int>> indices;
  std::vector<std::vector<float>> squared;
  index.knnSearch(rows_of(source.descriptors), indices, squared, 2,
                  flann::SearchParams(flann::FLANN_CHECKS_UNLIMITED));
  PointMatches matches;
  for (std::size_t i = 0; i < indices.size(); ++i) {
    if (!(squared[i][0] < ratio * ratio * squared[i][1])) continue;
    const auto found = static_cast<std::size_t>(indices[i][0]);
    matches.add(source.points[i], target.points[found],
                static_cast<float>(feature_confidence(std::max(source.radii[i], target.radii[found]))));
  }
  return matches;
}

/// Whether at least half of the matches nearest to match `i`, among `others`, keep their distance to it.
bool agrees_with_neighbours(const PointMatches& matches, const std::vector<std::size_t>& others,
                            std::size_t i) {
  constexpr std::size_t neighbours = 6;
  const auto distance = [&](std::size_t j) { return (matches.from[i] - matches.from[j]).norm(); };
  std::vector<std::size_t> nearest;
  for (const std::size_t j : others)
    if (j != i) nearest.push_back(j);
  const std::size_t count = std::min(neighbours, nearest.size());
  std::partial_sort(
      nearest.begin(), nearest.begin() + static_cast<std::ptrdiff_t>(count), nearest.end(),
      [&](std::size_t a, std::size_t b) { return std::pair(distance(a), a) < std::pair(distance(b), b); });
  std::size_t agreeing = 0;
  for (std::size_t n = 0; n < count; ++n) {
    const double before = distance(nearest[n]);
    const double after = (matches.to[i] - matches.to[nearest[n]]).norm();
    agreeing += std::abs(after - before) <= 5 + before / 4 ? 1 : 0;
  }
  return count > 0 && 2 * agreeing >= count;
}

class FeatureAlignment : public Alignment {
 public:
  explicit FeatureAlignment(const FeatureOptions& options) : options_(options) {}

  AlignmentResult align(const AlignmentInput& input) const override {
    AlignmentResult result = align_by_features(input.pair, options_, input.seed);
    if (result.inliers < options_.min_inliers)
      throw DataError(fmt::format("{}: {}, alignment needs at least {}", input.pair.name,
                                  agreement(result.inliers, result.matches), options_.min_inliers));
    result.method = "features";
    result.reason = agreement(result.inliers, result.matches);
    return result;
  }

 private:
  FeatureOptions options_;
};

}  // namespace

std::string agreement(int inliers, int matches) {
  return fmt::format("{} of {} feature matches agree on a rigid motion", inliers, matches);
}

PointMatches keep_deformable(const PointMatches& matches, const Eigen::Isometry3d& motion,
                             double max_deformation) {
  std::vector<std::size_t> near;
  for (std::size_t i = 0; i < matches.size(); ++i)
    if ((motion * matches.from[i] - matches.to[i]).norm() < max_deformation) near.push_back(i);
  PointMatches kept;
  for (const std::size_t i : near) {
    if (agrees_with_neighbours(matches, near, i))
      kept.add(matches.from[i], matches.to[i], matches.confidence[i]);
  }
  return kept;
}

double feature_confidence(double radius) {
  constexpr double precise_radius = 5;  // mm
  return std::min(1.0, std::pow(precise_radius / radius, 2));
}

PointMatches match_features(const FramePair& pair, double ratio, double least_scale) {
  const double scale = scale_for(pair.source, least_scale);
  // Both at once: most of the detector runs on one processor only.
  auto found = std::async(std::launch::async, [&] {
    return find_features(pair.target, pair.camera, scale, pair.name + ", target");
  });
  Features source = find_features(pair.source, pair.camera, scale, pair.name + ", source");
  Features target = found.get();
  return match(source, target, ratio);
}

AlignmentResult align_by_features(const FramePair& pair, const FeatureOptions& options, std::uint64_t seed) {
  const PointMatches matches = match_features(pair, options.ratio, options.scale);
  AlignmentResult result = fit_rigid_ransac(matches, options.ransac, seed);
  result.features = keep_deformable(matches, result.motion, options.max_deformation);
  return result;
}

std::vector<Parameter> feature_rows() {
  const FeatureOptions defaults;
  return {
      real("scale", defaults.scale)
          .range(0.1, 1)
          .doc("Images are shrunk by this before features are looked for: half takes a quarter of the time; "
               "less where the object would be left with fewer than 6000 pixels"),
      real("ratio", defaults.ratio)
          .range(0.1, 1)
          .doc("Greatest ratio of a match's descriptor distance to that of the second best"),
      integer("iterations", defaults.ransac.iterations).range(1, 1000000).doc("Triples that RANSAC tries"),
      real("inlier_distance", defaults.ransac.inlier_distance)
          .unit("mm")
          .above(0)
          .doc("A match agrees with a motion that brings its points nearer than this"),
      integer("min_inliers", defaults.min_inliers)
          .range(3, 100000)
          .doc("With fewer agreeing matches there is no alignment"),
      real("max_deformation", defaults.max_deformation)
          .unit("mm")
          .above(0)
          .doc("Matches further than this from the rigid motion are no constraints of the energy `feature`"),
  };
}

FeatureOptions read_feature_options(const Parameters& section) {
  FeatureOptions options;
  options.scale = section.real("scale");
  options.ratio = section.real("ratio");
  options.min_inliers = static_cast<int>(section.integer("min_inliers"));
  options.max_deformation = section.real("max_deformation");
  options.ransac.iterations = static_cast<int>(section.integer("iterations"));
  options.ransac.inlier_distance = section.real("inlier_distance");
  return options;
}

void register_feature_alignment(Registry& registry) {
  registry.add<Alignment>(
      "features", "Rigid motion that most matches of colour features agree with [SIFT, FLANN, RANSAC]",
      ParameterTable(feature_rows()), [](const Parameters& parameters, const Registry&) {
        return std::make_unique<FeatureAlignment>(read_feature_options(parameters));
      });
}

}  // namespace pliant
