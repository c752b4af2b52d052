// A map from names to sections of one fixed table.
#include <gmock/gmock.h>

#include "framework/config/schema.h"
#include "tests/config/toy_experiment.h"

namespace pliant::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class GroupsParameter : public ToyExperiment {
 protected:
  GroupsParameter() {
    table_ = ParameterTable{
        groups("keys", {real("at").unit("s").at_least(0), words("pose").optional(),
                        group("camera", {real("turn", 0), component("solver", "solver").optional()})}),
        groups("marks", {integer("count", 3)}).optional(), overrides("variants")};
  }

  static std::vector<std::string> names(const Parameters& values) {
    std::vector<std::string> names;
    for (const auto& [name, section] : values.sections("keys")) names.push_back(name);
    return names;
  }
};

TEST_F(GroupsParameter, EntriesAreReadInOrderWithTheirDefaults) {
  const Experiment experiment = load(
      "keys:\n  open: {at: 0.5, pose: [a=1, b=2]}\n  close: {at: 2, camera: {turn: 4}}\n"
      "marks:\n  x:\n  y: {count: 1}\n");
  EXPECT_THAT(names(experiment.values), ElementsAre("open", "close"));
  const auto& keys = experiment.values.sections("keys");
  EXPECT_EQ(keys[0].second.real("at"), 0.5);
  EXPECT_THAT(keys[0].second.words("pose"), ElementsAre("a=1", "b=2"));
  EXPECT_EQ(keys[0].second.section("camera").real("turn"), 0);
  EXPECT_EQ(keys[1].second.section("camera").real("turn"), 4);
  EXPECT_THAT(keys[1].second.place(), testing::EndsWith("exp.yaml:3:3"));
  EXPECT_EQ(experiment.values.sections("marks")[0].second.integer("count"), 3) << "nothing given";
  EXPECT_EQ(experiment.values.sections("marks")[1].second.integer("count"), 1);
  EXPECT_EQ(load(experiment.to_yaml()).tree, experiment.tree);
}

TEST_F(GroupsParameter, OptionalOnesAreEmptyWhereTheFileIsSilent) {
  const Experiment experiment = load("keys: {a: {at: 1}}\n");
  EXPECT_TRUE(experiment.values.sections("marks").empty());
  EXPECT_EQ(load(experiment.to_yaml()).tree, experiment.tree);
}

TEST_F(GroupsParameter, AreLaidOverEntryByEntryAndKeyByKey) {
  write("base.yaml",
        "keys:\n  a: {at: 1, camera: {turn: 3, solver: {type: ceres_lm, threads: 4}}}\n  b: {at: 2}\n");
  const Experiment experiment =
      load("extends: base.yaml\nkeys:\n  a: {camera: {solver: {threads: 5}}}\n  b:\n  c: {at: 4}\n",
           {"keys.c.pose=[x=1]", "keys.b.camera.turn=7"});
  EXPECT_THAT(names(experiment.values), ElementsAre("a", "b", "c"));
  const auto& keys = experiment.values.sections("keys");
  EXPECT_EQ(keys[0].second.real("at"), 1);
  EXPECT_EQ(keys[0].second.section("camera").real("turn"), 3);
  EXPECT_EQ(keys[0].second.section("camera").section("solver").component(), "ceres_lm");
  EXPECT_EQ(keys[0].second.section("camera").section("solver").integer("threads"), 5);
  EXPECT_EQ(keys[1].second.real("at"), 2) << "an empty entry changes nothing";
  EXPECT_EQ(keys[1].second.section("camera").real("turn"), 7);
  EXPECT_THAT(keys[2].second.words("pose"), ElementsAre("x=1"));
}

TEST_F(GroupsParameter, OverridesChangeThem) {
  const Experiment experiment =
      load("keys: {a: {at: 1}, b: {at: 2}}\nvariants: {late: {keys: {b: {at: 9}}}}\n");
  const auto& late = experiment.values.sections("variants").at(0).second.sections("keys");
  EXPECT_EQ(late[0].second.real("at"), 1);
  EXPECT_EQ(late[1].second.real("at"), 9);
  EXPECT_EQ(load(experiment.to_yaml()).tree, experiment.tree);
}

TEST_F(GroupsParameter, WhatIsNoneIsAnError) {
  EXPECT_THAT(
      errors("marks: {}\n"),
      ElementsAre("exp.yaml:1:1: missing key 'keys'; expected a map from names, each to a section with "
                  "keys of at, pose, camera"));
  EXPECT_THAT(errors("keys: [1, 2]\n"),
              ElementsAre("exp.yaml:1:1: 'keys' is a list; expected a map from names, each to a section with "
                          "keys of at, pose, camera"));
  EXPECT_THAT(
      errors("keys: {a: 3, b: {at: -1}, c: {att: 1}}\n"),
      ElementsAre("exp.yaml:1:11: 'keys.a' is '3'; expected a section with keys of at, pose, camera",
                  "exp.yaml:1:22: 'keys.b.at' is '-1'; expected a finite number at least 0 (s)",
                  HasSubstr("missing key 'keys.c.at'"),
                  HasSubstr("unknown key 'att' in 'keys.c'; expected one of at, pose, camera; did you "
                            "mean 'at'?")));
}

TEST_F(GroupsParameter, MayNeedAnEntry) {
  table_ = ParameterTable{groups("keys", {integer("a", 1)}).at_least(2)};
  EXPECT_THAT(errors("keys: {x: {}}\n"),
              ElementsAre("exp.yaml:1:1: 'keys' has 1 entries; expected at least 2"));
  EXPECT_EQ(load("keys: {x: {}, y: {}}\n").values.sections("keys").size(), 2U);
  EXPECT_EQ(json_schema(table_, registry_)["properties"]["keys"]["minProperties"], 2);
}

TEST_F(GroupsParameter, TheSchemaAndTheListingSayAsMuch) {
  const auto schema = json_schema(table_, registry_);
  const auto& keys = schema["properties"]["keys"];
  EXPECT_EQ(keys["type"], "object");
  EXPECT_FALSE(keys.contains("default"));
  EXPECT_EQ(keys["additionalProperties"]["anyOf"][0]["properties"]["at"]["minimum"], 0);
  EXPECT_EQ(schema["else"]["required"], std::vector<std::string>{"keys"});
  const std::string text = describe({"data", "scene", "A scene", table_});
  EXPECT_THAT(text, HasSubstr("keys                     map of sections"));
  EXPECT_THAT(text, HasSubstr("keys.NAME.camera.turn    number"));
}

}  // namespace
}  // namespace pliant::test
