#include "framework/registration/align_automatic.h"

#include <algorithm>
#include <memory>

#include "framework/core/error.h"
#include "framework/registration/align_features.h"
#include "framework/registration/alignment.h"

namespace pliant {
namespace {

bool has_point(const RgbdFrame& frame, int u, int v) {
  return is_depth(frame.depth(u, v)) && (frame.mask.empty() || frame.mask(u, v) != 0);
}

double cut_distance(const FramePair& pair, const Eigen::Vector3d& point, double cut) {
  if (!(point.z() > 0)) return cut;
  const Eigen::Vector2d pixel = pair.camera.project(point).array().round();
  const bool is_inside = pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() < pair.target.depth.width() &&
                         pixel.y() < pair.target.depth.height();
  if (!is_inside) return cut;
  const int u = static_cast<int>(pixel.x());
  const int v = static_cast<int>(pixel.y());
  if (!has_point(pair.target, u, v)) return cut;
  return std::min(cut, (point - pair.camera.unproject(u, v, pair.target.depth(u, v))).norm());
}

class AutomaticAlignment : public Alignment {
 public:
  AutomaticAlignment(const FeatureOptions& options, double near_enough)
      : options_(options), near_enough_(near_enough) {}

  AlignmentResult align(const FramePair& pair, std::uint64_t seed, bool wants_features) const override {
    if (pair.source.color.empty() || pair.target.color.empty()) return {};
    const double residual_at_rest = cut_residual(pair, Eigen::Isometry3d::Identity());
    if (!wants_features && residual_at_rest < near_enough_) return {};
    try {
      return nearer(pair, align_by_features(pair, options_, seed), residual_at_rest);
    } catch (const DataError&) {
      return {};  // too little texture to align by
    }
  }

 private:
  /// `found`, or no motion with the features that suit it where that lies nearer.
  AlignmentResult nearer(const FramePair& pair, AlignmentResult found, double residual_at_rest) const {
    const auto stay = Eigen::Isometry3d::Identity();
    const bool is_trusted = found.inliers >= options_.min_inliers;
    if (is_trusted && cut_residual(pair, found.motion) < residual_at_rest) return found;
    found.motion = stay;
    found.features =
        is_trusted ? keep_deformable(found.features, stay, options_.max_deformation) : PointMatches{};
    return found;
  }

  FeatureOptions options_;
  double near_enough_;
};

}  // namespace

double cut_residual(const FramePair& pair, const Eigen::Isometry3d& motion, double cut) {
  double sum = 0;
  int count = 0;
  for (int v = 2; v < pair.source.depth.height(); v += 4) {
    for (int u = 2; u < pair.source.depth.width(); u += 4) {
      if (!has_point(pair.source, u, v)) continue;
      sum += cut_distance(pair, motion * pair.camera.unproject(u, v, pair.source.depth(u, v)), cut);
      ++count;
    }
  }
  return count > 0 ? sum / count : cut;
}

void register_automatic_alignment(Registry& registry) {
  std::vector<Parameter> rows = feature_rows();
  rows.push_back(real("near_enough", 20)
                     .unit("mm")
                     .at_least(0)
                     .doc("Where the source begins nearer than this to the target and no energy uses "
                          "features, they are not looked for; 0: always"));
  registry.add<Alignment>(
      "automatic",
      "As `features` where there is colour and that brings the source nearer to the target; else as `none`",
      ParameterTable(std::move(rows)), [](const Parameters& parameters, const Registry&) {
        return std::make_unique<AutomaticAlignment>(read_feature_options(parameters),
                                                    parameters.real("near_enough"));
      });
}

}  // namespace pliant
