// Lists of numbers, how many entries a map must have, and where a section stands.
#include <gmock/gmock.h>

#include "framework/config/schema.h"
#include "framework/core/error.h"
#include "tests/config/toy_experiment.h"

namespace pliant::test {
namespace {

using testing::ElementsAre;

class ListParameters : public ToyExperiment {
 protected:
  ListParameters() {
    table_ = ParameterTable{reals("at", 3).unit("mm").at_least(-5), reals("move", 2, std::vector{0.5, 1.0}),
                            components("energies", "energy").optional().at_least(1)};
  }
};

TEST_F(ListParameters, NumbersAreReadAndHaveDefaults) {
  const Experiment experiment = load("at: [1, -2.5, 3e2]\n");
  EXPECT_THAT(experiment.values.reals("at"), ElementsAre(1, -2.5, 300));
  EXPECT_THAT(experiment.values.reals("move"), ElementsAre(0.5, 1));
  EXPECT_THAT(load("at: [0, 0, 0]\n", {"move=[3, 4]"}).values.reals("move"), ElementsAre(3, 4));
  EXPECT_THAT(load(experiment.to_yaml()).values.reals("at"), ElementsAre(1, -2.5, 300));
}

TEST_F(ListParameters, WhatIsNoSuchListIsAnError) {
  const std::string wanted = "expected a list of 3 finite numbers at least -5 (mm)";
  EXPECT_THAT(errors("at: 4\n"), ElementsAre("exp.yaml:1:5: 'at' is '4'; " + wanted));
  EXPECT_THAT(errors("at: [1, 2]\n"), ElementsAre("exp.yaml:1:5: 'at' has 2 items; " + wanted));
  EXPECT_THAT(errors("at: [1, x, -6]\n"), ElementsAre("exp.yaml:1:9: an item of 'at' is 'x'; " + wanted,
                                                      "exp.yaml:1:12: an item of 'at' is '-6'; " + wanted));
  EXPECT_THAT(errors("at: [1, [2], .inf]\n"),
              ElementsAre("exp.yaml:1:9: an item of 'at' is a list; " + wanted,
                          "exp.yaml:1:14: an item of 'at' is '.inf'; " + wanted));
}

TEST_F(ListParameters, AMapMayNeedAnEntry) {
  EXPECT_TRUE(load("at: [1, 2, 3]\n").values.sections("energies").empty()) << "it is optional";
  EXPECT_THAT(errors("at: [1, 2, 3]\nenergies: {}\n"),
              ElementsAre("exp.yaml:2:1: 'energies' has 0 entries; expected at least 1"));
}

TEST_F(ListParameters, SectionsKnowWhereTheyStand) {
  const Experiment experiment = load("at: [1, 2, 3]\nenergies:\n  rotation: {}\n");
  const std::string place = experiment.values.sections("energies").at(0).second.place();
  EXPECT_THAT(place, testing::EndsWith("exp.yaml:3:3"));
}

TEST_F(ListParameters, TheSchemaSaysAsMuch) {
  const auto schema = json_schema(table_, registry_);
  const auto& at = schema["properties"]["at"];
  EXPECT_EQ(at["type"], "array");
  EXPECT_EQ(at["minItems"], 3);
  EXPECT_EQ(at["maxItems"], 3);
  EXPECT_EQ(at["items"]["minimum"], -5);
  EXPECT_EQ(schema["properties"]["move"]["default"], (std::vector{0.5, 1.0}));
  EXPECT_EQ(schema["properties"]["energies"]["minProperties"], 1);
}

}  // namespace
}  // namespace pliant::test
