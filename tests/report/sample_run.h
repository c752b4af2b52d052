#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "experiments/report/report.h"

namespace pliant {

/// A run with an artefact of each kind. Its surfaces are planes of 40 x 30 pixels at 800 and 826 mm, without
/// the column 10.
RunArtefacts sample_run();

/// An empty folder of this test alone.
std::filesystem::path test_folder();

std::unique_ptr<Report> make_report(const std::string& name);

}  // namespace pliant
