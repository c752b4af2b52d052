// `pliant track`: frames one after the other into a model, with what is told of each.
#include <gmock/gmock.h>

#include <cmath>

#include "experiments/datasets/frame_source.h"
#include "experiments/runner/overview.h"
#include "experiments/runner/runner.h"
#include "experiments/tasks/json_file.h"
#include "experiments/view/track_observer.h"
#include "framework/core/error.h"
#include "framework/io/gltf.h"
#include "framework/io/images.h"
#include "framework/io/surface_mesh.h"
#include "framework/io/trajectory_file.h"
#include "tests/experiments/experiment_files.h"

namespace pliant::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;
using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string tracked_head =
    "model: {type: tsdf, volume: fitted, resolution: 64}\n"
    "acquisition: {filter: none}\n"
    "data:\n"
    "  type: head\n"
    "  keys: {a: {at: 0}, b: {at: 0.2, camera: {look_from: [20, 0, 0]}}}\n";

class TrackTest : public ExperimentFiles {
 protected:
  ordered_json track(const std::string& text, const RunOptions& options = {}) {
    const ExperimentPlan plan =
        this->plan(text, {"data.image_width=160", "data.image_height=120", "data.focal_length=131.25"});
    result_ = run_experiment(*make_task(plan.experiment.values), plan, file("out"), workbench_, {}, options);
    return ordered_json::parse(text_of("out/result.json"))["runs"][0];
  }

  ExperimentResult result_;
};

TEST_F(TrackTest, TellsOfEveryFrameAndWritesModelAndTrajectory) {
  const ordered_json run = track(tracked_head);
  EXPECT_EQ(run["frames"], 7);
  EXPECT_EQ(run["tracked"], 6);
  EXPECT_EQ(run["lost"], 0);
  EXPECT_LT(run["truth"]["ate_translation"], 2);
  const auto lines = read_json_lines(file("out/frames.jsonl"));
  ASSERT_EQ(lines.size(), 7U);
  EXPECT_EQ(lines[0]["state"], "started");
  EXPECT_EQ(lines[6]["frame"], 7);
  EXPECT_TRUE(lines[6].contains("error"));
  EXPECT_EQ(read_whole_lines(file("out/frames.csv")).size(), 8U);
  const auto trajectory = read_trajectory(file("out/trajectory.txt"));
  ASSERT_EQ(trajectory.size(), 7U);
  EXPECT_NEAR(trajectory[6].pose.translation().x(), 20, 2) << "mm, where the camera is";
  EXPECT_GT(read_surface_mesh(file("out/model.ply"), 1).vertices.size(), 500U);
  EXPECT_TRUE(fs::exists(file("out/model.glb")));
  EXPECT_THAT(text_of("out/index.html"), HasSubstr("Error of rigid tracking"));
}

TEST_F(TrackTest, OfNothingThatIsTrackedNoErrorIsTold) {
  const ordered_json run = track("model: {type: tsdf, volume: scene, distance: 1000000}\n" +
                                 tracked_head.substr(tracked_head.find("acquisition")));
  EXPECT_EQ(run["tracked"], 0);
  EXPECT_EQ(run["lost"], 6);
  for (const char* key : {"mean_error", "error_mean", "error_sd"}) EXPECT_FALSE(run.contains(key)) << key;
}

TEST_F(TrackTest, EndsEarlyWithWhatThereIs) {
  RunOptions options;
  options.is_ended = [asked = 0]() mutable { return ++asked > 4; };  // also before the run
  EXPECT_EQ(track(tracked_head, options)["frames"], 3);
  EXPECT_NO_THROW(check_ends(result_));
}

/// Has seen enough after some frames.
class Watching : public TrackObserver {
 public:
  explicit Watching(int most) : most_(most) {}
  void begin(const Rig& rig) override { width = rig.depth.width; }
  bool show(const TrackedFrame& tracked) override {
    EXPECT_EQ(tracked.record.number, static_cast<int>(colors.size()) + 1);
    EXPECT_NE(tracked.model, nullptr);
    colors.push_back(tracked.color);
    return tracked.record.number < most_;
  }

  int width = 0;
  std::vector<ColorImage> colors;

 private:
  int most_;
};

TEST_F(TrackTest, IsWatchedUntilTheObserverHasSeenEnough) {
  Watching watching(3);
  RunOptions options;
  options.observer = &watching;
  EXPECT_EQ(track(tracked_head, options)["frames"], 3);
  EXPECT_EQ(watching.width, 160);
  EXPECT_EQ(watching.colors.size(), 3U);
}

TEST_F(TrackTest, WhoWatchesSeesTheVirtualObject) {
  write("box.obj", "v -20 -20 0\nv 20 -20 0\nv 0 20 0\nf 1 2 3\n");
  const std::string colored = tracked_head + "  texture: skin\n";
  Watching plain(2);
  RunOptions options;
  options.observer = &plain;
  track(colored, options);
  Watching augmented(2);
  options.observer = &augmented;
  track(colored + "augmentation: {mesh: box.obj, scale: 1, at: [0, 0, 400], color: [1, 2, 3]}\n", options);
  ASSERT_EQ(augmented.colors.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    ASSERT_FALSE(plain.colors[i].empty());
    EXPECT_NE(plain.colors[i].pixels(), augmented.colors[i].pixels()) << i;
    EXPECT_EQ(plain.colors[i](0, 0), augmented.colors[i](0, 0)) << i;
  }
}

// Nothing deforms here: what goes with points that are followed is where it would be without them.
TEST_F(TrackTest, TheVirtualObjectStaysOnARigidModel) {
  write("box.obj", "v -20 -20 0\nv 20 -20 0\nv 0 20 0\nf 1 2 3\n");
  const std::string augmented = tracked_head +
                                "  texture: skin\naugmentation: {mesh: box.obj, scale: 1, at: [0, 0, 400], "
                                "color: [1, 2, 3], reach: 1000}\n";
  Watching fixed(4);
  RunOptions options;
  options.observer = &fixed;
  track(augmented, options);
  Watching carried(4);
  options.observer = &carried;
  track(augmented + "followed: {from: 2, step: 4}\n", options);
  ASSERT_EQ(carried.colors.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    int different = 0;
    for (std::size_t pixel = 0; pixel < fixed.colors[i].size(); ++pixel)
      different += fixed.colors[i].data()[pixel] == carried.colors[i].data()[pixel] ? 0 : 1;
    EXPECT_LE(different, 4) << "frame " << i + 1;
  }
}

TEST_F(TrackTest, LeavesStripViewAndFilm) {
  track(tracked_head + "record: {video: true, every: 2}\nreports: {pictures: {}, page: {}, view: {}}\n");
  EXPECT_GT(fs::file_size(file("out/strip.png")), 2000U);
  const auto view = ordered_json::parse(text_of("out/view.json"));
  EXPECT_EQ(view["steps"].size(), 7U);
  EXPECT_EQ(view["steps"][6]["number"], 7);
  EXPECT_GT(view["target"]["triangles"].get<std::string>().size(), 1000U) << "the model";
  EXPECT_THAT(text_of("out/index.html"), HasSubstr("class=\"view-figure\""));
  const std::string film = text_of("out/video.avi");
  EXPECT_EQ(film[48], 4) << "pictures, of frames 1, 3, 5 and 7";
}

TEST_F(TrackTest, WritesWhereFollowedPointsWent) {
  const std::string followed = "followed: {from: 2, step: 4}\n";
  const std::string record = "record: {tracks: both, tracks_every: 2}\n";
  track(tracked_head + followed + record);
  const SurfaceMesh first = read_surface_mesh(file("out/tracks/frame_0002.ply"), 1);
  EXPECT_GT(first.vertices.size(), 100U);
  EXPECT_GT(first.triangles.size(), 100U);
  const SurfaceMesh last = read_surface_mesh(file("out/tracks/frame_0006.ply"), 1);
  EXPECT_EQ(last.vertices, first.vertices) << "the model is rigid, and the tracks are in its frame";
  EXPECT_FALSE(fs::exists(file("out/tracks/frame_0003.ply")));
  const GltfScene scene = read_gltf_scene(file("out/tracks.glb"));
  EXPECT_EQ(scene.mesh.vertices.size(), first.vertices.size());
  EXPECT_EQ(scene.mesh.targets.size(), 2U);
  EXPECT_NEAR(scene.animations.at(0).duration, 4 / 30.0, 1e-6);
  track(tracked_head);
  EXPECT_FALSE(fs::exists(file("out/tracks"))) << "a result without tracks takes their place";
  EXPECT_FALSE(fs::exists(file("out/tracks.glb")));
  track(tracked_head + "followed: {from: 100}\n" + record);
  EXPECT_THAT(result_.runs.at(0).notes, ::testing::Contains(HasSubstr("no tracks are written")));
  try {
    check_experiment(plan(tracked_head + record), workbench_);
    ADD_FAILURE();
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("'tracks' of points, but none is followed"));
  }
}

TEST_F(TrackTest, AStudyShowsFramesPicturesAndViewsOfRuns) {
  const std::string text =
      tracked_head +
      "reports: {pictures: {}, view: {}}\n"
      "record: {error_at: [3, 6], error_scale: 5}\n"
      "sweep: {seed: [1, 2]}\n"
      "study:\n"
      "  charts:\n"
      "    error:\n"
      "      {title: Figure 6.4, kind: frames, y_label: mm, limits: {threshold: {value: 2}},\n"
      "       series: {rigid: {value: mean_error, where: [seed=1], color: red}}}\n"
      "  tables: {t: {title: T, rows: [seed], columns: {error: {value: mean_error}, share: {value: "
      "tracked / frames}}}}\n"
      "  pictures: {errors: {title: Figure 6.5}}\n"
      "  views: {model: {where: [seed=2]}}\n";
  const ExperimentPlan plan =
      this->plan(text, {"data.image_width=160", "data.image_height=120", "data.focal_length=131.25"});
  result_ = run_experiment(*make_task(plan.experiment.values), plan, file("out"), workbench_);
  const Study study = study_of(plan, result_, workbench_.device(plan.runs[0].values).info(), file("out"));
  ASSERT_EQ(study.charts[0].series[0].points.size(), 7U);
  EXPECT_TRUE(std::isnan(study.charts[0].series[0].points[0].value)) << "the model began with it";
  const auto lines = read_json_lines(file("out/seed=1/frames.jsonl"));
  EXPECT_EQ(study.charts[0].series[0].points[6].value, lines[6]["mean_error"].get<double>());
  EXPECT_EQ(study.tables[0].rows[1].cells.at(2), "0.86");
  ASSERT_EQ(study.pictures.size(), 1U);
  EXPECT_EQ(study.pictures[0].pictures.size(), 2U);
  EXPECT_EQ(study.views.size(), 1U);
  EXPECT_TRUE(study.notes.empty());
  EXPECT_THAT(text_of("out/charts/error.svg"), HasSubstr("threshold: 2"));
  EXPECT_THAT(text_of("out/index.html"), AllOf(HasSubstr("Figure 6.4"), HasSubstr("Figure 6.5")));
}

TEST_F(TrackTest, FramesToBeShownAreNumbers) {
  for (const char* frame : {"zero", "0", "1.5", "-3"}) {
    const ExperimentPlan bad = plan(tracked_head + "record: {error_at: [5, " + frame + "]}\n");
    try {
      check_experiment(bad, workbench_);
      ADD_FAILURE() << frame;
    } catch (const ConfigError& error) {
      EXPECT_THAT(error.what(), HasSubstr("'" + std::string(frame) + "' in 'error_at' is no frame"));
    }
  }
}

TEST_F(TrackTest, FramesToBeShownThatDoNotComeAreTold) {
  track(tracked_head + "record: {error_at: [3, 40, 50]}\n");
  EXPECT_THAT(result_.runs.at(0).notes, ::testing::Contains(HasSubstr("does not show frame 40, 50:")));
}

TEST_F(TrackTest, AColorIsOfBytes) {
  try {
    plan(tracked_head + "augmentation: {mesh: box.obj, color: [0, 0, 256]}\n");
    ADD_FAILURE();
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("color"), HasSubstr("255")));
  }
}

TEST_F(TrackTest, OfSeveralRunsTheNextIsNotBegunAndNoneTakenForWhole) {
  const std::string two = tracked_head + "runs: {one: {}, two: {}}\nreports: {}\n";
  const ExperimentPlan plan = this->plan(two, {"data.image_width=160", "data.image_height=120"});
  RunOptions options;
  int asked = 0;
  options.is_ended = [&] { return ++asked > 4; };
  const auto task = make_task(plan.experiment.values);
  result_ = run_experiment(*task, plan, file("out"), workbench_, {}, options);
  ASSERT_EQ(result_.runs.size(), 1U);
  EXPECT_EQ(result_.runs[0].json["frames"], 3);
  ASSERT_EQ(result_.failed.size(), 1U);
  EXPECT_THAT(result_.failed[0].message, HasSubstr("run two: it was ended before"));
  const ExperimentResult again = run_experiment(*task, plan, file("out"), workbench_);
  EXPECT_TRUE(again.taken.empty()) << "the first saw three frames of seven";
  EXPECT_EQ(again.runs[0].json["frames"], 7);
}

TEST_F(TrackTest, WhatBreaksAStreamLeavesTheFramesBefore) {
  fs::create_directories(file("frames/depth"));
  for (int i = 0; i < 4; ++i) {
    DepthImage depth(160, 120, 0);
    for (int v = 20; v < 100; ++v)
      for (int u = 20; u < 140; ++u) depth(u, v) = 700 + static_cast<float>(u % 40);
    write_depth(file("frames/depth/00000" + std::to_string(i) + ".png"), depth);
  }
  write("frames/depth/000002.png", "torn");
  write("K.txt", "131.25 0 79.5\n0 131.25 59.5\n0 0 1\n");
  const ExperimentPlan plan = this->plan(
      "model: {type: tsdf, volume: fitted, resolution: 64}\ndata: {type: folder, folder: frames, intrinsics: "
      "K.txt}\n");
  result_ = run_experiment(*make_task(plan.experiment.values), plan, file("out"), workbench_);
  const auto run = ordered_json::parse(text_of("out/result.json"))["runs"][0];
  EXPECT_EQ(run["frames"], 2);
  EXPECT_THAT(run["broken_by"], HasSubstr("000002.png"));
  EXPECT_THROW(check_ends(result_), DataError);
}

TEST_F(TrackTest, AWrongFocalLengthIsAWarningWithTheFigure) {
  fs::create_directories(file("frames/depth"));
  const auto values =
      plan(
          "data: {type: head, image_width: 160, image_height: 120, focal_length: 131.25, frames: "
          "21, keys: {a: {at: 0}, b: {at: 0.67, camera: {look_from: [-220, 60, 40]}}}}\n")
          .runs.at(0)
          .values;
  const auto head = registry_.make<FrameSource>(values.section("data"))->open(workbench_.device(values), 1);
  for (int number = 100; const auto frame = head->next(); ++number)
    write_depth(file("frames/depth/" + std::to_string(number) + ".png"), frame->depth);
  const std::string wrong =
      "model: {type: tsdf, volume: fitted, resolution: 64}\nacquisition: {filter: none}\n"
      "data: {type: folder, folder: frames, fx: 110, fy: 110, cx: 79.5, cy: 59.5}\n";
  const ExperimentPlan plan = this->plan(wrong);
  run_experiment(*make_task(plan.experiment.values), plan, file("out"), workbench_);
  const auto run = ordered_json::parse(text_of("out/result.json"))["runs"][0];
  EXPECT_NEAR(run["focal_length"]["change"], 131.25 / 110 - 1, 0.06);
  EXPECT_THAT(run["warnings"].dump(), HasSubstr("fit together best with a focal length that is"));
}

TEST_F(TrackTest, ChecksTheFirstFrame) {
  const ExperimentPlan good = plan(tracked_head);
  EXPECT_TRUE(check_experiment(good, workbench_).empty());
  const ExperimentPlan bad =
      plan("model: tsdf\ndata: {type: folder, folder: ., fx: 100, fy: 100, cx: 80, cy: 60}\n");
  EXPECT_THROW(check_experiment(bad, workbench_), Error);
}

}  // namespace
}  // namespace pliant::test
