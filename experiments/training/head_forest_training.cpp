#include "experiments/training/head_forest_training.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "experiments/training/all_processors.h"
#include "experiments/training/head_sitter.h"
#include "experiments/training/head_trial.h"
#include "framework/core/angle.h"
#include "framework/pose/head_search.h"

namespace pliant {
namespace {

// Streams of random numbers: each figure, view and tree has its own.
constexpr std::uint64_t figure_stream = 1'000'000;
constexpr std::uint64_t view_stream = 2'000'000;
constexpr std::uint64_t other_stream = 3'000'000;
constexpr std::uint64_t voting_stream = 4'000'000;
constexpr std::uint64_t refining_stream = 5'000'000;

const FigureKind& figure_kind(const std::string& name) {
  const auto& kinds = figure_kinds();
  return *std::find_if(kinds.begin(), kinds.end(), [&](const FigureKind& kind) { return kind.name == name; });
}

std::vector<Figure> random_figures(const std::string& name, int count, std::uint64_t seed,
                                   std::uint64_t stream) {
  std::vector<Figure> figures(static_cast<std::size_t>(count));
  on_all_processors(figures.size(), [&](std::size_t i) {
    Draw draw(seed, stream + i);
    figures[i] = random_figure(figure_kind(name), draw);
  });
  return figures;
}

/// So many pixels that show something with depth.
std::vector<Eigen::Vector2i> random_pixels(const HeadView& view, Shown shown, int count, Draw& draw) {
  std::vector<Eigen::Vector2i> all;
  for (int v = 0; v < view.depth.height(); ++v)
    for (int u = 0; u < view.depth.width(); ++u)
      if (view.shown(u, v) == shown && is_depth(view.depth(u, v))) all.emplace_back(u, v);
  std::vector<Eigen::Vector2i> some;
  for (int i = 0; i < count && !all.empty(); ++i) some.push_back(all[draw.index(all.size())]);
  return some;
}

std::vector<TrainingPatch> patches_of(const HeadView& view, int heads, int others, Draw& draw) {
  std::vector<TrainingPatch> patches;
  const Camera camera = head_camera();
  const Eigen::Vector3f angles = head_angles(view.camera_from_head.linear()).cast<float>();
  for (const auto& [shown, count] : {std::pair{Shown::head, heads}, {Shown::other, others}}) {
    for (const Eigen::Vector2i& pixel : random_pixels(view, shown, count, draw)) {
      const Eigen::Vector3d point = camera.unproject(pixel.x(), pixel.y(), view.depth(pixel.x(), pixel.y()));
      TrainingPatch patch{patch_around(view.depth, camera, point)};
      patch.is_head = shown == Shown::head;
      patch.offset = (view.camera_from_head.translation() - point).cast<float>();
      patch.angles = angles;
      patches.push_back(patch);
    }
  }
  return patches;
}

/// Of poses as they may be taken for the head's: some almost right, others as far away as votes are.
std::vector<TrainingPatch> refining_patches_of(const HeadView& view, int count, Draw& draw) {
  const Eigen::Vector3d farthest_turn = Eigen::Vector3d(22, 36, 15) * degree;
  constexpr double farthest_offset = 22;  // mm
  const std::vector<Eigen::Vector3f> points =
      points_near(view.depth, head_camera(), view.camera_from_head.translation());
  std::vector<TrainingPatch> patches;
  for (int i = 0; i < count; ++i) {
    const double share = draw.uniform(0, 1);
    Eigen::Vector3d offset;
    Eigen::Vector3d turn;
    for (int axis = 0; axis < 3; ++axis) {
      offset[axis] = share * farthest_offset * draw.normal();
      turn[axis] = share * farthest_turn[axis] * draw.normal();
    }
    TrainingPatch patch{patch_of_head(points, view.camera_from_head * moved(offset, turn).inverse())};
    patch.is_head = true;
    patch.offset = offset.cast<float>();
    patch.angles = turn.cast<float>();
    patches.push_back(patch);
  }
  return patches;
}

/// The patches of many views in their order, each drawn with a stream of its own.
HeadPatches patches_of_views(int count, std::uint64_t seed, std::uint64_t stream,
                             const std::function<HeadPatches(Draw&)>& of_view) {
  std::vector<HeadPatches> parts(static_cast<std::size_t>(count));
  on_all_processors(parts.size(), [&](std::size_t i) {
    Draw draw(seed, stream + i);
    parts[i] = of_view(draw);
  });
  HeadPatches all;
  for (HeadPatches& part : parts) {
    all.voting.insert(all.voting.end(), part.voting.begin(), part.voting.end());
    all.refining.insert(all.refining.end(), part.refining.begin(), part.refining.end());
    part = {};
  }
  return all;
}

std::vector<Figure> other_figures(std::uint64_t seed) {
  constexpr int each = 2;
  std::vector<Figure> others;
  std::uint64_t stream = figure_stream + 500'000;
  for (const char* name : {"sheet", "hand", "bag", "body"}) {
    for (Figure& figure : random_figures(name, each, seed, stream)) others.push_back(std::move(figure));
    stream += each;
  }
  return others;
}

std::vector<HeadTree> grow_trees(const std::vector<TrainingPatch>& patches,
                                 const HeadForestTraining::Trees& options, double share, std::uint64_t seed,
                                 std::uint64_t stream) {
  std::vector<HeadTree> trees(static_cast<std::size_t>(options.count));
  on_all_processors(trees.size(), [&](std::size_t i) {
    Draw draw(seed, stream + i);
    std::vector<const TrainingPatch*> own;
    for (const TrainingPatch& patch : patches)
      if (draw.chance(share)) own.push_back(&patch);
    trees[i] = grow_tree(own, options.growth, draw);
  });
  return trees;
}

}  // namespace

std::vector<Figure> random_heads(int count, std::uint64_t seed, std::uint64_t stream) {
  return random_figures("head", count, seed, stream);
}

HeadPatches draw_head_patches(const HeadForestTraining& training) {
  const std::uint64_t seed = training.seed;
  const int others = training.voting.patches / 2;
  const HeadViews views(random_heads(training.heads, seed, figure_stream), training.view);
  HeadPatches patches = patches_of_views(training.views, seed, view_stream, [&](Draw& draw) {
    const HeadView view = views.draw(draw);
    HeadPatches of_view;
    of_view.voting = patches_of(view, training.voting.patches, others, draw);
    of_view.refining = refining_patches_of(view, training.refining.patches, draw);
    return of_view;
  });
  if (training.other_views == 0) return patches;
  const std::vector<Figure> figures = other_figures(seed);
  const HeadPatches more = patches_of_views(training.other_views, seed, other_stream, [&](Draw& draw) {
    const HeadView view = draw_figure(figures[draw.index(figures.size())], training.view, draw);
    return HeadPatches{patches_of(view, 0, 2 * others, draw), {}};
  });
  patches.voting.insert(patches.voting.end(), more.voting.begin(), more.voting.end());
  return patches;
}

HeadForest grow_head_forest(const HeadPatches& patches, const HeadForestTraining& training) {
  const auto grow = [&](const std::vector<TrainingPatch>& all, const HeadForestTraining::Trees& trees,
                        std::uint64_t stream) {
    return grow_trees(all, trees, training.share, training.seed, stream);
  };
  return {grow(patches.voting, training.voting, voting_stream),
          grow(patches.refining, training.refining, refining_stream)};
}

}  // namespace pliant
