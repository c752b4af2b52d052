// Pairs and methods that leave little or nothing to go by (docs/bad-input.md): whatever comes back is finite,
// and says how the registration ended.
#include <gmock/gmock.h>

#include <Eigen/Dense>
#include <functional>
#include <limits>
#include <random>

#include "framework/core/error.h"
#include "framework/evaluation/metrics.h"
#include "framework/geometry/pixel_index.h"
#include "framework/registration/edit.h"
#include "framework/tracking/register_pair.h"
#include "tests/experiments/experiment_files.h"

namespace pliant::test {
namespace {

using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;
using ::testing::ThrowsMessage;

using Sets = std::vector<std::string>;

class HardInputTest : public ExperimentFiles {
 protected:
  Method method_of(const Sets& sets = {}) const {
    return make_method(plan("", sets).runs[0].values, registry_);
  }
  FramePair sheet() { return workbench_.pair(plan("").runs[0].values); }

  /// Mean end-point error over that of no motion, of a sheet that lacks some of its depth.
  double share_of_error_left(const FramePair& pair, const RegistrationResult& result) {
    const Evaluation evaluation(pair, workbench_.truth(plan("").runs[0].values), result.source,
                                make_surface_image(pair.target, pair.camera));
    return evaluation.measure(result.points).truth.value().epe_mean /
           evaluation.measure(result.source.points).truth.value().epe_mean;
  }

  RegistrationResult register_with(const FramePair& pair, const Method& method) {
    auto result = register_pair(pair, method, device_, 1);
    expect_finite(result);
    return result;
  }
  RegistrationResult register_with(const FramePair& pair, const Sets& sets = {}) {
    return register_with(pair, method_of(sets));
  }

  static void expect_finite(const RegistrationResult& result) {
    for (const auto* vectors :
         {&result.points, &result.normals, &result.aligned_points, &result.node_positions})
      for (const Eigen::Vector3f& vector : *vectors) ASSERT_TRUE(vector.allFinite()) << result.termination;
    EXPECT_EQ(result.points.size(), result.source.size());
    EXPECT_TRUE(std::isfinite(result.energy.initial + result.energy.final));
    EXPECT_FALSE(result.termination.empty());
  }

  Device device_;
};

/// A pair without anything in it, for tests to draw in.
FramePair blank(int width = 160, int height = 120) {
  FramePair pair;
  pair.name = "drawn";
  pair.camera.fx = pair.camera.fy = 0.8 * width;
  pair.camera.cx = 0.5 * (width - 1);
  pair.camera.cy = 0.5 * (height - 1);
  pair.camera.width = width;
  pair.camera.height = height;
  pair.source.depth = pair.target.depth = DepthImage(width, height, 0);
  return pair;
}

struct Box {
  int left, top, right, bottom;
};

/// A gently waved patch of surface.
void draw(DepthImage& depth, const Box& box, float distance) {
  for (int v = box.top; v < box.bottom; ++v)
    for (int u = box.left; u < box.right; ++u)
      depth(u, v) =
          distance + 5 * std::sin(0.1F * static_cast<float>(u)) * std::cos(0.1F * static_cast<float>(v));
}

/// Mean change in z of the points whose pixel lies in a box.
float mean_shift(const RegistrationResult& result, const Box& box) {
  float sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < result.points.size(); ++i) {
    const Eigen::Vector2i& pixel = result.source.pixels[i];
    if (pixel.x() < box.left || pixel.x() >= box.right || pixel.y() < box.top || pixel.y() >= box.bottom)
      continue;
    sum += result.points[i].z() - result.source.points[i].z();
    ++count;
  }
  return sum / static_cast<float>(count);
}

// --- pairs that do not fit together ---

TEST_F(HardInputTest, APairWhoseCameraIsNotTheImagesIsRefused) {
  FramePair pair = sheet();
  pair.camera.width *= 2;
  const Method method = method_of();
  const Handle handle;
  const auto refuses = [&](const auto& use) {
    EXPECT_THAT(use, ThrowsMessage<DataError>(AllOf(StartsWith(pair.name + ": "), HasSubstr("pixels"))));
  };
  refuses([&] { register_pair(pair, method, device_, 1); });
  refuses([&] { freeze_problem(pair, method, device_, 1); });
  refuses([&] { edit_surface(pair, {{"handle", handle}}, method, device_); });
  refuses([&] { make_edit_problem(pair, {{"handle", handle}}, method, device_); });
  refuses([&] { source_surface(pair); });
}

// --- parts and nodes ---

TEST_F(HardInputTest, EachOfTwoPartsGoesItsOwnWay) {
  const Box left{20, 20, 70, 100}, right{90, 20, 140, 100};
  FramePair pair = blank();
  draw(pair.source.depth, left, 800);
  draw(pair.source.depth, right, 1200);  // far behind: edges between the two cross a gap in depth
  draw(pair.target.depth, left, 815);
  draw(pair.target.depth, right, 1185);
  const auto result = register_with(pair);
  EXPECT_NEAR(mean_shift(result, left), 15, 2);
  EXPECT_NEAR(mean_shift(result, right), -15, 2);
}

TEST_F(HardInputTest, APartWithoutANodeMovesWithTheNearestOnes) {
  const Box body{20, 20, 100, 100}, crumb{112, 61, 115, 64};  // between the centres of the 12 x 12 cells
  FramePair pair = blank();
  for (auto* box : {&body, &crumb}) draw(pair.source.depth, *box, 800);
  draw(pair.target.depth, body, 810);
  const auto result = register_with(pair, {"sampler.step=2"});
  EXPECT_NEAR(mean_shift(result, body), 10, 1);
  EXPECT_NEAR(mean_shift(result, crumb), 10, 3);
}

TEST_F(HardInputTest, OneNodeIsOneAffineMotion) {
  FramePair pair = blank();
  draw(pair.source.depth, {20, 20, 60, 60}, 800);
  draw(pair.target.depth, {20, 20, 60, 60}, 812);
  const auto result = register_with(pair, {"graph.spacing=64"});
  EXPECT_EQ(result.counts.nodes, 1);
  EXPECT_EQ(result.counts.edges, 0);
  EXPECT_THAT(result.warnings, ElementsAre(HasSubstr("the graph has 1 node(s)")));
  EXPECT_NEAR(mean_shift(result, {20, 20, 60, 60}), 12, 1);

  const auto count = static_cast<Eigen::Index>(result.points.size());
  Eigen::MatrixXd from(count, 4), to(count, 3);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    from.row(i) << result.source.points[at].transpose().cast<double>(), 1;
    to.row(i) = result.points[at].transpose().cast<double>();
  }
  const Eigen::MatrixXd affine = from.colPivHouseholderQr().solve(to);
  EXPECT_LT((from * affine - to).cwiseAbs().maxCoeff(), 1e-2);
}

TEST_F(HardInputTest, FewNodesMoveEveryPointTogetherAndAWarningSaysSo) {
  const auto few = register_with(sheet(), {"graph.spacing=16", "nearest_nodes=16"});
  ASSERT_GT(few.counts.nodes, 2);
  ASSERT_LE(few.counts.nodes, 16);
  EXPECT_EQ(few.counts.edges, few.counts.nodes * (few.counts.nodes - 1));
  EXPECT_LT(few.energy.final, few.energy.initial);
  EXPECT_THAT(few.warnings, ElementsAre(HasSubstr("though nearest_nodes is 16")));
  EXPECT_THAT(register_with(sheet()).warnings, IsEmpty());
}

// --- nothing that pulls ---

TEST_F(HardInputTest, NothingMovesWhereNothingPulls) {
  for (const Sets& sets : {Sets{"correspondence.max_distance=0.001"}, Sets{"energies.constraint.weight=0"},
                           Sets{"energies={rotation: {weight: 0}, constraint: {weight: 0}}"},
                           Sets{"energies={constraint: {weight: 0}, feature: {}}"}}) {
    SCOPED_TRACE(sets.front());
    const auto result = register_with(sheet(), sets);
    EXPECT_EQ(result.termination, "no_constraints");
    EXPECT_THAT(result.reason, HasSubstr("no constraint is in force"));
    EXPECT_EQ(result.counts.outer_iterations, 0);
    EXPECT_EQ(result.points, result.aligned_points);
    EXPECT_THAT(result.energy.per_iteration, IsEmpty());
  }
}

TEST_F(HardInputTest, AnEnergyOfWeightZeroHasNoEffect) {
  const std::string three = "stopping={min_progress: 0, max_iterations: 3}";
  const auto without = register_with(sheet(), {three});
  const auto with = register_with(sheet(), {three, "energies.point_to_plane={weight: 0}"});
  EXPECT_EQ(with.counts.outer_iterations, 3);
  for (std::size_t i = 0; i < with.points.size(); ++i)
    ASSERT_LT((with.points[i] - without.points[i]).norm(), 1e-2) << "point " << i;
}

/// Some points at first, none once it is asked again.
template <class Selection>
class Vanishing : public Selection {
 public:
  explicit Vanishing(std::vector<int> points) : points_(std::move(points)) {}
  const std::vector<int>& points() const override { return points_; }
  bool adapt(Device&, const Array<float>&) override {
    points_.clear();
    return true;
  }

 private:
  std::vector<int> points_;
};

class VanishingSampler : public ConstraintSampler {
  std::unique_ptr<PointSelection> select(Device&, const SurfaceView& source) const override {
    return std::make_unique<Vanishing<PointSelection>>(points_on_grid(source.pixels, 4));
  }
};

class VanishingGraph : public GraphBuilder {
  std::unique_ptr<NodeSelection> select_nodes(Device&, const SurfaceView& source) const override {
    return std::make_unique<Vanishing<NodeSelection>>(points_on_grid(source.pixels, 12));
  }
};

TEST_F(HardInputTest, WhatIsLeftOfAnAdaptiveSelectionIsNothing) {
  const auto one = register_with(sheet(), {"stopping.max_iterations=1"});
  Method method = method_of();
  method.sampler = std::make_unique<VanishingSampler>();
  const auto unsampled = register_with(sheet(), method);
  EXPECT_EQ(unsampled.termination, "no_constraints");
  EXPECT_EQ(unsampled.reason, "the sampler chose no point");
  EXPECT_EQ(unsampled.points, one.points) << "the result so far";

  method = method_of();
  method.graph = std::make_unique<VanishingGraph>();
  const auto without_nodes = register_with(sheet(), method);
  EXPECT_EQ(without_nodes.termination, "no_nodes");
  EXPECT_EQ(without_nodes.points, one.points);
}

// --- failures ---

/// Solves as another solver does; then, in the n-th solve, something happens.
class SpoiltSolver : public Solver {
 public:
  using Event = std::function<void(Problem&)>;
  SpoiltSolver(std::unique_ptr<Solver> solver, int when, Event event)
      : solver_(std::move(solver)), when_(when), event_(std::move(event)) {}

  std::unique_ptr<BoundSolver> bind(Problem& problem, Device& device) const override {
    return std::make_unique<Bound>(*this, problem, solver_->bind(problem, device));
  }

 private:
  class Bound : public BoundSolver {
   public:
    Bound(const SpoiltSolver& spoilt, Problem& problem, std::unique_ptr<BoundSolver> bound)
        : spoilt_(spoilt), problem_(problem), bound_(std::move(bound)) {}
    void solve() override {
      bound_->solve();
      if (++spoilt_.solves_ == spoilt_.when_) spoilt_.event_(problem_);
    }
    std::vector<SolverSummary> summaries() override { return bound_->summaries(); }

   private:
    const SpoiltSolver& spoilt_;
    Problem& problem_;
    std::unique_ptr<BoundSolver> bound_;
  };

  std::unique_ptr<Solver> solver_;
  int when_;
  Event event_;
  mutable int solves_ = 0;
};

struct Trouble {
  const char* reason;
  SpoiltSolver::Event event;
};

const std::vector<Trouble>& troubles() {
  static const std::vector<Trouble> all{
      {"moved where nothing is finite",
       [](Problem& problem) {
         problem.unknowns().write_host()[0] = std::numeric_limits<float>::quiet_NaN();
       }},
      {"moved where nothing is finite", [](Problem& problem) { problem.unknowns().write_host()[9] = 1e30F; }},
      {"no point of the source projects onto",
       [](Problem& problem) {
         for (float& value : problem.unknowns().write_host()) value = -1e4F;
       }},
      {"the solver gave up", [](Problem&) { throw NumericalError("the solver gave up"); }},
  };
  return all;
}

TEST_F(HardInputTest, TheResultBeforeAFailureComesBackWithTheReason) {
  for (const Sets& sets : {Sets{"filter=bilateral"}, Sets{"filter=none"}}) {
    const auto limited = [&](int iterations) {
      Sets all = sets;
      all.push_back("stopping={min_progress: 0, max_iterations: " + std::to_string(iterations) + "}");
      return all;
    };
    const auto two = register_with(sheet(), limited(2));
    for (const Trouble& trouble : troubles())
      for (const int when : {1, 3}) {
        SCOPED_TRACE(::testing::Message() << sets[0] << ": " << trouble.reason << " in solve " << when);
        Method method = method_of(limited(9));
        method.solver = std::make_unique<SpoiltSolver>(std::move(method.solver), when, trouble.event);
        const auto result = register_with(sheet(), method);
        EXPECT_EQ(result.termination, "failed");
        EXPECT_THAT(result.reason, HasSubstr(trouble.reason));
        EXPECT_EQ(result.counts.outer_iterations, when - 1);
        EXPECT_EQ(result.energy.per_iteration.size(), static_cast<std::size_t>(when - 1));
        if (when == 3) {
          EXPECT_EQ(result.points, two.points);
          EXPECT_EQ(result.normals, two.normals);
          EXPECT_EQ(result.energy.final, two.energy.final);
        }
      }
  }
}

/// Matches as another correspondence does, but from the second time on a point with what is nowhere.
class SpoiltCorrespondence : public Correspondence {
 public:
  explicit SpoiltCorrespondence(std::unique_ptr<Correspondence> correspondence)
      : correspondence_(std::move(correspondence)) {}

  void match(Device& device, const PointSet& moved, const Array<int>& selected, const SurfaceMap& target,
             Constraints& constraints) const override {
    correspondence_->match(device, moved, selected, target, constraints);
    if (++matches_ < 2) return;
    constraints.data.write_host()[0] = std::numeric_limits<float>::infinity();
    constraints.confidence.write_host()[0] = 1;
  }

  void measure(Device& device, const PointSet& moved, const SurfaceMap& target,
               Array<float>& distances) const override {
    correspondence_->measure(device, moved, target, distances);
  }

  bool measures_matches() const override { return false; }

 private:
  std::unique_ptr<Correspondence> correspondence_;
  mutable int matches_ = 0;
};

TEST_F(HardInputTest, ASolveThatCannotStartIsAFailureToo) {
  for (const std::string solver :
       {"{linear_solver: structured}", "{linear_solver: block_pcg}", "{type: ceres_lm}"}) {
    SCOPED_TRACE(solver);
    const Sets sets{"solver=" + solver, "stopping={min_progress: 0, max_iterations: 3}"};
    const auto one = register_with(sheet(), {sets[0], "stopping.max_iterations=1"});
    Method method = method_of(sets);
    method.correspondence = std::make_unique<SpoiltCorrespondence>(std::move(method.correspondence));
    const auto result = register_with(sheet(), method);
    EXPECT_EQ(result.termination, "failed");
    EXPECT_THAT(result.reason,
                AnyOf(HasSubstr("the energy is not finite"), HasSubstr("Ceres found no usable")));
    EXPECT_EQ(result.counts.outer_iterations, 1);
    EXPECT_EQ(result.points, one.points);
  }
}

TEST_F(HardInputTest, ExtremeWeightsGiveAFiniteResult) {
  for (const std::string solver :
       {"solver.linear_solver=structured", "solver.linear_solver=block_pcg",
        "solver.linear_solver=dense_cholesky", "solver={type: ceres_lm, max_iterations: 5}"})
    for (const std::string transform : {"affine", "quaternion"})
      for (const std::string energies :
           {"{constraint: {weight: 1e30}}", "{regularization: {weight: 1e30}}", "{rotation: {weight: 1e30}}",
            "{point_to_plane: {weight: 1e38}}", "{constraint: {weight: 1e-30}}"}) {
        if (transform == "quaternion" && solver.ends_with("structured")) continue;  // it refuses to
        SCOPED_TRACE(transform + " " + solver + " " + energies);
        register_with(
            sheet(), {"transform=" + transform, solver, "energies=" + energies, "stopping.max_iterations=3"});
      }
}

// --- depth that is none ---

TEST_F(HardInputTest, DepthThatIsNoneIsAHole) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const std::vector<float> nothings{std::numeric_limits<float>::quiet_NaN(), infinity, -infinity, -5, 1e30F};
  FramePair holes = sheet();
  FramePair spoilt = holes;
  std::mt19937 random(3);
  for (const auto frame : {&FramePair::source, &FramePair::target})
    for (int v = 0; v < holes.camera.height; ++v)
      for (int u = 0; u < holes.camera.width; ++u)
        if (random() % 10 == 0) {
          (holes.*frame).depth(u, v) = 0;
          (spoilt.*frame).depth(u, v) = nothings[random() % nothings.size()];
        }
  for (const Sets& sets : {Sets{"energies.point_to_plane={}"}, Sets{"filter=bilateral"}}) {
    const auto expected = register_with(holes, sets);
    const auto found = register_with(spoilt, sets);
    EXPECT_EQ(found.points, expected.points);
    EXPECT_EQ(found.normals, expected.normals);
  }
  EXPECT_EQ(make_surface_image(spoilt.target, spoilt.camera).points.pixels(),
            make_surface_image(holes.target, holes.camera).points.pixels());
}

const std::vector<Sets>& methods() {
  static const std::vector<Sets> all{
      {"graph.spacing=4", "sampler.step=1"},
      {"graph.spacing=4", "sampler.step=1", "transform=quaternion"},
      {"graph={type: quadtree, initial_levels: 2}"},
      {"graph={type: quadtree, initial_levels: 1}", "sampler={type: adaptive, step: 2}"},
      {"graph.spacing=2", "sampler.step=1", "filter=bilateral",
       "correspondence={max_angle: 45, search_radius: 40}", "solver={max_iterations: 1}",
       "energies={rotation: {}, regularization: {}, point_to_plane: {loss: welsch}, constraint: {weight: 3, "
       "loss: "
       "welsch}}"}};
  return all;
}

/// Holes, spikes and values that no camera gives, on `points` pixels of the source and on all of the target.
FramePair garbage(int points, std::mt19937& random) {
  FramePair pair = blank(40, 30);
  const auto depth = [&]() -> float {
    switch (random() % 8) {
      case 0:
        return 0;
      case 1:
        return 65535;
      case 2:
        return static_cast<float>(1 + random() % 65535);
      case 3:
        return 1;
      default:
        return static_cast<float>(790 + random() % 20);
    }
  };
  for (int i = 0; i < points; ++i)
    pair.source.depth(static_cast<int>(random() % 40), static_cast<int>(random() % 30)) = depth();
  for (int v = 0; v < 30; ++v)
    for (int u = 0; u < 40; ++u) pair.target.depth(u, v) = depth();
  return pair;
}

void keep(DepthImage& depth, const std::function<bool(int, int)>& is_kept) {
  for (int v = 0; v < depth.height(); ++v)
    for (int u = 0; u < depth.width(); ++u)
      if (!is_kept(u, v)) depth(u, v) = 0;
}

TEST_F(HardInputTest, SparseAndStripedSourcesAreRegistered) {
  const Method method =
      method_of({"energies.point_to_plane={weight: 100}", "correspondence.search_radius=8"});
  for (const int step : {2, 3, 4}) {
    FramePair sparse_source = sheet();
    keep(sparse_source.source.depth, [&](int u, int v) { return u % step == 0 && v % step == 0; });
    EXPECT_LT(share_of_error_left(sparse_source, register_with(sparse_source, method)), 0.5) << step;
    for (int missing = 0; missing < step; ++missing) {
      FramePair striped = sheet();
      keep(striped.source.depth, [&](int, int v) { return v % step != missing; });
      EXPECT_LT(share_of_error_left(striped, register_with(striped, method)), 0.5) << step << missing;
    }
  }
}

// Sparser ones draw points to where the camera looked: of those a warning tells.
TEST_F(HardInputTest, SparseTargetsAreRegisteredTo) {
  const Method method =
      method_of({"energies.point_to_plane={weight: 100}", "correspondence.search_radius=8"});
  for (const int step : {2, 3}) {
    FramePair pair = sheet();
    keep(pair.target.depth, [&](int u, int v) { return u % step == 0 && v % step == 0; });
    EXPECT_LT(share_of_error_left(pair, register_with(pair, method)), 0.5) << step;
  }
}

TEST_F(HardInputTest, WhatIsOddAboutThePairIsAmongTheWarnings) {
  FramePair pair = sheet();
  pair.warnings = {"odd"};
  EXPECT_THAT(register_with(pair).warnings, ElementsAre("odd"));
}

TEST_F(HardInputTest, GarbageIsRefusedOrRegisteredToSomethingFinite) {
  std::mt19937 random(11);
  int registered = 0;
  for (std::size_t kind = 0; kind < methods().size(); ++kind) {
    Sets sets = methods()[kind];
    sets.push_back("stopping.max_iterations=4");
    const Method method = method_of(sets);
    for (const int points : {1, 2, 5, 50, 800})
      for (int round = 0; round < 4; ++round) {
        SCOPED_TRACE(::testing::Message()
                     << "method " << kind << ", " << points << " points, round " << round);
        try {
          register_with(garbage(points, random), method);
          ++registered;
        } catch (const DataError& error) {
          EXPECT_THAT(error.what(), HasSubstr("drawn: "));
        }
      }
  }
  EXPECT_GT(registered, 30);
}

}  // namespace
}  // namespace pliant::test
