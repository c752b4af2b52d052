#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <exception>
#include <iostream>

#include "benchmarks/bench.h"

namespace {

/// OpenBLAS reads these when it is loaded, and they slow CHOLMOD down: Ceres is to be measured at its best.
void restart_without_openblas_settings(char** arguments) {
  if (std::getenv("OPENBLAS_CORETYPE") == nullptr && std::getenv("OPENBLAS_L2_SIZE") == nullptr) return;
  std::cerr << "OPENBLAS_CORETYPE and OPENBLAS_L2_SIZE are unset for this run\n";
  unsetenv("OPENBLAS_CORETYPE");
  unsetenv("OPENBLAS_L2_SIZE");
  execv("/proc/self/exe", arguments);
}

}  // namespace

int main(int argument_count, char** arguments) {
  restart_without_openblas_settings(arguments);
  CLI::App app("Pliant's benchmarks: every claim is a ratio within one run");
  app.require_subcommand(1);
  pliant::bench::Options options;
  const auto add_mode = [&](const char* name, const char* doc) {
    auto* mode = app.add_subcommand(name, doc);
    mode->add_option("--json", options.json, "Write the rows to this file");
    mode->add_option("--only", options.only, "Measure only what has this in its name");
    mode->add_flag("--quick", options.quick, "Fewer sizes and repetitions");
    return mode;
  };
  const auto* solver = add_mode("solver", "Device solvers against Ceres on a frozen problem");
  const auto* kernels = add_mode("kernels", "What each kernel reaches of the machine's peak");
  auto* pair = add_mode("pair", "Whole registrations of each data set with each method");
  pair->add_option("--data", options.data, "Folder in which data is looked for first");
  const auto* render = add_mode("render", "Frames of a mesh with their truth, on the device and on the host");
  const auto* pose = add_mode("pose", "Rigid tracking of sequences whose poses are known, beside OpenCV's");
  const auto* tracking = add_mode(
      "tracking", "Stages of a tracked frame beside OpenCV's, and the sequences of chapter 6 by each policy");
  const auto* relocalisation = add_mode(
      "relocalisation", "A head that leaps by 100 mm and 30 degrees: how often each relocalizer finds it");
  auto* head_forest =
      add_mode("head_forest", "Errors of the forest that finds heads, on heads it was not trained on");
  head_forest->add_option("--data", options.data, "Folder in which data is looked for first");
  CLI11_PARSE(app, argument_count, arguments);
  try {
    if (solver->parsed()) return pliant::bench::run_solver_mode(options);
    if (kernels->parsed()) return pliant::bench::run_kernels_mode(options);
    if (pair->parsed()) return pliant::bench::run_pair_mode(options);
    if (render->parsed()) return pliant::bench::run_render_mode(options);
    if (pose->parsed()) return pliant::bench::run_pose_mode(options);
    if (tracking->parsed()) return pliant::bench::run_tracking_mode(options);
    if (relocalisation->parsed()) return pliant::bench::run_relocalisation_mode(options);
    if (head_forest->parsed()) return pliant::bench::run_head_forest_mode(options);
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
  return 0;
}
