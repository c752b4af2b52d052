#include <gmock/gmock.h>

#include "framework/core/error.h"
#include "tests/config/toy_experiment.h"

namespace pliant::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Experiments from text, whose relative files lie in the folder of the test.
class ConfigFromText : public ToyExperiment {
 protected:
  Experiment load_text(const std::string& text, const std::vector<std::string>& sets = {}) {
    return load_experiment({ConfigText{text, "live", folder_}, sets, {}}, table_, registry_);
  }

  std::string error(const std::string& text, const std::vector<std::string>& sets = {}) {
    try {
      load_text(text, sets);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  }
};

TEST_F(ConfigFromText, LoadsAsTheSameTextInAFileDoes) {
  write("images/a.png", "");
  const std::string text =
      "data: {type: pair, depth: images/a.png}\nenergies: {rotation: }\nvariants: {a: }\n";
  EXPECT_EQ(load_text(text, {"title=b"}).to_yaml(), load(text, {"title=b"}).to_yaml());
}

TEST_F(ConfigFromText, ExtendsAndFilesStartAtItsFolder) {
  const auto base = write("methods/base.yaml", minimal);
  const auto image = write("a.png", "");
  const Experiment experiment = load_text("extends: methods/base.yaml\ndata: {type: pair, depth: a.png}\n");
  EXPECT_EQ(experiment.values.section("data").text("depth"), image.string());
  EXPECT_THAT(experiment.files, ElementsAre(base, image));
}

TEST_F(ConfigFromText, ErrorsNameTheTextAndTheFilesBeneathIt) {
  write("base.yaml", minimal + "solver: {iterations: 0}\n");
  EXPECT_EQ(error("extends: base.yaml\nstop:\n  rounds: 0\n", {"title=[]"}),
            "live:3:11: 'stop.rounds' is '0'; expected an integer at least 1\n" +
                (folder_ / "base.yaml").string() +
                ":3:22: 'solver.iterations' is '0'; expected an integer from 1 to 100\n"
                "--set title: 'title' is a list; expected a text");
  EXPECT_THAT(error("extends: none.yaml\n"),
              HasSubstr("live:1:10: cannot extend '" + (folder_ / "none.yaml").string() +
                        "': the file does not exist"));
}

TEST_F(ConfigFromText, ACircleBeneathItIsFound) {
  write("a.yaml", "extends: a.yaml\n");
  const std::string file = (folder_ / "a.yaml").string();
  EXPECT_EQ(error("extends: a.yaml\n"),
            file + ":1:10: 'extends' goes in a circle: live -> " + file + " -> " + file);
}

/// Experiments that a program carries with it.
class ConfigOverBaseTexts : public ConfigFromText {
 protected:
  Experiment load_over(const std::map<std::string, std::string>& bases, const std::string& text) {
    ConfigSource source{ConfigText{text, "live", folder_}, {}, {}};
    source.base_texts = bases;
    return load_experiment(source, table_, registry_);
  }

  std::string error_over(const std::map<std::string, std::string>& bases, const std::string& text) {
    try {
      load_over(bases, text);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  }
};

TEST_F(ConfigOverBaseTexts, ExtendingThemIsExtendingFiles) {
  const std::string upper = "extends: lower.yaml\ntitle: upper\n";
  write("files/lower.yaml", minimal);
  write("files/upper.yaml", upper);
  const Experiment experiment = load_over({{"carried/upper.yaml", upper}, {"carried/lower.yaml", minimal}},
                                          "extends: carried/upper.yaml\n");
  EXPECT_EQ(experiment.to_yaml(), load_text("extends: files/upper.yaml\n").to_yaml());
  EXPECT_THAT(experiment.files, testing::IsEmpty());
}

TEST_F(ConfigOverBaseTexts, ComeBeforeFilesAndOnlyUnderTheirOwnNames) {
  write("carried.yaml", minimal + "title: file\n");
  EXPECT_EQ(load_over({{"carried.yaml", minimal + "title: text\n"}}, "extends: carried.yaml\n")
                .values.text("title"),
            "text");
  EXPECT_EQ(load_over({{"a/carried.yaml", minimal + "title: text\n"}}, "extends: carried.yaml\n")
                .values.text("title"),
            "file");
}

TEST_F(ConfigOverBaseTexts, ErrorsNameThem) {
  EXPECT_EQ(error_over({{"a/b.yaml", minimal + "solver: {iterations: 0}\n"}}, "extends: a/b.yaml\n"),
            "a/b.yaml:3:22: 'solver.iterations' is '0'; expected an integer from 1 to 100");
  EXPECT_EQ(error_over({{"a/b.yaml", "extends: c.yaml\n"}, {"a/c.yaml", "extends: b.yaml\n"}},
                       "extends: a/b.yaml\n"),
            "a/c.yaml:1:10: 'extends' goes in a circle: live -> a/b.yaml -> a/c.yaml -> a/b.yaml");
}

TEST_F(ConfigFromText, TextsThatAreNoExperiment) {
  EXPECT_EQ(error(""), "live:1:1: the text is empty; expected the keys of an experiment");
  EXPECT_EQ(error("- a\n"), "live:1:1: not a map; expected the keys of an experiment");
  EXPECT_EQ(error(std::string(2 << 20, '#')), "live: more than 1048576 bytes; expected an experiment");
  EXPECT_THAT(error("a: {\n"), HasSubstr("live:2:1: not valid YAML"));
}

}  // namespace
}  // namespace pliant::test
