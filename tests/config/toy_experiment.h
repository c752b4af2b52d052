#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "framework/config/config.h"
#include "framework/core/parameters.h"
#include "framework/core/registry.h"

namespace pliant::test {

/// The interfaces that the toy components pretend to have.
struct Energy {
  static constexpr const char* kind = "energy";
  double weight = 0;
};
struct Solver {
  static constexpr const char* kind = "solver";
};
struct LinearSolver {
  static constexpr const char* kind = "linear_solver";
};
struct Data {
  static constexpr const char* kind = "data";
};
struct Alignment {
  static constexpr const char* kind = "alignment";
};

Registry toy_registry();

/// An experiment with a row of every type.
ParameterTable toy_table();

/// The same, whose variants can be swept.
ParameterTable swept_toy_table();

/// A complete, valid file that says nothing beyond what the toy table asks for.
inline const std::string minimal = "data: sheet\nenergies: {rotation: {}}\n";

/// Experiments in a folder of their own.
class ToyExperiment : public testing::Test {
 protected:
  ToyExperiment();
  ~ToyExperiment() override;

  /// Writes a file (and its folders) below the folder of the test; returns its path.
  std::filesystem::path write(const std::string& name, const std::string& text) const;

  Experiment load(const std::string& text, const std::vector<std::string>& sets = {});

  /// The lines of the ConfigError that the file "exp.yaml" with this text ends in, with the folder of the
  /// test left out; empty when it loads.
  std::vector<std::string> errors(const std::string& text, const std::vector<std::string>& sets = {});

  std::filesystem::path folder_;
  std::vector<std::filesystem::path> data_folders_;
  Registry registry_ = toy_registry();
  ParameterTable table_ = toy_table();
};

}  // namespace pliant::test
