#include "framework/pose/head_relocalizer.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "framework/io/file.h"
#include "framework/pose/head.forest.embed.h"

namespace pliant {
namespace {

constexpr std::size_t kept = 16;  // motions: of a head that turns away from the model, the old ones are wrong

double distance(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  constexpr double radius = 100;  // mm, of a head
  const Eigen::Isometry3d between = a.inverse() * b;
  return between.translation().norm() + radius * Eigen::AngleAxisd(between.linear()).angle();
}

double distance_to_all(const Eigen::Isometry3d& motion, const std::vector<Eigen::Isometry3d>& motions) {
  double sum = 0;
  for (const Eigen::Isometry3d& other : motions) sum += distance(motion, other);
  return sum;
}

/// The depth map that a surface was made of, in its window.
DepthImage depth_of(const SurfaceMap& seen) {
  std::vector<float> points(seen.points().size());
  seen.points().copy_to(points.data());
  DepthImage depth(seen.window.width, seen.window.height);
  for (std::size_t i = 0; i < depth.size(); ++i) depth.data()[i] = points[3 * i + 2];
  return depth;
}

/// The camera whose image is that window.
Camera camera_of(const SurfaceMap& seen) {
  Camera camera = seen.camera;
  camera.cx -= seen.window.left;
  camera.cy -= seen.window.top;
  camera.width = seen.window.width;
  camera.height = seen.window.height;
  return camera;
}

HeadForest load(const Parameters& section) {
  if (section.has("file")) return read_head_forest(read_file(section.text("file")), section.text("file"));
  return own_head_forest();
}

class HeadRelocalizerKind : public RelocalizerKind {
 public:
  explicit HeadRelocalizerKind(const Parameters& section)
      : forest_(std::make_shared<const HeadForest>(load(section))),
        every_(static_cast<int>(section.integer("every"))) {
    options_.stride = static_cast<int>(section.integer("stride"));
    options_.least_share = section.real("least_share");
    options_.least_confidence = section.real("least_confidence");
  }
  std::unique_ptr<Relocalizer> make(Device& /*device*/, const Rig& /*rig*/) const override {
    return std::make_unique<HeadRelocalizer>(forest_, options_, every_);
  }

 private:
  std::shared_ptr<const HeadForest> forest_;
  HeadSearchOptions options_;
  int every_;
};

ParameterTable table() {
  const HeadSearchOptions options;
  return {
      path("file").optional().doc(
          "made by `pliant train head_forest`; the forest that comes with Pliant by default"),
      integer("stride", options.stride)
          .unit("pixel")
          .range(1, 64)
          .doc("from one patch that votes to the next"),
      real("least_share", options.least_share)
          .range(0, 1)
          .doc("patches vote that look like others of which so many were on a head"),
      real("least_confidence", options.least_confidence)
          .range(0, 1)
          .doc("of all votes that a whole head could have, as many must agree on where it is"),
      integer("every", 10).range(1, 1000).doc("one tracked frame in so many tells where the model's head is"),
  };
}

}  // namespace

HeadForest own_head_forest() {
  const std::string_view own = embedded::framework_pose_head_forest;
  return read_head_forest({own.begin(), own.end()}, "the forest that comes with Pliant");
}

Eigen::Isometry3d agreed_motion(const std::vector<Eigen::Isometry3d>& motions) {
  constexpr double near = 40;  // mm, see distance()
  const auto nearest = std::min_element(motions.begin(), motions.end(), [&](const auto& a, const auto& b) {
    return distance_to_all(a, motions) < distance_to_all(b, motions);
  });
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
  Eigen::Matrix3d rotations = Eigen::Matrix3d::Zero();
  double count = 0;
  for (const Eigen::Isometry3d& motion : motions) {
    if (distance(motion, *nearest) > near) continue;
    shift += motion.translation();
    rotations += motion.linear();
    ++count;
  }
  Eigen::Isometry3d mean = Eigen::Isometry3d::Identity();
  mean.linear() = nearest_rotation(rotations);
  mean.translation() = shift / count;
  return mean;
}

HeadRelocalizer::HeadRelocalizer(std::shared_ptr<const HeadForest> forest, const HeadSearchOptions& options,
                                 int every)
    : forest_(std::move(forest)), options_(options), every_(every) {}

std::optional<HeadEstimate> HeadRelocalizer::find(const SurfaceMap& seen) const {
  return find_head(*forest_, depth_of(seen), camera_of(seen), options_);
}

void HeadRelocalizer::remember(const Frame& /*frame*/, const SurfaceMap& seen,
                               const Eigen::Isometry3d& camera_from_model) {
  if (frames_++ % every_ != 0) return;
  const auto head = find(seen);
  if (!head) return;
  if (head_from_model_.size() == kept) head_from_model_.erase(head_from_model_.begin());
  head_from_model_.push_back(head->camera_from_head.inverse() * camera_from_model);
}

std::vector<Eigen::Isometry3d> HeadRelocalizer::candidates(const Frame& /*frame*/, const SurfaceMap& seen) {
  if (head_from_model_.empty()) return {};
  const auto head = find(seen);
  if (!head) return {};
  return {head->camera_from_head * agreed_motion(head_from_model_)};
}

void register_head_relocalizer(Registry& registry) {
  registry.add<RelocalizerKind>(
      "head_forest",
      "The head in a depth map, by a random regression forest [Fanelli, Gall, Van Gool 2011; thesis 3.3]",
      table(), [](const Parameters& section, const Registry& /*components*/) {
        return std::make_unique<HeadRelocalizerKind>(section);
      });
}

}  // namespace pliant
