#include "framework/config/config.h"

#include <cmath>
#include <filesystem>

#include <gmock/gmock.h>

#include "framework/core/error.h"
#include "tests/config/toy_experiment.h"

namespace pliant::test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class Config : public ToyExperiment {};

std::vector<std::string> labels(const Parameters::Sections& sections) {
  std::vector<std::string> names;
  for (const auto& [label, section] : sections) names.push_back(label);
  return names;
}

bool same(const Parameters& a, const Parameters& b);

bool same(const Parameters::Value& a, const Parameters::Value& b) {
  if (a.name != b.name || a.is_section != b.is_section || a.value.index() != b.value.index()) return false;
  const auto* sections = std::get_if<Parameters::Sections>(&a.value);
  if (const auto* flag = std::get_if<bool>(&a.value)) return *flag == std::get<bool>(b.value);
  if (const auto* number = std::get_if<std::int64_t>(&a.value))
    return *number == std::get<std::int64_t>(b.value);
  if (const auto* number = std::get_if<double>(&a.value))
    return *number == std::get<double>(b.value) &&
           std::signbit(*number) == std::signbit(std::get<double>(b.value));
  if (const auto* text = std::get_if<std::string>(&a.value)) return *text == std::get<std::string>(b.value);
  if (const auto* list = std::get_if<std::vector<std::string>>(&a.value))
    return *list == std::get<std::vector<std::string>>(b.value);
  const auto& others = std::get<Parameters::Sections>(b.value);
  if (sections->size() != others.size()) return false;
  for (std::size_t i = 0; i < others.size(); ++i) {
    if ((*sections)[i].first != others[i].first || !same((*sections)[i].second, others[i].second))
      return false;
  }
  return true;
}

bool same(const Parameters& a, const Parameters& b) {
  if (a.component() != b.component() || a.values().size() != b.values().size()) return false;
  for (std::size_t i = 0; i < a.values().size(); ++i) {
    if (!same(a.values()[i], b.values()[i])) return false;
  }
  return true;
}

TEST_F(Config, FillsInEveryDefault) {
  const Parameters values = load(minimal).values;
  EXPECT_EQ(values.component(), "");
  EXPECT_EQ(values.text("title"), "untitled");
  EXPECT_EQ(values.section("data").component(), "sheet");
  EXPECT_EQ(values.section("data").real("amplitude"), 20);
  EXPECT_FALSE(values.has("align"));
  EXPECT_EQ(values.section("solver").component(), "gauss_newton");
  EXPECT_EQ(values.section("solver").integer("iterations"), 10);
  EXPECT_EQ(values.section("solver").real("tolerance"), 1e-6);
  EXPECT_EQ(values.section("solver").section("linear").component(), "cholesky");
  EXPECT_THAT(labels(values.sections("energies")), ElementsAre("rotation"));
  EXPECT_EQ(values.sections("energies")[0].second.text("robust"), "none");
  EXPECT_EQ(values.section("stop").real("limit"), 0.001);
  EXPECT_EQ(values.section("stop").integer("rounds"), 20);
  EXPECT_FALSE(values.section("stop").section("deep").boolean("early"));
  EXPECT_THAT(values.words("metrics"), IsEmpty());
  EXPECT_THAT(values.sections("variants"), IsEmpty());
  EXPECT_THAT(values.section("compare").sections("with"), IsEmpty());
}

TEST_F(Config, ReadsEveryType) {
  const Parameters values = load(R"(
title: 2024
data: {type: sheet, amplitude: -1.5e1}
align: {}
solver: {iterations: +7, linear: {type: cg, iterations: 12}}
energies:
  rotation: ~
  near: {type: constraint, weight: 3, plane: false}
  far: {type: constraint, weight: .5}
  "short": rotation
stop: {limit: 1., deep: {early: true}}
metrics: [epe, 'nearest']
)",
                                 {"align.type=features"})
                                .values;
  EXPECT_EQ(values.text("title"), "2024");
  EXPECT_EQ(values.section("data").real("amplitude"), -15);
  EXPECT_EQ(values.section("align").real("ratio"), 0.85);
  EXPECT_EQ(values.section("solver").integer("iterations"), 7);
  EXPECT_EQ(values.section("solver").section("linear").integer("iterations"), 12);
  const auto& energies = values.sections("energies");
  EXPECT_THAT(labels(energies), ElementsAre("rotation", "near", "far", "short"));
  EXPECT_EQ(energies[0].second.component(), "rotation");
  EXPECT_EQ(energies[1].second.component(), "constraint");
  EXPECT_FALSE(energies[1].second.boolean("plane"));
  EXPECT_EQ(energies[2].second.real("weight"), 0.5);
  EXPECT_EQ(energies[3].second.component(), "rotation");
  EXPECT_EQ(values.section("stop").real("limit"), 1);
  EXPECT_TRUE(values.section("stop").section("deep").boolean("early"));
  EXPECT_THAT(values.words("metrics"), ElementsAre("epe", "nearest"));
}

TEST_F(Config, OneWordIsAListOfOne) {
  EXPECT_THAT(load(minimal + "metrics: epe\n").values.words("metrics"), ElementsAre("epe"));
}

TEST_F(Config, RangesIncludeTheirEndsUnlessTheySayAbove) {
  EXPECT_THAT(errors(minimal + "solver: {iterations: 1, tolerance: 0}\n"), IsEmpty());
  EXPECT_THAT(errors(minimal + "solver: {iterations: 100, tolerance: 1}\n"), IsEmpty());
  EXPECT_EQ(errors(minimal + "stop: {limit: 0}\n").size(), 1u);
}

TEST_F(Config, AnchorsAreExpanded) {
  const auto values = load("data: sheet\nenergies:\n  a: &e {type: rotation, weight: 4}\n  b: *e\n").values;
  EXPECT_EQ(values.sections("energies")[1].second.real("weight"), 4);
}

TEST_F(Config, FilesAreFoundBesideTheFileThenInTheDataFolders) {
  data_folders_ = {folder_ / "first", folder_ / "second"};
  write("second/a.png", "");
  EXPECT_EQ(load("data: {type: pair, depth: a.png}\nenergies: {}\n").values.section("data").text("depth"),
            (folder_ / "second/a.png").string());
  write("first/a.png", "");
  EXPECT_EQ(load("data: {type: pair, depth: a.png}\nenergies: {}\n").values.section("data").text("depth"),
            (folder_ / "first/a.png").string());
  write("a.png", "");
  EXPECT_EQ(load("data: {type: pair, depth: ./a.png}\nenergies: {}\n").values.section("data").text("depth"),
            (folder_ / "a.png").string());
}

TEST_F(Config, FilesAreFoundBesideTheBaseThatNamesThem) {
  write("base/a.png", "");
  write("base/base.yaml", "data: {type: pair, depth: a.png}\nenergies: {}\n");
  const auto data = load("extends: base/base.yaml\n").values.section("data");
  EXPECT_EQ(data.text("depth"), (folder_ / "base/a.png").string());
}

TEST_F(Config, FilesOfSetAreFoundFromTheCurrentFolder) {
  write("elsewhere/b.png", "");
  write("a.png", "");
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder_ / "elsewhere");
  const std::string text = "data: {type: pair, depth: a.png}\nenergies: {}\n";
  const auto found = errors(text, {"data.depth=b.png"});
  const auto beside_the_file = errors(text, {"data.depth=a.png"});
  std::filesystem::current_path(before);
  EXPECT_THAT(found, IsEmpty());
  EXPECT_THAT(beside_the_file,
              ElementsAre("--set data.depth: 'data.depth' names the file 'a.png', which does "
                          "not exist; looked for elsewhere/a.png"));
}

TEST_F(Config, ExtendsIsFoundInABaseFolderWhenItIsNotBesideTheFile) {
  write("installed/methods/toy.yaml", "extends: root.yaml\ntitle: installed\n");
  write("installed/methods/root.yaml",
        "data: sheet\nenergies: {constraint: {weight: 1}}\nsolver: {iterations: 3}\n");
  const auto file = write("mine/exp.yaml", "extends: methods/toy.yaml\n");
  const ConfigSource source{file, {}, {}, {folder_ / "nowhere", folder_ / "installed"}};
  const auto values = load_experiment(source, table_, registry_).values;
  EXPECT_EQ(values.text("title"), "installed");
  EXPECT_EQ(values.section("solver").integer("iterations"), 3);
  write("mine/methods/toy.yaml", "extends: ../../installed/methods/root.yaml\ntitle: beside\n");
  EXPECT_EQ(load_experiment(source, table_, registry_).values.text("title"), "beside");
}

TEST_F(Config, ExtendsMergesKeyByKeyInTheOrderOfTheBase) {
  write("root.yaml",
        "data: sheet\nsolver: {iterations: 3, tolerance: 0.5}\nenergies: {rotation: {weight: 2}}\n");
  write("methods/middle.yaml", "extends: ../root.yaml\nsolver: {iterations: 4}\nstop: {rounds: 5}\n");
  const auto values =
      load("extends: methods/middle.yaml\nenergies: {constraint: {weight: 1}, rotation: {robust: huber}}\n")
          .values;
  EXPECT_EQ(values.section("solver").integer("iterations"), 4);
  EXPECT_EQ(values.section("solver").real("tolerance"), 0.5);
  EXPECT_EQ(values.section("stop").integer("rounds"), 5);
  EXPECT_THAT(labels(values.sections("energies")), ElementsAre("rotation", "constraint"));
  EXPECT_EQ(values.sections("energies")[0].second.real("weight"), 2);
  EXPECT_EQ(values.sections("energies")[0].second.text("robust"), "huber");
}

TEST_F(Config, ExtendsTakesAbsolutePathsAndTheSameBaseMayServeTwice) {
  const auto base = write("other/base.yaml", minimal);
  EXPECT_THAT(errors("extends: " + base.string() + "\n"), IsEmpty());
}

TEST_F(Config, AnotherTypeReplacesTheSection) {
  write("base.yaml", minimal + "solver: {type: ceres_lm, threads: 8, linear: cg}\n");
  const auto replaced = load("extends: base.yaml\nsolver: {type: gauss_newton}\n").values.section("solver");
  EXPECT_EQ(replaced.integer("iterations"), 10);
  EXPECT_EQ(replaced.section("linear").component(), "cholesky");
  const auto merged =
      load("extends: base.yaml\nsolver: {type: ceres_lm, linear: {type: cg, iterations: 9}}\n")
          .values.section("solver");
  EXPECT_EQ(merged.integer("threads"), 8);
  EXPECT_EQ(merged.section("linear").integer("iterations"), 9);
}

TEST_F(Config, ATypeThatIsOnlyImpliedCounts) {
  write("base.yaml", "data: sheet\nsolver: {iterations: 5}\nenergies: {rotation: {weight: 2}}\n");
  const auto same_type =
      load("extends: base.yaml\nsolver: gauss_newton\nenergies: {rotation: {type: rotation}}\n").values;
  EXPECT_EQ(same_type.section("solver").integer("iterations"), 5);
  EXPECT_EQ(same_type.sections("energies")[0].second.real("weight"), 2);
  const auto other =
      load("extends: base.yaml\nsolver: ceres_lm\nenergies: {rotation: {type: constraint, weight: 9}}\n")
          .values;
  EXPECT_EQ(other.section("solver").component(), "ceres_lm");
  EXPECT_EQ(other.sections("energies")[0].second.component(), "constraint");
}

TEST_F(Config, AnEmptyLabelKeepsWhatTheBaseSays) {
  write("base.yaml", "data: sheet\nenergies: {rotation: {weight: 2}}\n");
  const auto values = load("extends: base.yaml\nenergies: {rotation: }\n").values;
  EXPECT_EQ(values.sections("energies")[0].second.real("weight"), 2);
}

TEST_F(Config, SetsAccumulateInAnyOrder) {
  const std::string text = minimal + "solver: {iterations: 5}\n";
  const std::vector<std::vector<std::string>> orders{
      {"solver.type=ceres_lm", "solver.threads=3", "solver.linear.type=cg", "solver.linear.iterations=4"},
      {"solver.linear.iterations=4", "solver.threads=3", "solver.linear=cg", "solver=ceres_lm"},
      {"solver.threads=3", "solver.linear={iterations: 4}", "solver.linear.type=cg", "solver.type=ceres_lm"}};
  for (const auto& sets : orders) {
    SCOPED_TRACE(sets.front());
    const auto solver = load(text, sets).values.section("solver");
    EXPECT_EQ(solver.component(), "ceres_lm");
    EXPECT_EQ(solver.integer("threads"), 3);
    EXPECT_EQ(solver.section("linear").component(), "cg");
    EXPECT_EQ(solver.section("linear").integer("iterations"), 4);
  }
}

TEST_F(Config, SetMergesIntoASectionOfTheSameType) {
  const auto solver =
      load(minimal + "solver: {iterations: 5}\n", {"solver.tolerance=0.25"}).values.section("solver");
  EXPECT_EQ(solver.integer("iterations"), 5);
  EXPECT_EQ(solver.real("tolerance"), 0.25);
}

TEST_F(Config, TheLastSetOfAKeyWins) {
  EXPECT_EQ(load(minimal, {"stop.rounds=3", "stop.rounds=4"}).values.section("stop").integer("rounds"), 4);
  const auto solver = load(minimal, {"solver.type=ceres_lm", "solver.threads=9", "solver.type=gauss_newton"})
                          .values.section("solver");
  EXPECT_EQ(solver.component(), "gauss_newton");
}

TEST_F(Config, SetTakesAnyYaml) {
  const auto values = load(minimal, {"metrics=[a, b]", "stop={rounds: 2}", "energies.constraint={weight: 1}",
                                     "title=a=b", "variants.v.stop.rounds=7"})
                          .values;
  EXPECT_THAT(values.words("metrics"), ElementsAre("a", "b"));
  EXPECT_EQ(values.section("stop").integer("rounds"), 2);
  EXPECT_THAT(labels(values.sections("energies")), ElementsAre("rotation", "constraint"));
  EXPECT_EQ(values.text("title"), "a=b");
  EXPECT_EQ(values.sections("variants")[0].second.section("stop").integer("rounds"), 7);
}

TEST_F(Config, EveryOverrideIsAWholeExperiment) {
  const auto values = load(minimal + R"(
solver: {iterations: 5, tolerance: 0.5}
variants:
  plain:
  tight: {solver: {tolerance: 0.25}}
  other: {solver: ceres_lm, energies: {constraint: {weight: 2}}}
compare:
  repeat: 3
  with: {big: {data: {amplitude: 90}}}
)")
                          .values;
  const auto& variants = values.sections("variants");
  EXPECT_THAT(labels(variants), ElementsAre("plain", "tight", "other"));
  EXPECT_EQ(variants[0].second.section("solver").real("tolerance"), 0.5);
  EXPECT_EQ(variants[1].second.section("solver").real("tolerance"), 0.25);
  EXPECT_EQ(variants[1].second.section("solver").integer("iterations"), 5);
  EXPECT_EQ(variants[2].second.section("solver").component(), "ceres_lm");
  EXPECT_THAT(labels(variants[2].second.sections("energies")), ElementsAre("rotation", "constraint"));
  EXPECT_THAT(labels(values.sections("energies")), ElementsAre("rotation"));
  for (const auto& [label, variant] : variants) {
    EXPECT_FALSE(variant.has("variants"));
    EXPECT_FALSE(variant.has("compare"));
    EXPECT_EQ(variant.section("stop").integer("rounds"), 20);
  }
  const auto& compared = values.section("compare").sections("with");
  EXPECT_EQ(compared[0].second.section("data").real("amplitude"), 90);
}

TEST_F(Config, OverridesOfBaseAndOverlayMerge) {
  write("base.yaml", minimal + "variants: {a: {solver: {iterations: 3}}, b: {title: b}}\n");
  const auto values =
      load("extends: base.yaml\nvariants: {a: {solver: {tolerance: 0.5}}, b: , c: {title: c}}\n").values;
  const auto& variants = values.sections("variants");
  EXPECT_THAT(labels(variants), ElementsAre("a", "b", "c"));
  EXPECT_EQ(variants[0].second.section("solver").integer("iterations"), 3);
  EXPECT_EQ(variants[0].second.section("solver").real("tolerance"), 0.5);
  EXPECT_EQ(variants[1].second.text("title"), "b");
}

TEST_F(Config, AFragmentWithoutATypeFitsAnyType) {
  write("base.yaml", minimal + "variants: {a: {solver: {threads: 5}}}\n");
  const auto values = load("extends: base.yaml\nvariants: {a: {solver: ceres_lm}}\n").values;
  const auto& solver = values.sections("variants")[0].second.section("solver");
  EXPECT_EQ(solver.component(), "ceres_lm");
  EXPECT_EQ(solver.integer("threads"), 5);
}

TEST_F(Config, TheResolvedTreeIsTypedAndInTheOrderOfTheTable) {
  write("a.png", "");
  const auto json = load(R"(
metrics: epe
variants: {v: {data: {type: pair, depth: a.png}, solver: ceres_lm, energies: {rotation: }}}
energies: {turn: {type: rotation, weight: 2}, rotation: }
data: sheet
)")
                        .to_json();
  EXPECT_EQ(json.dump(), nlohmann::ordered_json::parse(R"({
    "title": "untitled",
    "data": {"type": "sheet", "amplitude": 20.0},
    "solver": {"type": "gauss_newton", "iterations": 10, "tolerance": 1e-6, "linear": {"type": "cholesky"}},
    "energies": {"turn": {"type": "rotation", "weight": 2.0, "robust": "none"},
                 "rotation": {"type": "rotation", "weight": 1.0, "robust": "none"}},
    "stop": {"limit": 0.001, "rounds": 20, "deep": {"early": false}},
    "metrics": ["epe"],
    "variants": {"v": {"data": {"type": "pair", "depth": "PATH"}, "solver": {"type": "ceres_lm"},
                       "energies": {"rotation": {}}}},
    "compare": {"repeat": 1, "pixels": 32, "with": {}}})")
                             .patch({{{"op", "replace"},
                                      {"path", "/variants/v/data/depth"},
                                      {"value", (folder_ / "a.png").string()}}})
                             .dump());
}

TEST_F(Config, TheResolvedFileLoadsToTheSameValues) {
  write("data/a b.png", "");
  write("base.yaml", minimal + "solver: {type: ceres_lm, threads: 3}\n");
  const Experiment first = load(R"(
extends: base.yaml
title: "tricky: 'quotes', \"both\", \\ # and\n\ttabs \x01 é 😀 - "
align: {type: features, ratio: 0.30000000000000004}
stop: {limit: 1.7976931348623157e308, rounds: 9223372036854775807}
data: {type: sheet, amplitude: -0.0}
metrics: ["", "null", "true", "~", "1", "1e3", "- a", "a: b", "{", "*x", "&x", "yes", plain_word]
energies:
  "a: b": rotation
  constraint: {weight: 5e-324, plane: false}
variants:
  plain: ~
  "no": {solver: gauss_newton, data: {type: pair, depth: data/a b.png}}
  more: {solver: {threads: 4, linear: {type: cg, tolerance: 0.1}}, energies: {new: rotation}}
compare: {with: {x: {stop: {deep: {early: true}}}}}
)");
  const std::string yaml = first.to_yaml();
  const Experiment again =
      load_experiment({write("elsewhere/resolved.yaml", yaml), {}, {}}, table_, registry_);
  EXPECT_TRUE(same(first.values, again.values)) << yaml;
  EXPECT_EQ(again.to_json(), first.to_json());
  EXPECT_EQ(again.to_yaml(), yaml);
  EXPECT_EQ(yaml.find("extends"), std::string::npos);
}

TEST_F(Config, TheResolvedFileIsPleasantToRead) {
  EXPECT_EQ(load(minimal + "metrics: [epe, 'yes']\n").to_yaml(), R"(title: untitled
data:
  type: sheet
  amplitude: 20.0
solver:
  type: gauss_newton
  iterations: 10
  tolerance: 1e-06
  linear:
    type: cholesky
energies:
  rotation:
    type: rotation
    weight: 1.0
    robust: none
stop:
  limit: 0.001
  rounds: 20
  deep:
    early: false
metrics: [epe, "yes"]
variants: {}
compare:
  repeat: 1
  pixels: 32
  with: {}
)");
}

}  // namespace
}  // namespace pliant::test
