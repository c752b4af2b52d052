#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/runner/experiment.h"
#include "experiments/tasks/workbench.h"
#include "tests/io/test_files.h"

namespace pliant::test {

/// Experiments written by tests, over the methods that come with the project.
class ExperimentFiles : public TestFiles {
 protected:
  ExperimentFiles();

  /// `text` laid over methods/ed.yaml and a sheet of 160 x 120 pixels.
  ExperimentPlan plan(const std::string& text, const std::vector<std::string>& sets = {}) const;

  /// The text of a file of this test.
  std::string text_of(const std::string& name) const;

  Registry registry_;
  Workbench workbench_{registry_};
};

/// Of an object, in their order.
std::vector<std::string> keys_of(const nlohmann::ordered_json& object);

}  // namespace pliant::test
