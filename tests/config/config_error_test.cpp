#include <filesystem>

#include <gmock/gmock.h>

#include "framework/config/config.h"
#include "framework/core/error.h"
#include "tests/config/toy_experiment.h"

namespace pliant::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

class ConfigErrorLine : public ToyExperiment {};

TEST_F(ConfigErrorLine, YamlSyntax) {
  EXPECT_THAT(errors("data: sheet\nenergies: [1, 2\n"),
              ElementsAre("exp.yaml:3:1: not valid YAML: end of sequence flow not found"));
  EXPECT_THAT(errors("data: *nothing\n"),
              ElementsAre("exp.yaml:1:7: not valid YAML: the referenced anchor is not defined"));
}

TEST_F(ConfigErrorLine, YamlThatIsNoExperiment) {
  EXPECT_THAT(errors(""), ElementsAre("exp.yaml:1:1: the file is empty; expected the keys of an experiment"));
  EXPECT_THAT(errors("# nothing\n"), ElementsAre(StartsWith("exp.yaml:1:1: the file is empty")));
  EXPECT_THAT(errors("- a\n"), ElementsAre("exp.yaml:1:1: not a map; expected the keys of an experiment"));
  EXPECT_THAT(errors("a\n"), ElementsAre(StartsWith("exp.yaml:1:1: not a map")));
  EXPECT_THAT(errors(minimal + "---\n" + minimal),
              ElementsAre("exp.yaml:3:1: a second document begins; expected only one"));
  EXPECT_THAT(errors("? [a, b]\n: c\n"),
              ElementsAre("exp.yaml:1:3: a key is missing or no word; expected 'key: value'"));
  EXPECT_THAT(errors("data: !custom sheet\n"),
              ElementsAre("exp.yaml:1:7: the tag '!custom' is not supported"));
}

TEST_F(ConfigErrorLine, TabsInTheIndentation) {
  const std::string expected = ": a tab in the indentation; expected spaces";
  EXPECT_THAT(errors("data: sheet\nenergies:\n\trotation: {}\n"), ElementsAre("exp.yaml:3:1" + expected));
  EXPECT_THAT(errors("data: sheet\nenergies:\n  \trotation: {}\n"), ElementsAre("exp.yaml:3:3" + expected));
  EXPECT_THAT(errors("data: sheet\nenergies:\n  rotation:\n    weight: 1\n\t  robust: true\n"),
              ElementsAre("exp.yaml:5:1" + expected));
  EXPECT_THAT(errors(minimal + "title:\ta\t# b\n"), IsEmpty()) << "elsewhere they are as good as spaces";
}

TEST_F(ConfigErrorLine, NoSpaceAfterAColon) {
  const std::string expected = ": no space after the colon of 'data'; expected 'data: sheet'";
  EXPECT_THAT(errors("data:sheet\n"), ElementsAre("exp.yaml:1:1" + expected));
  EXPECT_THAT(errors("energies: {}\ndata:sheet\n"), ElementsAre("exp.yaml:2:1" + expected));
  EXPECT_THAT(errors("data:sheet\nenergies: {}\n"), ElementsAre("exp.yaml:1:1" + expected));
  EXPECT_THAT(errors("{energies: {}, data:sheet}\n"), ElementsAre("exp.yaml:1:16" + expected));
  EXPECT_THAT(errors(minimal + "stop:\n  limit:2\n  rounds: 3\n"),
              ElementsAre("exp.yaml:4:3: no space after the colon of 'limit'; expected 'limit: 2'"));
  EXPECT_THAT(errors(minimal, {"stop={rounds:3}"}),
              ElementsAre("--set stop: no space after the colon of 'rounds'; expected 'rounds: 3'"));
  EXPECT_THAT(errors(minimal + "title: http://a:b\n"), IsEmpty());
}

TEST_F(ConfigErrorLine, TextThatIsNotUtf8) {
  const std::string expected = ": a letter that is not UTF-8; expected a text in UTF-8";
  EXPECT_THAT(errors("title: é\ndata: é\xff\n"), ElementsAre("exp.yaml:2:8" + expected));
  for (const std::string bad :
       {"\x80", "\xc3", "\xc0\x80", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xe2\x82", "\xff\xfe"})
    EXPECT_THAT(errors("title: " + bad), ElementsAre("exp.yaml:1:8" + expected));
  for (const std::string good : {"\xc3\xa9", "\xe2\x82\xac", "\xf0\x9f\x98\x80"})
    EXPECT_THAT(errors(minimal + "title: " + good), IsEmpty());
  EXPECT_THAT(errors(minimal, {"title=\xff"}), ElementsAre("--set title" + expected));
  EXPECT_THAT(errors(minimal, {"\xff=1"}), ElementsAre(HasSubstr("not understood")));
}

TEST_F(ConfigErrorLine, UnknownKey) {
  EXPECT_THAT(errors(minimal + "solvr: {}\n"),
              ElementsAre("exp.yaml:3:1: unknown key 'solvr'; expected one of title, data, align, solver, "
                          "energies, stop, metrics, variants, compare, extends; did you mean 'solver'?"));
  EXPECT_THAT(
      errors("data: sheet\nenergies:\n  rotation:\n    wieght: 2\n"),
      ElementsAre("exp.yaml:4:5: unknown key 'wieght' in 'energies.rotation'; expected one of weight, "
                  "robust, type; did you mean 'weight'?"));
  EXPECT_THAT(errors(minimal + "solver: {linear: {type: cholesky, quick: 1}}\n"),
              ElementsAre("exp.yaml:3:35: unknown key 'quick' in 'solver.linear'; expected type"));
  EXPECT_THAT(errors(minimal + "stop: {type: 1}\n"),
              ElementsAre("exp.yaml:3:8: unknown key 'type' in 'stop'; expected one of limit, rounds, deep"));
}

TEST_F(ConfigErrorLine, ColumnsCountLettersNotBytes) {
  EXPECT_THAT(errors("{title: é, data: sheet, energies: {}, x: 1}\n"),
              ElementsAre(StartsWith("exp.yaml:1:39: unknown key 'x'")));
}

TEST_F(ConfigErrorLine, WrongTypeOfANumber) {
  const std::string expected = "expected an integer from 1 to 100";
  EXPECT_THAT(errors(minimal + "solver:\n  iterations: many\n"),
              ElementsAre("exp.yaml:4:15: 'solver.iterations' is 'many'; " + expected));
  EXPECT_THAT(errors(minimal + "solver: {iterations: 2.5}\n"),
              ElementsAre("exp.yaml:3:22: 'solver.iterations' is '2.5'; " + expected));
  EXPECT_THAT(errors(minimal + "solver: {iterations: '2'}\n"),
              ElementsAre("exp.yaml:3:22: 'solver.iterations' is the quoted text '2'; " + expected));
  EXPECT_THAT(errors(minimal + "solver: {iterations: [2]}\n"),
              ElementsAre("exp.yaml:3:10: 'solver.iterations' is a list; " + expected));
  EXPECT_THAT(errors(minimal + "solver: {iterations: {a: 2}}\n"),
              ElementsAre("exp.yaml:3:10: 'solver.iterations' is a section; " + expected));
  EXPECT_THAT(errors(minimal + "solver:\n  iterations:\n  tolerance: 0\n"),
              ElementsAre("exp.yaml:4:3: 'solver.iterations' is empty; " + expected));
  for (const std::string bad : {"0x10", "1e3", "3.0", "1_0", "+-1", "99999999999999999999", "-", "+"})
    EXPECT_THAT(errors(minimal + "solver: {iterations: " + bad + "}\n"),
                ElementsAre("exp.yaml:3:22: 'solver.iterations' is '" + bad + "'; " + expected));
}

TEST_F(ConfigErrorLine, RealsAreFinite) {
  for (const std::string bad :
       {"nan", ".nan", "inf", "-.inf", "-inf", "1e999", "infinity", "1.5x", "0x1p3", "."})
    EXPECT_THAT(
        errors("data: {type: sheet, amplitude: " + bad + "}\nenergies: {}\n"),
        ElementsAre("exp.yaml:1:32: 'data.amplitude' is '" + bad + "'; expected a finite number (mm)"));
}

TEST_F(ConfigErrorLine, OutOfRange) {
  EXPECT_THAT(
      errors(minimal + "solver: {iterations: 101, tolerance: -0.5}\n"),
      ElementsAre("exp.yaml:3:22: 'solver.iterations' is '101'; expected an integer from 1 to 100",
                  "exp.yaml:3:38: 'solver.tolerance' is '-0.5'; expected a finite number from 0 to 1 (mm)"));
  EXPECT_THAT(errors(minimal + "stop: {limit: 0, rounds: 0}\n"),
              ElementsAre("exp.yaml:3:15: 'stop.limit' is '0'; expected a finite number above 0 (mm)",
                          "exp.yaml:3:26: 'stop.rounds' is '0'; expected an integer at least 1"));
  EXPECT_THAT(
      errors(minimal + "compare: {pixels: 36}\n"),
      ElementsAre(
          "exp.yaml:3:19: 'compare.pixels' is '36'; expected an integer from 16 to 64, a multiple of 8"));
}

TEST_F(ConfigErrorLine, BooleansAreTrueOrFalse) {
  const auto line = [&](const std::string& value) {
    return errors(minimal + "stop: {deep: {early: " + value + "}}\n");
  };
  const std::string begin = "exp.yaml:3:22: 'stop.deep.early' is ";
  EXPECT_THAT(line("yes"), ElementsAre(begin + "'yes'; expected true or false; did you mean 'true'?"));
  EXPECT_THAT(line("True"), ElementsAre(begin + "'True'; expected true or false; did you mean 'true'?"));
  EXPECT_THAT(line("off"), ElementsAre(begin + "'off'; expected true or false; did you mean 'false'?"));
  EXPECT_THAT(line("maybe"), ElementsAre(begin + "'maybe'; expected true or false"));
  EXPECT_THAT(line("'true'"),
              ElementsAre(StartsWith(begin + "the quoted text 'true'; expected true or false")));
}

TEST_F(ConfigErrorLine, ChoiceAndTextAndWords) {
  EXPECT_THAT(errors("data: sheet\nenergies: {rotation: {robust: hubr}}\n"),
              ElementsAre("exp.yaml:2:31: 'energies.rotation.robust' is 'hubr'; expected one of none, huber, "
                          "tukey; did you mean 'huber'?"));
  EXPECT_THAT(errors(minimal + "title: [a]\n"),
              ElementsAre("exp.yaml:3:1: 'title' is a list; expected a text"));
  EXPECT_THAT(errors(minimal + "metrics: {a: b}\n"),
              ElementsAre("exp.yaml:3:1: 'metrics' is a section; expected a list of texts"));
  EXPECT_THAT(errors(minimal + "metrics: [a, [b], c, {d: e}]\n"),
              ElementsAre("exp.yaml:3:14: an item of 'metrics' is a list; expected a text",
                          "exp.yaml:3:22: an item of 'metrics' is a section; expected a text"));
}

TEST_F(ConfigErrorLine, MissingRequired) {
  EXPECT_THAT(errors("title: x\n"),
              ElementsAre("exp.yaml:1:1: missing key 'data'; expected a component of kind data (pair, sheet)",
                          "exp.yaml:1:1: missing key 'energies'; expected a section of labels, each for a "
                          "component of kind energy "
                          "(rotation, constraint)"));
  EXPECT_THAT(
      errors("data:\n  type: pair\nenergies:\n  constraint:\n"),
      ElementsAre("exp.yaml:1:1: missing key 'data.depth'; expected the path of a file",
                  "exp.yaml:4:3: missing key 'energies.constraint.weight'; expected a finite number at "
                  "least 0"));
  EXPECT_THAT(
      errors(minimal + "align: {ratio: 0.5}\n"),
      ElementsAre(
          "exp.yaml:3:1: missing key 'align.type'; expected a component of kind alignment (features)"));
}

TEST_F(ConfigErrorLine, DuplicateKey) {
  EXPECT_THAT(
      errors(minimal + "solver:\n  iterations: 3\n  iterations: 4\ndata: sheet\n"),
      ElementsAre("exp.yaml:5:3: duplicate key 'iterations'; expected it once, it stands at 4:3 already",
                  "exp.yaml:6:1: duplicate key 'data'; expected it once, it stands at 1:1 already"));
}

TEST_F(ConfigErrorLine, UnknownComponent) {
  EXPECT_THAT(
      errors(minimal + "solver: ceres_ml\n"),
      ElementsAre("exp.yaml:3:9: unknown solver 'ceres_ml' for 'solver'; expected one of gauss_newton, "
                  "ceres_lm; did you mean 'ceres_lm'?"));
  EXPECT_THAT(errors(minimal + "solver:\n  type: magic\n  threads: 2\n"),
              ElementsAre("exp.yaml:4:9: unknown solver 'magic' for 'solver'; expected one of gauss_newton, "
                          "ceres_lm"));
  EXPECT_THAT(errors("data: sheet\nenergies:\n  rotatoin: {weight: 1}\n"),
              ElementsAre("exp.yaml:3:3: unknown energy 'rotatoin' for 'energies.rotatoin'; expected one of "
                          "rotation, constraint; did you mean 'rotation'?"));
  EXPECT_THAT(errors(minimal + "solver: {type: [a]}\n"),
              ElementsAre("exp.yaml:3:10: 'solver.type' is a list; expected a component of kind solver "
                          "(gauss_newton, ceres_lm)"));
}

TEST_F(ConfigErrorLine, SectionsOfTheWrongShape) {
  EXPECT_THAT(
      errors(minimal + "solver:\nstop:\nvariants:\n"),
      ElementsAre(
          "exp.yaml:3:1: 'solver' is empty; expected a component of kind solver (gauss_newton, ceres_lm)",
          "exp.yaml:4:1: 'stop' is empty; expected a section with keys of limit, rounds, deep",
          "exp.yaml:5:1: 'variants' is empty; expected a section with a partial experiment under "
          "each name"));
  EXPECT_THAT(
      errors("data: [sheet]\nenergies:\nstop: 3\n"),
      ElementsAre("exp.yaml:1:1: 'data' is a list; expected a component of kind data (pair, sheet)",
                  "exp.yaml:2:1: 'energies' is empty; expected a section of labels, each for a component of "
                  "kind energy "
                  "(rotation, constraint)",
                  "exp.yaml:3:7: 'stop' is '3'; expected a section with keys of limit, rounds, deep"));
  EXPECT_THAT(
      errors("data: sheet\nenergies: {rotation: [1]}\nvariants: {a: 1}\n"),
      ElementsAre("exp.yaml:2:22: 'energies.rotation' is a list; expected a component of kind energy "
                  "(rotation, constraint)",
                  "exp.yaml:3:12: 'variants.a' is '1'; expected the keys of an experiment that differ"));
}

TEST_F(ConfigErrorLine, AFileThatIsNotThereTellsWhereItWasLookedFor) {
  data_folders_ = {folder_ / "d1", folder_ / "d2"};
  EXPECT_THAT(
      errors("data:\n  type: pair\n  depth: a.png\n  color: /nowhere/b.png\nenergies: {}\n"),
      ElementsAre("exp.yaml:3:10: 'data.depth' names the file 'a.png', which does not exist; looked for "
                  "a.png, d1/a.png, d2/a.png",
                  "exp.yaml:4:10: 'data.color' names the file '/nowhere/b.png', which does not exist; "
                  "looked for /nowhere/b.png"));
  EXPECT_THAT(errors("data: {type: pair, depth: ''}\nenergies: {}\n"),
              ElementsAre("exp.yaml:1:27: 'data.depth' is the quoted text ''; expected the path of a file"));
}

TEST_F(ConfigErrorLine, EveryErrorIsToldInTheOrderOfTheFile) {
  EXPECT_THAT(
      errors("titel: x\ndata: sheep\nsolver: {iterations: 0, foo: 1}\nenergies:\n  rotation: {weight: -1}\n"
             "stop: {deep: {early: on}}\n"),
      ElementsAre(StartsWith("exp.yaml:1:1: unknown key 'titel'"),
                  StartsWith("exp.yaml:2:7: unknown data 'sheep'"),
                  StartsWith("exp.yaml:3:22: 'solver.iterations' is '0'"),
                  StartsWith("exp.yaml:3:25: unknown key 'foo' in 'solver'"),
                  StartsWith("exp.yaml:5:22: 'energies.rotation.weight' is '-1'"),
                  StartsWith("exp.yaml:6:22: 'stop.deep.early' is 'on'")));
}

TEST_F(ConfigErrorLine, AnEndlessListOfErrorsIsCut) {
  std::string text = minimal;
  for (int i = 0; i < 300; ++i) text += "key" + std::to_string(i) + ": 1\n";
  const auto lines = errors(text);
  ASSERT_EQ(lines.size(), 201u);
  EXPECT_EQ(lines.back(), "... and 100 more errors");
}

TEST_F(ConfigErrorLine, WhatIsShownStaysOnOneShortLine) {
  EXPECT_THAT(errors(minimal + "solver: {iterations: \"a\\nb\\x7f\"}\n"),
              ElementsAre(HasSubstr("the quoted text 'a\\x0ab\\x7f'; expected")));
  std::string umlauts = "x";
  for (int i = 0; i < 60; ++i) umlauts += "ä";
  EXPECT_THAT(errors(minimal + "solver: {iterations: " + umlauts + "}\n"),
              ElementsAre(HasSubstr("is '" + umlauts.substr(0, 79) + "...'; expected")));
}

TEST_F(ConfigErrorLine, FileLevelProblems) {
  const auto problem = [&](const std::filesystem::path& file) -> std::string {
    try {
      load_experiment({file, {}, {}}, table_, registry_);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(problem(folder_ / "none.yaml"), (folder_ / "none.yaml").string() + ": the file does not exist");
  EXPECT_EQ(problem(folder_), folder_.string() + ": is a folder; expected a YAML file");
  EXPECT_EQ(problem(folder_ / std::string(5000, 'x')),
            (folder_ / std::string(5000, 'x')).string() + ": the file does not exist");
  const auto big = write("big.yaml", std::string(2 << 20, '#'));
  EXPECT_EQ(problem(big), big.string() + ": more than 1048576 bytes; expected an experiment");
  // It opens like any file, for root too, and then every read of it fails.
  EXPECT_EQ(problem("/proc/self/mem"), "/proc/self/mem: the file cannot be read");
}

TEST_F(ConfigErrorLine, ErrorsNameTheBaseTheyStandIn) {
  write("root.yaml", "data: sheet\nenergies:\n  rotation: {weight: -1}\nsolver: {foo: 1, foo: 2}\n");
  write("methods/middle.yaml", "extends: ../root.yaml\nstop:\n  rounds: none\n");
  EXPECT_THAT(errors("extends: methods/middle.yaml\ntitle: []\n"),
              ElementsAre(StartsWith("exp.yaml:2:1: 'title' is a list"),
                          StartsWith("methods/middle.yaml:3:11: 'stop.rounds' is 'none'"),
                          StartsWith("root.yaml:3:22: 'energies.rotation.weight' is '-1'"),
                          StartsWith("root.yaml:4:10: unknown key 'foo' in 'solver'"),
                          StartsWith("root.yaml:4:18: duplicate key 'foo'")));
}

TEST_F(ConfigErrorLine, WhatIsMissingIsMissedInTheFileAtTheTop) {
  write("base.yaml", "\nenergies:\n  constraint: {plane: true}\n");
  EXPECT_THAT(errors("extends: base.yaml\n"),
              ElementsAre(StartsWith("exp.yaml:1:1: missing key 'data'"),
                          StartsWith("base.yaml:3:3: missing key 'energies.constraint.weight'")));
}

TEST_F(ConfigErrorLine, AnOverlayMendsWhatItCovers) {
  write("base.yaml", minimal + "stop: {rounds: none}\nsolver: {type: magic}\n");
  EXPECT_THAT(errors("extends: base.yaml\nstop: {rounds: 3}\nsolver: ceres_lm\n"), IsEmpty());
}

TEST_F(ConfigErrorLine, ExtendsThatLeadsNowhere) {
  EXPECT_THAT(errors("title: x\nextends: none.yaml\n"),
              ElementsAre("exp.yaml:2:10: cannot extend 'none.yaml': the file does not exist"));
  EXPECT_THAT(errors("extends: .\n"), ElementsAre(StartsWith("exp.yaml:1:10: cannot extend ")));
  EXPECT_THAT(errors("extends:\n"),
              ElementsAre("exp.yaml:1:1: 'extends' names no file; expected the path of a YAML file"));
  EXPECT_THAT(errors("extends: [a]\n"), ElementsAre(StartsWith("exp.yaml:1:1: 'extends' names no file")));
  write("broken.yaml", "a: [\n");
  EXPECT_THAT(errors("extends: broken.yaml\n"), ElementsAre(StartsWith("broken.yaml:2:1: not valid YAML")));
}

TEST_F(ConfigErrorLine, ExtendsDoesNotLookInTheDataFolders) {
  data_folders_ = {folder_ / "d"};
  write("d/base.yaml", minimal);
  EXPECT_EQ(errors("extends: base.yaml\n").size(), 1u);
}

TEST_F(ConfigErrorLine, ExtendsInACircle) {
  write("b.yaml", "extends: sub/c.yaml\n");
  write("sub/c.yaml", "\nextends: ../b.yaml\n");
  EXPECT_THAT(
      errors("extends: b.yaml\n"),
      ElementsAre("sub/c.yaml:2:10: 'extends' goes in a circle: exp.yaml -> b.yaml -> sub/c.yaml -> b.yaml"));
  EXPECT_THAT(errors("extends: ./exp.yaml\n"),
              ElementsAre("exp.yaml:1:10: 'extends' goes in a circle: exp.yaml -> exp.yaml"));
}

TEST_F(ConfigErrorLine, SetsAreNamedAsTheyWereGiven) {
  EXPECT_THAT(
      errors(minimal, {"solver.iterations=0", "solvr.x=1", "energies.rotation={weight: 1, wight: 2}",
                       "stop.rounds=", "title=[", "solver.linear.type=lu"}),
      ElementsAre(StartsWith("--set solver.iterations: 'solver.iterations' is '0'; expected an integer"),
                  StartsWith("--set solvr.x: unknown key 'solvr'; expected one of title"),
                  StartsWith("--set energies.rotation: unknown key 'wight' in 'energies.rotation'"),
                  "--set stop.rounds: 'stop.rounds' is empty; expected an integer at least 1",
                  StartsWith("--set title: not valid YAML"),
                  StartsWith("--set solver.linear.type: unknown linear_solver 'lu' for 'solver.linear'")));
}

TEST_F(ConfigErrorLine, SetsThatSayNothing) {
  EXPECT_THAT(errors(minimal, {"solver"}),
              ElementsAre("--set solver: not understood; expected KEY=VALUE with a key like a.b.c"));
  EXPECT_THAT(errors(minimal, {"a..b=1"}), ElementsAre(StartsWith("--set a..b: not understood")));
  EXPECT_THAT(errors(minimal, {"=1"}), ElementsAre(StartsWith("--set : not understood")));
  EXPECT_THAT(errors(minimal, {""}), ElementsAre(StartsWith("--set : not understood")));
  EXPECT_THAT(errors(minimal, {"extends=x.yaml"}),
              ElementsAre("--set extends: 'extends' cannot be set; expected it in an experiment file"));
}

TEST_F(ConfigErrorLine, ASetDoesNotMoveTheErrorsOfTheFile) {
  EXPECT_THAT(errors("data: {type: pair}\nenergies: {}\n", {"data.color=/", "stop.rounds=2"}),
              ElementsAre("exp.yaml:1:1: missing key 'data.depth'; expected the path of a file"));
}

TEST_F(ConfigErrorLine, ErrorsOfTheExperimentAreNotRepeatedByItsOverrides) {
  EXPECT_THAT(errors(R"(solver: {iterations: 0, foo: 1}
energies: {constraint: {}}
oops: 1
variants:
  a: {title: a}
  b: {solver: {tolerance: 2}, energies: {constraint: {plane: false}}}
)"),
              ElementsAre(StartsWith("exp.yaml:1:1: missing key 'data'"),
                          StartsWith("exp.yaml:1:22: 'solver.iterations' is '0'"),
                          StartsWith("exp.yaml:1:25: unknown key 'foo' in 'solver'"),
                          StartsWith("exp.yaml:2:12: missing key 'energies.constraint.weight'"),
                          StartsWith("exp.yaml:3:1: unknown key 'oops'"),
                          StartsWith("exp.yaml:6:27: 'solver.tolerance' is '2'")));
}

TEST_F(ConfigErrorLine, OverridesMayNotHoldOverrides) {
  const std::string expected = "; expected one of title, data, align, solver, energies, stop, metrics";
  EXPECT_THAT(
      errors(minimal + "variants:\n  a: {variants: {}}\n  b: {compare: {repeat: 2}}\n  c: {extends: x.yaml}\n"
                       "compare: {with: {d: {variants: {}}}}\n"),
      ElementsAre("exp.yaml:4:7: unknown key 'variants'" + expected,
                  "exp.yaml:5:7: unknown key 'compare'" + expected,
                  "exp.yaml:6:16: cannot extend 'x.yaml': the file does not exist",
                  "exp.yaml:7:22: unknown key 'variants'" + expected));
}

TEST_F(ConfigErrorLine, AnOverrideIsCheckedCompletely) {
  EXPECT_THAT(errors(minimal + "variants:\n  a:\n    data: pair\n    energies: {constraint: , roation: }\n"),
              ElementsAre("exp.yaml:5:5: missing key 'data.depth'; expected the path of a file",
                          StartsWith("exp.yaml:6:16: missing key 'energies.constraint.weight'"),
                          StartsWith("exp.yaml:6:30: unknown energy 'roation'")));
}

}  // namespace
}  // namespace pliant::test
