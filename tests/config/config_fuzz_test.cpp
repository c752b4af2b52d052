#include <random>
#include <sstream>

#include <gmock/gmock.h>

#include "framework/config/config.h"
#include "framework/core/error.h"
#include "tests/config/toy_experiment.h"

namespace pliant::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string everything = R"(# An experiment
title: "quoted \x41 text"
data: &data
  type: sheet
  amplitude: -1.5e1
align: {type: features, ratio: 0.5}
solver:
  type: ceres_lm
  threads: 3
  linear: {type: cg, iterations: 7}
energies:
  rotation: ~
  near: {type: constraint, weight: 3, plane: false}
stop: {limit: 1.5, deep: {early: true}}
metrics: [epe, 'nearest']
variants:
  a: {data: *data}
  b: {solver: gauss_newton}
compare:
  with:
    ? c
    : title: >-
        folded
        text
)";

/// The text with one to three of its letters changed, added or taken away.
std::string mutated(std::string text, std::mt19937& random) {
  // The letters that mean something to YAML, and some that do not.
  const std::string letters = ":-{}[],&*#?|>!%@`'\"~ \n\t.019eaZ\\\x01\x7f\xc3\xff";
  const auto edits = 1 + random() % 3;
  for (unsigned edit = 0; edit < edits; ++edit) {
    const auto at = random() % text.size();
    const char letter = letters[random() % letters.size()];
    switch (random() % 3) {
      case 0:
        text[at] = letter;
        break;
      case 1:
        text.insert(at, 1, letter);
        break;
      default:
        text.erase(at, 1 + random() % 5);
    }
  }
  return text;
}

class ConfigFuzz : public ToyExperiment {
 protected:
  /// Loads the text; whatever it is, it may only load or be refused with a proper message.
  void feed(const std::string& text) {
    try {
      const Experiment experiment = load(text);
      const Experiment again =
          load_experiment({write("resolved.yaml", experiment.to_yaml()), {}, {}}, table_, registry_);
      EXPECT_EQ(again.to_json(), experiment.to_json()) << text;
      ++loaded_;
    } catch (const ConfigError& error) {
      EXPECT_THAT(error.what(), HasSubstr("exp.yaml")) << text;
      ++refused_;
    }
  }

  int loaded_ = 0;
  int refused_ = 0;
};

TEST_F(ConfigFuzz, EveryTruncation) {
  for (std::size_t length = 0; length <= everything.size(); ++length) feed(everything.substr(0, length));
  EXPECT_THAT(errors(everything), IsEmpty());
  EXPECT_GT(refused_, 0);
}

TEST_F(ConfigFuzz, MutatedLetters) {
  const std::string text = load(minimal + "metrics: [a, b]\nvariants: {v: {stop: {rounds: 2}}}\n").to_yaml();
  std::mt19937 random(7);
  for (int round = 0; round < 3000; ++round) feed(mutated(round % 2 == 0 ? everything : text, random));
  EXPECT_GT(loaded_, 100);
  EXPECT_GT(refused_, 100);
}

TEST_F(ConfigFuzz, MutatedSweeps) {
  table_ = swept_toy_table();
  const std::string text = minimal +
                           "sweep: {stop.rounds: [1, 2], metrics: [[a, b], c], solver: [ceres_lm]}\n"
                           "variants: {v: {title: x}, w: }\n";
  std::mt19937 random(13);
  for (int round = 0; round < 500; ++round) feed(mutated(text, random));
  EXPECT_GT(loaded_, 10);
  EXPECT_GT(refused_, 100);
}

TEST_F(ConfigFuzz, ShuffledLines) {
  std::vector<std::string> lines;
  std::istringstream stream(everything);
  for (std::string line; std::getline(stream, line);) lines.push_back(line + "\n");
  std::mt19937 random(11);
  for (int round = 0; round < 500; ++round) {
    std::string text;
    for (std::size_t i = 0; i < lines.size(); ++i) text += lines[random() % lines.size()];
    feed(text);
  }
  EXPECT_GT(refused_, 100);
}

TEST_F(ConfigFuzz, DeepNesting) {
  for (const std::string opening : {"[", "{a: ", "- ", "? ", "[{a: ", "!", "&a ", "\"", "a: &a\n "}) {
    std::string text = "data: ";
    for (int i = 0; i < 20000; ++i) text += opening;
    feed(text);
    feed(text.substr(6));
  }
  EXPECT_EQ(loaded_, 0);
  EXPECT_THAT(errors("data: " + std::string(65, '[') + std::string(65, ']')),
              ElementsAre("exp.yaml:1:70: nested more than 64 levels deep"));
}

TEST_F(ConfigFuzz, AliasBombs) {
  std::string bomb = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 30; ++i) {
    const std::string last = "*a" + std::to_string(i - 1);
    bomb += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [";
    for (int j = 0; j < 10; ++j) bomb += (j > 0 ? ", " : "") + last;
    bomb += "]\n";
  }
  EXPECT_THAT(errors(bomb), ElementsAre(HasSubstr("more than 20000 values; expected an experiment")));
  EXPECT_THAT(errors("a: &a [*a]\n"), ElementsAre("exp.yaml:1:8: an alias stands inside its own anchor"));
}

TEST_F(ConfigFuzz, OverridesTimesValues) {
  std::string text = "data: sheet\nenergies:\n";
  for (int i = 0; i < 1500; ++i) text += "  e" + std::to_string(i) + ": rotation\n";
  text += "variants:\n";
  for (int i = 0; i < 1500; ++i) text += "  v" + std::to_string(i) + ":\n";
  EXPECT_THAT(errors(text),
              ElementsAre("exp.yaml:1503:1: 'variants' has 1500 entries; expected fewer for an experiment of "
                          "this size"));
}

TEST_F(ConfigFuzz, LongKeysAndValues) {
  EXPECT_THAT(errors("? " + std::string(5000, 'k') + "\n: 1\n"),
              ElementsAre("exp.yaml:1:3: a key of more than 200 letters"));
  feed(minimal + "title: " + std::string(100000, 't') + "\n");
  EXPECT_EQ(loaded_, 1);
}

}  // namespace
}  // namespace pliant::test
