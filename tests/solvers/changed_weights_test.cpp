#include <gmock/gmock.h>

#include "tests/problem/components.h"
#include "tests/solvers/solve.h"

// Weights and scales of losses that change between two solves of a bound solver count as if the problem had
// been made with them.
namespace pliant::test {
namespace {

struct Setting {
  double weight;
  double loss_scale;
};

using Settings = std::vector<Setting>;  ///< of each term

struct Before {
  std::string name;
  Settings settings;
};

void PrintTo(const Before& before, std::ostream* out) { *out << before.name; }

class ChangedWeights : public SolverTest, public testing::WithParamInterface<Before> {
 protected:
  /// Energies of every stencil; of those over constraints one without a loss and one with.
  std::vector<Energy> made_energies(const Settings& settings) const {
    std::vector<Energy> made;
    for (const std::string yaml : {"{type: rotation}", "{type: regularization}", "{type: constraint}",
                                   "{type: point_to_plane, loss: welsch}"}) {
      Energy& energy = made.emplace_back(*make<Energy>(registry_, yaml));
      energy.weight = settings[made.size() - 1].weight;
      energy.loss.scale = settings[made.size() - 1].loss_scale;
    }
    return made;
  }

  Problem problem(const Settings& settings) const {
    return make_sheet_problem({.nodes = 30, .constraints = 300}, made_energies(settings));
  }

  static void change(Problem& problem, const Settings& settings) {
    for (std::size_t term = 0; term < settings.size(); ++term) {
      problem.set_weight(term, settings[term].weight);
      problem.set_loss_scale(term, settings[term].loss_scale);
    }
  }

  // Ceres sums over several threads in the order in which they finish.
  std::vector<std::string> deterministic_solvers() const {
    auto all = all_solvers("max_iterations: 6");
    for (auto& yaml : all)
      if (yaml.find("ceres") != std::string::npos) yaml.replace(yaml.size() - 1, 1, ", threads: 1}");
    return all;
  }
};

const Settings usual{{20, 10}, {10, 10}, {30, 10}, {100, 10}};

TEST_P(ChangedWeights, CountAsIfMadeWithThem) {
  const auto solvers = deterministic_solvers();
  EXPECT_THAT(solvers, testing::SizeIs(testing::Ge(6)));
  for (const auto& yaml : solvers) {
    SCOPED_TRACE(yaml);
    Problem fresh = problem(usual);
    const SolverSummary expected = solve(fresh, yaml);

    Problem changed = problem(GetParam().settings);
    const auto solver = make<Solver>(registry_, yaml);
    const auto bound = solver->bind(changed, device_);
    bound->solve();
    const std::vector<float> before = changed.unknowns().host();
    changed.reset_to_identity();
    change(changed, usual);
    bound->solve();

    EXPECT_NE(before, changed.unknowns().host());
    EXPECT_EQ(changed.unknowns().host(), fresh.unknowns().host());
    EXPECT_EQ(bound->summaries().at(1).energies, expected.energies);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Settings, ChangedWeights,
    testing::Values(Before{"Stiff", {{2e4, 10}, {1e3, 10}, {30, 10}, {100, 10}}},
                    Before{"LessTolerant", {{20, 10}, {10, 10}, {30, 10}, {100, 1}}},
                    Before{"WithoutATermPerNode", {{0, 10}, {10, 10}, {30, 10}, {100, 10}}},
                    Before{"WithoutATermPerEdgeAndTheRobustOne", {{20, 10}, {0, 10}, {30, 10}, {0, 10}}},
                    Before{"WithoutMatches", {{20, 10}, {10, 10}, {0, 10}, {0, 10}}}),
    [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace pliant::test
