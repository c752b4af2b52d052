#include "experiments/training/head_forest_training.h"

namespace pliant {
namespace {

ParameterTable trees_table(const HeadForestTraining::Trees& trees) {
  const GrowthOptions& growth = trees.growth;
  return {
      integer("count", trees.count).range(1, 100).doc("how many"),
      integer("patches", trees.patches).range(2, 1000).doc("of a head, in each view"),
      integer("tests", growth.tests).range(1, 100000).doc("pairs of boxes that are tried for each question"),
      integer("thresholds", growth.thresholds).range(1, 1000).doc("that are tried of each pair"),
      integer("looked_at", growth.looked_at)
          .range(2, 1e6)
          .doc("patches, at most, by which a question is chosen"),
      integer("least_patches", growth.least_patches).range(1, 1e6).doc("in a leaf"),
      integer("greatest_depth", growth.greatest_depth)
          .range(0, 60)
          .doc("questions on the way to a leaf, at most"),
      real("steepness", growth.steepness)
          .above(0)
          .doc("questions until it counts for most that poses are told, and not that heads are"),
  };
}

HeadForestTraining::Trees read_trees(const Parameters& section) {
  const auto number = [&](const char* name) { return static_cast<int>(section.integer(name)); };
  GrowthOptions growth;
  growth.tests = number("tests");
  growth.thresholds = number("thresholds");
  growth.looked_at = number("looked_at");
  growth.least_patches = number("least_patches");
  growth.greatest_depth = number("greatest_depth");
  growth.steepness = section.real("steepness");
  return {number("count"), number("patches"), growth};
}

}  // namespace

ParameterTable head_forest_training_table() {
  const HeadForestTraining training;
  const HeadViewOptions& view = training.view;
  return {
      integer("seed", static_cast<std::int64_t>(training.seed))
          .range(0, 4294967295.0)
          .doc("of all that is drawn"),
      integer("heads", training.heads).range(1, 1000).doc("identities"),
      integer("views", training.views).range(1, 1e6).doc("of heads"),
      integer("other_views", training.other_views)
          .range(0, 1e6)
          .doc("of what is no head: hands, bags, bodies, sheets"),
      real("nearest", view.nearest).unit("mm").range(200, 5000).doc("from the camera to a head"),
      real("farthest", view.farthest).unit("mm").range(200, 5000).doc("likewise"),
      real("yaw", view.greatest_angles.x()).unit("degree").range(0, 180).doc("to either side"),
      real("pitch", view.greatest_angles.y()).unit("degree").range(0, 90).doc("up and down"),
      real("roll", view.greatest_angles.z()).unit("degree").range(0, 180).doc("to either side"),
      real("variety", view.variety)
          .range(0, 3)
          .doc("heads are stretched, dented and given hair: 0 stay as they are modelled"),
      real("company", view.company)
          .range(0, 1)
          .doc("how likely there are shoulders, and something before or behind"),
      real("noise", view.noise).range(0, 10).doc("of the sensor: 1 as the first Kinect"),
      real("share", training.share).range(0, 1).doc("of all patches that each tree sees"),
      group("voting", trees_table(training.voting))
          .doc("trees that see patches and vote for a head's centre"),
      group("refining", trees_table(training.refining))
          .doc("trees that see the whole head and correct its pose"),
  };
}

HeadForestTraining read_head_forest_training(const Parameters& values) {
  HeadForestTraining training;
  training.seed = static_cast<std::uint64_t>(values.integer("seed"));
  training.heads = static_cast<int>(values.integer("heads"));
  training.views = static_cast<int>(values.integer("views"));
  training.other_views = static_cast<int>(values.integer("other_views"));
  training.view.nearest = values.real("nearest");
  training.view.farthest = values.real("farthest");
  training.view.greatest_angles = {values.real("yaw"), values.real("pitch"), values.real("roll")};
  training.view.variety = values.real("variety");
  training.view.company = values.real("company");
  training.view.noise = values.real("noise");
  training.share = values.real("share");
  training.voting = read_trees(values.section("voting"));
  training.refining = read_trees(values.section("refining"));
  return training;
}

}  // namespace pliant
