#include "experiments/training/head_forest_training.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "experiments/training/all_processors.h"
#include "experiments/training/head_sitter.h"

namespace pliant {
namespace {

// Streams of random numbers: each figure, view and tree has its own.
constexpr std::uint64_t figure_stream = 1'000'000;
constexpr std::uint64_t view_stream = 2'000'000;
constexpr std::uint64_t other_stream = 3'000'000;
constexpr std::uint64_t tree_stream = 4'000'000;

const FigureKind& figure_kind(const std::string& name) {
  const auto& kinds = figure_kinds();
  return *std::find_if(kinds.begin(), kinds.end(), [&](const FigureKind& kind) { return kind.name == name; });
}

std::vector<Figure> random_figures(const std::string& name, int count, std::uint64_t seed, std::uint64_t stream) {
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
      TrainingPatch patch{DepthPatch(view.depth, camera, pixel.x(), pixel.y())};
      patch.is_head = shown == Shown::head;
      const Eigen::Vector3d point = camera.unproject(pixel.x(), pixel.y(), view.depth(pixel.x(), pixel.y()));
      patch.offset = (view.camera_from_head.translation() - point).cast<float>();
      patch.angles = angles;
      patches.push_back(patch);
    }
  }
  return patches;
}

/// The patches of many views, which `view` draws, in their order.
template <class View>
void add_views(std::vector<TrainingPatch>& patches, int count, int heads, int others, std::uint64_t seed,
               std::uint64_t stream, View view) {
  std::vector<std::vector<TrainingPatch>> parts(static_cast<std::size_t>(count));
  on_all_processors(parts.size(), [&](std::size_t i) {
    Draw draw(seed, stream + i);
    parts[i] = patches_of(view(draw), heads, others, draw);
  });
  for (const auto& part : parts) patches.insert(patches.end(), part.begin(), part.end());
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

std::vector<TrainingPatch> draw_patches(const HeadForestTraining& training) {
  const std::uint64_t seed = training.seed;
  const int others = training.patches / 2;
  std::vector<TrainingPatch> patches;
  const HeadViews views(random_figures("head", training.heads, seed, figure_stream), training.view);
  add_views(patches, training.views, training.patches, others, seed, view_stream,
            [&](Draw& draw) { return views.draw(draw); });
  if (training.other_views == 0) return patches;
  const std::vector<Figure> figures = other_figures(seed);
  add_views(patches, training.other_views, 0, 2 * others, seed, other_stream,
            [&](Draw& draw) { return draw_figure(figures[draw.index(figures.size())], training.view, draw); });
  return patches;
}

}  // namespace

HeadForest train_head_forest(const HeadForestTraining& training,
                             const std::function<void(const std::string&)>& tell) {
  tell(fmt::format("rendering {} views of {} heads", training.views, training.heads));
  const std::vector<TrainingPatch> patches = draw_patches(training);
  tell(fmt::format("growing {} trees on {} patches", training.trees, patches.size()));
  HeadForest forest;
  forest.trees.resize(static_cast<std::size_t>(training.trees));
  on_all_processors(forest.trees.size(), [&](std::size_t i) {
    Draw draw(training.seed, tree_stream + i);
    std::vector<const TrainingPatch*> own;
    for (const TrainingPatch& patch : patches)
      if (draw.chance(training.patches_of_tree)) own.push_back(&patch);
    forest.trees[i] = grow_tree(std::move(own), training.growth, draw);
  });
  return forest;
}

}  // namespace pliant
