#include "framework/pose/align_automatic.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "framework/core/error.h"
#include "framework/geometry/has_point.h"
#include "framework/pose/align_features.h"
#include "framework/pose/align_icp.h"
#include "framework/pose/alignment.h"

namespace pliant {
namespace {

/// Of the cut of the two-way residual: expressions and shapes of heads begin at 0.02 to 0.17 of it, heads
/// turned by 90 degrees and more at 0.66.
constexpr double far_share = 0.5;

/// Further than what a deformation alone would put between the views.
bool is_far(const TwoWayResidual& residual) { return residual.mean > far_share * residual.cut; }

/// How far the point is from the target at its pixel, `cut` where there is none; nothing where it leaves the
/// view, because what is there is not known.
std::optional<double> cut_distance(const FramePair& pair, const Eigen::Vector3d& point, double cut) {
  if (!(point.z() > 0)) return std::nullopt;
  const Eigen::Vector2d pixel = pair.camera.project(point).array().round();
  const bool is_inside = pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() < pair.target.depth.width() &&
                         pixel.y() < pair.target.depth.height();
  if (!is_inside) return std::nullopt;
  const int u = static_cast<int>(pixel.x());
  const int v = static_cast<int>(pixel.y());
  if (!has_point(pair.target, u, v)) return cut;
  return std::min(cut, (point - pair.camera.unproject(u, v, pair.target.depth(u, v))).norm());
}

class AutomaticAlignment : public Alignment {
 public:
  AutomaticAlignment(const FeatureOptions& features, double near_enough, const RigidIcpOptions& icp)
      : features_(features), near_enough_(near_enough), icp_(icp) {}

  AlignmentResult align(const AlignmentInput& input) const override {
    AlignmentResult result = by_features(input);
    RigidIcpOptions options = icp_;
    if (result.method == "features") options.search_angle = 0;  // it is near
    const RigidIcpResult found = run_icp(input, options, result.motion);
    result.reason += "; " + described(found);
    // Where features have moved it already, that was not for a deformation: any gain makes it more precise.
    if (result.method == "features" ? !is_nearer(found) : !is_clearly_nearer(found)) {
      result.failed = result.method == "none" && is_far(found.before);
      if (!found.failed)
        result.reason += result.method == "features" ? ": not nearer" : ": not clearly nearer";
      return result;
    }
    if (!keeps_features(result, found.pose)) {
      result.reason += ": away from the features";
      return result;
    }
    move(result, found.pose);
    result.method = result.method == "features" ? "features, icp" : "icp";
    return result;
  }

 private:
  /// Whether most features that suited where they put the source still do: where a surface may slide along
  /// itself and out of view, a low residual alone is no reason to.
  bool keeps_features(const AlignmentResult& result, const Eigen::Isometry3d& motion) const {
    const std::size_t kept = keep_deformable(result.features, motion, features_.max_deformation).size();
    return 2 * kept >= result.features.size();
  }

  /// Puts the source elsewhere; features that do not suit that are dropped.
  void move(AlignmentResult& result, const Eigen::Isometry3d& motion) const {
    result.motion = motion;
    result.features = keep_deformable(result.features, motion, features_.max_deformation);
    result.inliers = 0;
    for (std::size_t i = 0; i < result.features.size(); ++i)
      result.inliers +=
          (motion * result.features.from[i] - result.features.to[i]).norm() < features_.ransac.inlier_distance
              ? 1
              : 0;
  }

  /// Where features put the source, or no motion and why.
  AlignmentResult by_features(const AlignmentInput& input) const {
    const FramePair& pair = input.pair;
    AlignmentResult stay;
    if (pair.source.color.empty() || pair.target.color.empty()) {
      stay.reason = "no features without colour";
      return stay;
    }
    const double at_rest = cut_residual(pair, stay.motion);
    if (!input.wants_features && at_rest < near_enough_) {
      stay.reason = fmt::format("no need of features, {:.1f} mm from the target", at_rest);
      return stay;
    }
    try {
      return nearer(pair, align_by_features(pair, features_, input.seed), at_rest);
    } catch (const DataError& error) {
      stay.reason = error.what();  // too little texture to align by
      return stay;
    }
  }

  /// `found`, or no motion with the features that suit it where that lies nearer.
  AlignmentResult nearer(const FramePair& pair, AlignmentResult found, double at_rest) const {
    found.reason = agreement(found.inliers, found.matches);
    if (found.inliers < features_.min_inliers) {
      found.reason += fmt::format(", fewer than {}", features_.min_inliers);
      found.features = {};
      move(found, Eigen::Isometry3d::Identity());
      return found;
    }
    const double there = cut_residual(pair, found.motion);
    found.reason += fmt::format(", {:.1f} -> {:.1f} mm from the target", at_rest, there);
    if (there < at_rest)
      found.method = "features";
    else
      move(found, Eigen::Isometry3d::Identity());
    return found;
  }

  FeatureOptions features_;
  double near_enough_;
  RigidIcpOptions icp_;
};

}  // namespace

double cut_residual(const FramePair& pair, const Eigen::Isometry3d& motion, double cut) {
  constexpr double fewest_known = 0.25;
  double sum = 0;
  int count = 0;
  int known = 0;
  for (int v = 2; v < pair.source.depth.height(); v += 4) {
    for (int u = 2; u < pair.source.depth.width(); u += 4) {
      if (!has_point(pair.source, u, v)) continue;
      ++count;
      const auto distance =
          cut_distance(pair, motion * pair.camera.unproject(u, v, pair.source.depth(u, v)), cut);
      if (!distance) continue;
      sum += *distance;
      ++known;
    }
  }
  return known > 0 && known >= fewest_known * count ? sum / known : cut;
}

void register_automatic_alignment(Registry& registry) {
  std::vector<Parameter> rows = feature_rows();
  rows.push_back(real("near_enough", 20)
                     .unit("mm")
                     .at_least(0)
                     .doc("Where the source begins nearer than this to the target and no energy uses "
                          "features, they are not looked for; 0: always"));
  rows.push_back(group("icp", ParameterTable(icp_rows())).doc("As of `icp`"));
  registry.add<Alignment>(
      "automatic",
      "By `features` where there is colour and that brings the source nearer to the target; from there, or "
      "else from far, by `icp` where that brings it nearer, from far clearly so; else as `none`",
      ParameterTable(std::move(rows)), [](const Parameters& parameters, const Registry&) {
        return std::make_unique<AutomaticAlignment>(read_feature_options(parameters),
                                                    parameters.real("near_enough"),
                                                    read_icp_options(parameters.section("icp")));
      });
}

}  // namespace pliant
