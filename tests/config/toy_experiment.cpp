#include "tests/config/toy_experiment.h"

#include <unistd.h>

#include <fstream>
#include <sstream>

#include "framework/core/error.h"

namespace pliant::test {
namespace {

template <class Interface>
Registry::Factory<Interface> plain() {
  return [](const Parameters&, const Registry&) { return std::make_unique<Interface>(); };
}

std::unique_ptr<Energy> make_energy(const Parameters& section, const Registry&) {
  auto energy = std::make_unique<Energy>();
  energy->weight = section.real("weight");
  return energy;
}

}  // namespace

Registry toy_registry() {
  Registry registry;
  registry.add<Energy>("rotation", "Keeps the nodes rigid",
                       {real("weight", 1).above(0).doc("Weight of the term"),
                        choice("robust", {"none", "huber", "tukey"}, "none").doc("Robust loss")},
                       make_energy);
  registry.add<Energy>("constraint", "Pulls points to their match",
                       {real("weight").at_least(0), boolean("plane", true)}, make_energy);
  registry.add<Solver>("gauss_newton", "Gauss-Newton on the device",
                       {integer("iterations", 10).range(1, 100).doc("Steps at most"),
                        real("tolerance", 1e-6).range(0, 1).unit("mm").doc("Change at which it stops"),
                        component("linear", "linear_solver", "cholesky").doc("For the normal equations")},
                       plain<Solver>());
  registry.add<Solver>("ceres_lm", "Levenberg-Marquardt of Ceres",
                       {integer("threads", 2).range(1, 64), component("linear", "linear_solver", "cholesky")},
                       plain<Solver>());
  registry.add<LinearSolver>("cholesky", "Dense Cholesky", {}, plain<LinearSolver>());
  registry.add<LinearSolver>("cg", "Conjugate gradients", {integer("iterations", 50), real("tolerance", 0.1)},
                             plain<LinearSolver>());
  registry.add<Data>("pair", "Two depth maps", {path("depth"), path("color").optional()}, plain<Data>());
  registry.add<Data>("sheet", "A bending sheet", {real("amplitude", 20).unit("mm")}, plain<Data>());
  registry.add<Alignment>("features", "Rigid, from features", {real("ratio", 0.85).range(0, 1)},
                          plain<Alignment>());
  return registry;
}

ParameterTable toy_table() {
  return {text("title", "untitled").doc("Name in reports"),
          component("data", "data").doc("What to register"),
          component("align", "alignment").optional(),
          component("solver", "solver", "gauss_newton"),
          components("energies", "energy"),
          group("stop", {real("limit", 0.001).above(0).unit("mm"), integer("rounds", 20).at_least(1),
                         group("deep", {boolean("early", false)})}),
          words("metrics").optional(),
          overrides("variants"),
          group("compare", {integer("repeat", 1), integer("pixels", 32).range(16, 64).multiple_of(8),
                            overrides("with")})};
}

ParameterTable swept_toy_table() {
  const ParameterTable plain = toy_table();
  std::vector<Parameter> rows;
  for (const auto& row : plain.rows())
    rows.push_back(row.name() == "variants" ? overrides("variants").swept_by("sweep") : row);
  return ParameterTable(std::move(rows));
}

ToyExperiment::ToyExperiment() {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  // Test programs run side by side and on the same machine again and again.
  folder_ = std::filesystem::temp_directory_path() /
            ("pliant_" + std::to_string(getpid()) + "_" + test->test_suite_name() + "_" + test->name());
  std::filesystem::create_directories(folder_);
  folder_ = std::filesystem::canonical(folder_);
}

ToyExperiment::~ToyExperiment() { std::filesystem::remove_all(folder_); }

std::filesystem::path ToyExperiment::write(const std::string& name, const std::string& text) const {
  const auto file = folder_ / name;
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << text;
  return file;
}

Experiment ToyExperiment::load(const std::string& text, const std::vector<std::string>& sets) {
  return load_experiment({write("exp.yaml", text), sets, data_folders_}, table_, registry_);
}

std::vector<std::string> ToyExperiment::errors(const std::string& text,
                                               const std::vector<std::string>& sets) {
  std::string message;
  try {
    load(text, sets);
  } catch (const ConfigError& error) {
    message = error.what();
  }
  const std::string prefix = folder_.string() + "/";
  for (auto at = message.find(prefix); at != std::string::npos; at = message.find(prefix, at))
    message.erase(at, prefix.size());
  std::vector<std::string> lines;
  std::istringstream stream(message);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

}  // namespace pliant::test
