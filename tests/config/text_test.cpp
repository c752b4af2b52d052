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

TEST_F(ConfigFromText, TextsThatAreNoExperiment) {
  EXPECT_EQ(error(""), "live:1:1: the text is empty; expected the keys of an experiment");
  EXPECT_EQ(error("- a\n"), "live:1:1: not a map; expected the keys of an experiment");
  EXPECT_EQ(error(std::string(2 << 20, '#')), "live: more than 1048576 bytes; expected an experiment");
  EXPECT_THAT(error("a: {\n"), HasSubstr("live:2:1: not valid YAML"));
}

}  // namespace
}  // namespace pliant::test
