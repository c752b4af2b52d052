#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "experiments/report/report.h"

namespace pliant {

/// A plane at 800 mm registered to one at `target_depth` by moving it straight there but for `left` mm.
/// 40 x 30 pixels; the column 10 has no source depth and no colour is known.
struct SampleRun {
  explicit SampleRun(float left);
  ReportInput input() const { return {pair, target, nearest, run}; }

  static constexpr float target_depth = 830;
  FramePair pair;
  SurfaceImage target;
  NearestDistances nearest;
  RunRecord run;
};

/// An empty folder of this test alone.
std::filesystem::path test_folder();

std::unique_ptr<Report> make_report(const std::string& name);

}  // namespace pliant
