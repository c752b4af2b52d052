#include <gmock/gmock.h>

#include "framework/config/config_sweep.h"
#include "tests/config/toy_experiment.h"

namespace pliant::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::StartsWith;

/// The toy experiment, whose variants can be swept.
class Sweep : public ToyExperiment {
 protected:
  Sweep() { table_ = swept_toy_table(); }

  Parameters::Sections variants(const std::string& text, const std::vector<std::string>& sets = {}) {
    return load(minimal + text, sets).values.sections("variants");
  }
};

std::vector<std::string> names(const Parameters::Sections& variants) {
  std::vector<std::string> names;
  for (const auto& variant : variants) names.push_back(variant.first);
  return names;
}

TEST_F(Sweep, IsTheProductOfItsListsTheLastChangesFastest) {
  const auto made = variants("sweep:\n  stop.rounds: [3, 1]\n  data.amplitude: [0.5, 2]\n");
  EXPECT_THAT(names(made), ElementsAre("rounds=3,amplitude=0.5", "rounds=3,amplitude=2",
                                       "rounds=1,amplitude=0.5", "rounds=1,amplitude=2"));
  EXPECT_EQ(made[1].second.section("stop").integer("rounds"), 3);
  EXPECT_EQ(made[1].second.section("data").real("amplitude"), 2);
  EXPECT_EQ(made[2].second.section("stop").integer("rounds"), 1);
  EXPECT_EQ(made[2].second.section("data").real("amplitude"), 0.5);
  EXPECT_EQ(made[2].second.section("stop").real("limit"), 0.001);
}

TEST_F(Sweep, OverridesAreSweptOneByOneAndTheSweepWins) {
  const auto made = variants(
      "variants: {a: {title: A, stop: {limit: 0.5}}, b: }\nsweep: {title: [x, y], solver: [ceres_lm]}\n");
  EXPECT_THAT(names(made), ElementsAre("a,title=x,solver=ceres_lm", "a,title=y,solver=ceres_lm",
                                       "b,title=x,solver=ceres_lm", "b,title=y,solver=ceres_lm"));
  EXPECT_EQ(made[1].second.text("title"), "y");
  EXPECT_EQ(made[1].second.section("stop").real("limit"), 0.5);
  EXPECT_EQ(made[2].second.section("stop").real("limit"), 0.001);
  EXPECT_EQ(made[3].second.section("solver").component(), "ceres_lm");
}

TEST_F(Sweep, KeysAreNamedByTheShortestEndsThatDiffer) {
  const auto made = variants(
      "sweep: {energies.rotation.weight: [1], energies.pull: [constraint], energies.pull.weight: [2], "
      "title: [t]}\n");
  EXPECT_THAT(names(made), ElementsAre("rotation.weight=1,pull=constraint,pull.weight=2,title=t"));
  const auto& energies = made[0].second.sections("energies");
  EXPECT_EQ(energies[1].second.component(), "constraint");
  EXPECT_EQ(energies[1].second.real("weight"), 2);
}

TEST_F(Sweep, ValuesMayBeListsAndEveryNameFitsAFolder) {
  const auto made = variants("sweep: {metrics: [[], epe, [epe, a/b]], title: ['a=b,c']}\n");
  EXPECT_THAT(names(made), ElementsAre("metrics=[],title=a_b_c", "metrics=epe,title=a_b_c",
                                       "metrics=[epe,a_b],title=a_b_c"));
  EXPECT_THAT(made[2].second.words("metrics"), ElementsAre("epe", "a/b"));
  EXPECT_EQ(made[2].second.text("title"), "a=b,c");
}

TEST_F(Sweep, FilesStartAtTheFolderOfTheFileThatNamesThem) {
  write("base/a.png", "");
  write("base/b.png", "");
  write("base/base.yaml", minimal + "sweep: {data.type: [pair], data.depth: [a.png, b.png]}\n");
  const auto made = load("extends: base/base.yaml\n").values.sections("variants");
  EXPECT_EQ(made[1].second.section("data").text("depth"), (folder_ / "base/b.png").string());
}

TEST_F(Sweep, AnotherFileOrTheCommandLineReplacesAndAddsLists) {
  write("base.yaml", minimal + "sweep: {title: [a, b], stop.rounds: [1, 2]}\n");
  const auto made = load("extends: base.yaml\nsweep: {stop.rounds: [7]}\n", {"sweep={stop.limit: [0.5]}"})
                        .values.sections("variants");
  EXPECT_THAT(names(made), ElementsAre("title=a,rounds=7,limit=0.5", "title=b,rounds=7,limit=0.5"));
}

TEST_F(Sweep, WithoutListsItIsNone) {
  EXPECT_THAT(variants("sweep: {}\n"), IsEmpty());
  EXPECT_THAT(names(variants("variants: {a: }\nsweep: {}\n")), ElementsAre("a"));
}

TEST_F(Sweep, TheResolvedFileSpellsItOut) {
  const Experiment first = load(minimal + "sweep: {stop.rounds: [1, 2], solver: [ceres_lm]}\n");
  EXPECT_EQ(first.to_json()["variants"].dump(),
            R"({"rounds=1,solver=ceres_lm":{"stop":{"rounds":1},"solver":{"type":"ceres_lm"}},)"
            R"("rounds=2,solver=ceres_lm":{"stop":{"rounds":2},"solver":{"type":"ceres_lm"}}})");
  const std::string yaml = first.to_yaml();
  EXPECT_EQ(yaml.find("sweep"), std::string::npos);
  EXPECT_EQ(load(yaml).to_yaml(), yaml);
}

TEST_F(Sweep, SweepsOfTheWrongShape) {
  EXPECT_THAT(
      errors(minimal + "sweep:\n"),
      ElementsAre("exp.yaml:3:1: 'sweep' is empty; expected a section with a list of values under each "
                  "key"));
  EXPECT_THAT(
      errors(minimal + "sweep: {title: a}\n"),
      ElementsAre("exp.yaml:3:16: 'sweep.title' is 'a'; expected a list of values under a key like a.b.c, or "
                  "partial experiments under names of their own"));
  EXPECT_THAT(errors(minimal + "sweep: {title: []}\n"),
              ElementsAre("exp.yaml:3:16: 'sweep.title' is an empty list; expected at least one value"));
  EXPECT_THAT(errors(minimal + "sweep: {stop..rounds: [1]}\n"),
              ElementsAre("exp.yaml:3:9: 'sweep.stop..rounds' leads to no key; expected one like a.b.c"));
  EXPECT_THAT(
      errors(minimal + "sweep: {solver: [a, {type: b}]}\n"),
      ElementsAre("exp.yaml:3:21: a value of 'sweep.solver' is a section; expected a scalar or a list "
                  "of scalars"));
  EXPECT_THAT(errors(minimal, {"sweep.title=[]"}),
              ElementsAre("--set sweep.title: 'sweep.title' is an empty list; expected at least one value"));
}

TEST_F(Sweep, NamesMustDiffer) {
  EXPECT_THAT(errors(minimal + "sweep:\n  title: [a/b, x, a_b]\n  stop.rounds: [1, 2]\n"),
              ElementsAre("exp.yaml:4:19: two values of 'sweep.title' are named 'a_b'; expected names that "
                          "differ"));
}

TEST_F(Sweep, EveryWrongValueIsToldOnceWhereItStands) {
  EXPECT_THAT(
      errors(minimal +
             "sweep:\n  stop.rounds: [0, 1, x]\n  stop.limt: [1, 2]\n  data.amplitude: []\n  sweep: [1]\n"
             "  compare.repeat: [1]\n"),
      ElementsAre("exp.yaml:4:17: 'stop.rounds' is '0'; expected an integer at least 1",
                  "exp.yaml:4:23: 'stop.rounds' is 'x'; expected an integer at least 1",
                  "exp.yaml:5:3: unknown key 'limt' in 'stop'; expected one of limit, rounds, deep; did you "
                  "mean 'limit'?",
                  StartsWith("exp.yaml:6:19: 'sweep.data.amplitude' is an empty list"),
                  StartsWith("exp.yaml:7:3: unknown key 'sweep'; expected one of title, data,"),
                  StartsWith("exp.yaml:8:3: unknown key 'compare'; expected one of title, data,")));
}

TEST_F(Sweep, ErrorsNameTheFileThatIsWrong) {
  write("base.yaml", minimal + "solver: {iterations: 0}\nsweep: {energies.turn: [roation]}\n");
  EXPECT_THAT(errors("extends: base.yaml\nvariants: {a: {stop: {rounds: 0}}}\n"),
              ElementsAre(StartsWith("exp.yaml:2:31: 'stop.rounds' is '0'"),
                          StartsWith("base.yaml:3:22: 'solver.iterations' is '0'"),
                          StartsWith("base.yaml:4:25: unknown energy 'roation' for 'energies.turn'")));
}

TEST_F(Sweep, OverridesThatAreNoneAreReportedAsWithoutIt) {
  EXPECT_THAT(errors(minimal + "variants: {a: 1, b: }\nsweep: {title: [x, y]}\n"),
              ElementsAre("exp.yaml:3:12: 'variants.a' is '1'; expected the keys of an experiment that "
                          "differ"));
  EXPECT_THAT(errors(minimal + "variants: 3\nsweep: {title: [x, y]}\n"),
              ElementsAre(StartsWith("exp.yaml:3:11: 'variants' is '3'; expected a section with")));
}

TEST_F(Sweep, IsRefusedWhereItIsTooLarge) {
  std::string list;
  for (int i = 0; i < 40; ++i) list += (i == 0 ? "" : ", ") + std::to_string(i + 1);
  const std::string sweep = "sweep: {stop.rounds: [" + list + "], solver.iterations: [" + list + "]}\n";
  EXPECT_THAT(errors(minimal + sweep),
              ElementsAre("exp.yaml:3:1: 'sweep' makes more than 1000 combinations; expected fewer"));
  std::string many;
  for (int i = 0; i < 9000; ++i) many += "  e" + std::to_string(i) + ": rotation\n";
  EXPECT_THAT(
      errors("sweep: {stop.rounds: [" + list + "], title: [a, b, c]}\ndata: sheet\nenergies:\n" + many),
      ElementsAre("exp.yaml:1:1: 'sweep' makes 120 combinations; expected fewer for an experiment of "
                  "this size"));
  EXPECT_THAT(errors(minimal + "sweep: {title: [" + std::string(195, 't') + "]}\n"),
              ElementsAre(StartsWith("exp.yaml:3:1: 'sweep' makes a name of 201 letters, 'title=tttt")));
  EXPECT_THAT(variants("sweep: {title: [" + std::string(194, 't') + "]}\n"), SizeIs(1));
}

TEST_F(Sweep, AnExperimentWithoutOneDoesNotKnowTheKey) {
  table_ = toy_table();
  EXPECT_THAT(errors(minimal + "sweep: {title: [a]}\n"), ElementsAre(HasSubstr("unknown key 'sweep'")));
}

TEST_F(Sweep, IsAmongTheExpectedKeys) {
  EXPECT_THAT(errors(minimal + "swep: {}\n"),
              ElementsAre(HasSubstr("variants, compare, sweep, extends; did you mean 'sweep'?")));
}

TEST_F(Sweep, AxesArePartialExperimentsUnderNames) {
  const auto made = variants("sweep:\n  kind:\n    short: {stop: {rounds: 1}}\n    none:\n  title: [x, y]\n");
  EXPECT_THAT(names(made), ElementsAre("kind=short,title=x", "kind=short,title=y", "kind=none,title=x",
                                       "kind=none,title=y"));
  EXPECT_EQ(made[0].second.section("stop").integer("rounds"), 1);
  EXPECT_EQ(made[1].second.text("title"), "y");
}

TEST_F(Sweep, WhatAnAxisNamesMayExtendAFile) {
  write("parts/short.yaml", "stop: {rounds: 1, limit: 0.5}\n");
  const auto made = variants("sweep: {kind: {short: {extends: parts/short.yaml, stop: {limit: 0.25}}}}\n");
  EXPECT_EQ(made[0].second.section("stop").integer("rounds"), 1);
  EXPECT_EQ(made[0].second.section("stop").real("limit"), 0.25);
  const auto plain = variants("variants: {short: {extends: parts/short.yaml}}\n");
  EXPECT_EQ(plain[0].second.section("stop").integer("rounds"), 1);
}

TEST_F(Sweep, WhatTheExperimentLacksItsOverridesMayGive) {
  const std::string parts = "sweep: {kind: {a: {data: sheet, energies: {rotation: }}, b: {data: sheet}}}\n";
  EXPECT_THAT(errors(parts), ElementsAre(HasSubstr("missing key 'energies'")));
  const auto made = load("energies: {rotation: {}}\n" + parts).values.sections("variants");
  EXPECT_EQ(made[1].second.section("data").component(), "sheet");
}

TEST_F(Sweep, WhatExtendsAFileOfSeveralRunsIsToldSo) {
  write("many.yaml", "sweep: {title: [a, b]}\n");
  EXPECT_THAT(errors(minimal + "sweep: {kind: {short: {extends: many.yaml}}}\n"),
              ElementsAre("exp.yaml:3:24: 'many.yaml' has 'sweep'; expected an experiment of one run"));
  EXPECT_THAT(errors(minimal + "variants: {short: {extends: exp.yaml}}\n"),
              ElementsAre(HasSubstr("'extends' goes in a circle")));
}

TEST_F(Sweep, AnAxisThatIsNoneIsToldSo) {
  EXPECT_THAT(errors(minimal + "sweep: {kind: {}}\n"), ElementsAre(HasSubstr("'sweep.kind' is empty")));
  EXPECT_THAT(
      errors(minimal + "sweep: {kind: {a: 3}}\n"),
      ElementsAre(HasSubstr("'sweep.kind.a' is '3'; expected the keys of an experiment that differ")));
  EXPECT_THAT(errors(minimal + "sweep: {kind: {'a=b': {}, a_b: {}}}\n"),
              ElementsAre(HasSubstr("two values of 'sweep.kind' are named 'a_b'")));
}

TEST(SweptValues, AreReadFromTheName) {
  const auto values = swept_values("coarse,kind=short,metrics=[epe,a],weight=0.5");
  ASSERT_THAT(values, SizeIs(4));
  EXPECT_EQ(values[0].name + ":" + values[0].value, ":coarse");
  EXPECT_EQ(values[1].name + ":" + values[1].value, "kind:short");
  EXPECT_EQ(values[2].name + ":" + values[2].value, "metrics:[epe,a]");
  EXPECT_EQ(values[3].name + ":" + values[3].value, "weight:0.5");
}

}  // namespace
}  // namespace pliant::test
