#include "framework/config/schema.h"

#include <gmock/gmock.h>

#include "framework/core/error.h"
#include "tests/config/toy_experiment.h"

namespace pliant::test {
namespace {

using nlohmann::ordered_json;
using testing::HasSubstr;

ordered_json json(const char* text) { return ordered_json::parse(text); }

class Schema : public testing::Test {
 protected:
  const Registry registry_ = toy_registry();
  const ordered_json schema_ = json_schema(toy_table(), registry_);
  const ordered_json& keys_ = schema_["properties"];
  const ordered_json& definitions_ = schema_["$defs"];
};

TEST_F(Schema, IsADraft7SchemaThatTakesNoOtherKeys) {
  EXPECT_EQ(schema_["$schema"], "http://json-schema.org/draft-07/schema#");
  EXPECT_EQ(schema_["additionalProperties"], false);
  EXPECT_EQ(keys_["stop"]["additionalProperties"], false);
  EXPECT_EQ(keys_["stop"]["properties"]["deep"]["additionalProperties"], false);
  EXPECT_EQ(definitions_["solver.ceres_lm"]["additionalProperties"], false);
}

TEST_F(Schema, KnowsExtendsAndThenRequiresNothing) {
  EXPECT_EQ(keys_["extends"]["type"], "string");
  EXPECT_EQ(schema_["if"], json(R"({"anyOf": [{"required": ["extends"]}, {"required": ["variants"]}]})"));
  EXPECT_EQ(schema_["else"], json(R"({"required": ["data", "energies"]})"));
  EXPECT_FALSE(schema_.contains("required"));
}

TEST_F(Schema, DocumentsUnitsAndDefaults) {
  const auto& solver = definitions_["solver.gauss_newton"]["properties"];
  EXPECT_EQ(solver["tolerance"]["description"], "Change at which it stops [mm] (default: 1e-06)");
  EXPECT_EQ(solver["tolerance"]["default"], 1e-6);
  EXPECT_EQ(solver["iterations"]["default"].dump(), "10");
  EXPECT_EQ(keys_["title"]["description"], "Name in reports (default: \"untitled\")");
  EXPECT_EQ(keys_["data"]["description"], "What to register (required)");
  EXPECT_THAT(keys_["align"]["description"].get<std::string>(), HasSubstr("(optional)"));
  EXPECT_FALSE(keys_["solver"].contains("default"));
}

TEST_F(Schema, GivesTypesAndRanges) {
  const auto& solver = definitions_["solver.gauss_newton"]["properties"];
  EXPECT_EQ(solver["iterations"]["type"], "integer");
  EXPECT_EQ(solver["iterations"]["minimum"].dump(), "1");
  EXPECT_EQ(solver["iterations"]["maximum"].dump(), "100");
  EXPECT_EQ(solver["tolerance"]["type"], "number");
  EXPECT_EQ(keys_["compare"]["properties"]["pixels"]["multipleOf"], 8);
  EXPECT_FALSE(solver["iterations"].contains("multipleOf"));
  const auto& rotation = definitions_["energy.rotation"]["properties"];
  EXPECT_EQ(rotation["weight"]["exclusiveMinimum"], 0);
  EXPECT_FALSE(rotation["weight"].contains("minimum"));
  EXPECT_EQ(rotation["robust"]["enum"], json(R"(["none", "huber", "tukey"])"));
  EXPECT_EQ(definitions_["energy.constraint"]["properties"]["plane"]["type"], "boolean");
  EXPECT_EQ(definitions_["energy.constraint"]["properties"]["plane"]["default"], true);
}

TEST_F(Schema, ChoosesTheKeysOfAComponentByItsType) {
  EXPECT_EQ(keys_["solver"]["allOf"], json(R"([{"$ref": "#/$defs/solver"}])"));
  const auto& solver = definitions_["solver"]["oneOf"];
  EXPECT_EQ(solver[0], json(R"({"enum": ["gauss_newton", "ceres_lm"]})"));
  EXPECT_EQ(solver[1]["properties"]["type"]["enum"], json(R"(["gauss_newton", "ceres_lm"])"));
  EXPECT_EQ(solver[1]["allOf"][1],
            json(R"({"if": {"required": ["type"], "properties": {"type": {"const": "ceres_lm"}}},
                     "then": {"$ref": "#/$defs/solver.ceres_lm"}})"));
  EXPECT_EQ(definitions_["solver.ceres_lm"]["properties"]["type"]["const"], "ceres_lm");
  EXPECT_EQ(definitions_["solver.ceres_lm"]["properties"]["linear"]["allOf"][0]["$ref"],
            "#/$defs/linear_solver");
}

TEST_F(Schema, KnowsLabelsThatAreComponents) {
  const auto& energies = keys_["energies"];
  EXPECT_EQ(energies["properties"]["rotation"]["anyOf"][0]["else"]["$ref"], "#/$defs/energy.rotation");
  EXPECT_EQ(energies["properties"]["rotation"]["description"], "Keeps the nodes rigid");
  EXPECT_EQ(energies["additionalProperties"]["anyOf"][0]["$ref"], "#/$defs/energy");
}

TEST_F(Schema, OverridesArePartialExperimentsWithoutOverrides) {
  EXPECT_EQ(keys_["variants"]["additionalProperties"]["anyOf"][0]["$ref"], "#/$defs/override");
  const auto& override_ = definitions_["override"];
  EXPECT_TRUE(override_["properties"].contains("solver"));
  EXPECT_FALSE(override_["properties"].contains("variants"));
  EXPECT_FALSE(override_["properties"].contains("compare"));
  EXPECT_TRUE(override_["properties"].contains("extends"));
  EXPECT_FALSE(override_.contains("required"));
}

TEST_F(Schema, SweepsAreListsOrNamedOverridesUnderTheKeyThatTheTableNames) {
  const ParameterTable table{overrides("variants").swept_by("sweep")};
  const ordered_json sweep = json_schema(table, registry_)["properties"]["sweep"];
  EXPECT_EQ(sweep["type"], "object");
  const ordered_json& either = sweep["additionalProperties"]["anyOf"];
  EXPECT_EQ(either[0]["type"], "array");
  EXPECT_EQ(either[0]["minItems"], 1);
  EXPECT_EQ(either[1]["additionalProperties"]["anyOf"][0]["$ref"], "#/$defs/override");
  EXPECT_THAT(sweep["description"], HasSubstr("becomes one of 'variants'"));
  EXPECT_FALSE(keys_.contains("sweep"));
}

void collect_references(const ordered_json& value, std::vector<std::string>& references) {
  for (const auto& [key, item] : value.items()) {
    if (key == "$ref") references.push_back(item.get<std::string>());
    if (item.is_structured()) collect_references(item, references);
  }
}

TEST_F(Schema, EveryReferenceLeadsSomewhere) {
  std::vector<std::string> references;
  collect_references(json_schema({component("a", "nothing_of_this_kind")}, registry_), references);
  collect_references(schema_, references);
  EXPECT_GT(references.size(), 20u);
  const auto with_unknown = json_schema({component("a", "nothing_of_this_kind")}, registry_);
  for (const auto& reference : references) {
    const ordered_json::json_pointer pointer(reference.substr(1));
    EXPECT_TRUE(schema_.contains(pointer) || with_unknown.contains(pointer)) << reference;
  }
}

TEST(Describe, ShowsATableOfParameters) {
  const Registry registry = toy_registry();
  EXPECT_EQ(describe(*registry.find("solver", "gauss_newton")),
            "gauss_newton (solver)\n"
            "  Gauss-Newton on the device\n"
            "\n"
            "  parameter   type           unit  default   range          what it is\n"
            "  iterations  integer              10        from 1 to 100  Steps at most\n"
            "  tolerance   number         mm    1e-06     from 0 to 1    Change at which it stops\n"
            "  linear      linear_solver        cholesky                 For the normal equations\n");
  EXPECT_EQ(describe(*registry.find("linear_solver", "cholesky")),
            "cholesky (linear_solver)\n  Dense Cholesky\n\n  It has no parameters.\n");
}

TEST(Describe, ShowsRequiredOptionalChoicesAndGroups) {
  const ComponentInfo info{"kind",
                           "name",
                           "doc",
                           {path("file"), path("mask").optional(), text("word", "w"),
                            choice("c", {"a", "b"}, "a"), boolean("flag", true), words("list"),
                            components("parts", "part"), group("inner", {real("x", 1).above(0)})}};
  const std::string text = describe(info);
  EXPECT_THAT(text, HasSubstr("\n  file       file           required\n"));
  EXPECT_THAT(text, HasSubstr("\n  mask       file           (none)\n"));
  EXPECT_THAT(text, HasSubstr("\n  word       text           \"w\"\n"));
  EXPECT_THAT(text, HasSubstr("\n  c          choice         a         a, b\n"));
  EXPECT_THAT(text, HasSubstr("\n  flag       true/false     true\n"));
  EXPECT_THAT(text, HasSubstr("\n  list       list of texts  required\n"));
  EXPECT_THAT(text, HasSubstr("\n  parts      map of part    required\n"));
  EXPECT_THAT(text, HasSubstr("\n  inner      section\n"));
  EXPECT_THAT(text, HasSubstr("\n  inner.x    number         1         above 0\n"));
}

TEST(ListComponents, ShowsOneKindOrAll) {
  const Registry registry = toy_registry();
  EXPECT_EQ(
      list_components(registry, "solver"),
      "solver\n  gauss_newton  Gauss-Newton on the device\n  ceres_lm      Levenberg-Marquardt of Ceres\n");
  const std::string all = list_components(registry);
  EXPECT_THAT(all, HasSubstr("energy\n  rotation    Keeps the nodes rigid\n"));
  EXPECT_THAT(all, HasSubstr("\n\nsolver\n"));
}

TEST(ListComponents, RefusesAnUnknownKind) {
  try {
    list_components(toy_registry(), "solvr");
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(),
                 "unknown kind of component 'solvr'; expected one of energy, solver, linear_solver, data, "
                 "alignment; did you mean 'solver'?");
  }
}

}  // namespace
}  // namespace pliant::test
