#include "framework/core/parameters.h"

#include <stdexcept>

#include <gmock/gmock.h>

namespace pliant {
namespace {

TEST(Parameter, KeepsWhatItsRowSays) {
  const Parameter row = real("step", 0.5).unit("mm").range(0, 2).doc("A step");
  EXPECT_EQ(row.name(), "step");
  EXPECT_EQ(row.type(), ParameterType::real);
  EXPECT_EQ(row.unit(), "mm");
  EXPECT_EQ(row.doc(), "A step");
  EXPECT_EQ(row.lowest(), 0.0);
  EXPECT_EQ(row.highest(), 2.0);
  EXPECT_FALSE(row.lowest_excluded());
  EXPECT_FALSE(row.is_optional());
  EXPECT_EQ(row.default_text(), "0.5");
}

TEST(Parameter, RangesMayBeOpenOnOneSide) {
  const Parameter above = real("a").above(0);
  EXPECT_TRUE(above.lowest_excluded());
  EXPECT_EQ(above.lowest(), 0.0);
  EXPECT_EQ(above.highest(), std::nullopt);
  const Parameter at_least = integer("b").at_least(3);
  EXPECT_FALSE(at_least.lowest_excluded());
  EXPECT_EQ(at_least.lowest(), 3.0);
}

TEST(Parameter, DefaultsAreWrittenAsInAFile) {
  EXPECT_EQ(boolean("a", true).default_text(), "true");
  EXPECT_EQ(boolean("a", false).default_text(), "false");
  EXPECT_EQ(integer("a", -7).default_text(), "-7");
  EXPECT_EQ(real("a", 1e-6).default_text(), "1e-06");
  EXPECT_EQ(real("a", 0.1).default_text(), "0.1");
  EXPECT_EQ(text("a", "").default_text(), "");
  EXPECT_EQ(choice("a", {"x", "y"}, "y").default_text(), "y");
  EXPECT_EQ(component("a", "solver", "fast").default_text(), "fast");
  EXPECT_EQ(group("a", {}).default_text(), "");
  EXPECT_EQ(overrides("a").default_text(), "");
}

TEST(Parameter, WithoutDefaultTheKeyIsRequired) {
  EXPECT_EQ(boolean("a").default_text(), std::nullopt);
  EXPECT_EQ(path("a").default_text(), std::nullopt);
  EXPECT_EQ(components("a", "energy").default_text(), std::nullopt);
  EXPECT_EQ(groups("a", {}).default_text(), std::nullopt);
  EXPECT_EQ(words("a").default_text(), std::nullopt);
  EXPECT_TRUE(static_cast<const Parameter&>(path("a").optional()).is_optional());
}

TEST(Parameter, EntriesOfGroupsHoldNoOverrides) {
  EXPECT_EQ(groups("a", {integer("b", 1)}).table().rows().size(), 1U);
  EXPECT_THROW(groups("a", {overrides("runs")}), std::logic_error);
  EXPECT_THROW(groups("a", {group("b", {overrides("runs")})}), std::logic_error);
}

TEST(ParameterTable, FindsRowsByName) {
  const ParameterTable table{integer("a", 1), group("b", {real("c", 2)})};
  ASSERT_NE(table.find("b"), nullptr);
  EXPECT_EQ(table.find("b")->table().rows().front().name(), "c");
  EXPECT_EQ(table.find("c"), nullptr);
}

TEST(Parameters, AskingForWhatTheTableDoesNotHaveIsAProgrammingError) {
  const Parameters inner("fast", {{"threads", std::int64_t{2}}});
  const Parameters values("", {{"flag", true},
                               {"one", Parameters::Sections{{"one", inner}}, true},
                               {"many", Parameters::Sections{{"x", inner}, {"y", inner}}},
                               {"list", std::vector<std::string>{"p"}}});
  EXPECT_TRUE(values.boolean("flag"));
  EXPECT_EQ(values.section("one").integer("threads"), 2);
  EXPECT_EQ(values.section("one").component(), "fast");
  EXPECT_EQ(values.sections("many").size(), 2u);
  EXPECT_THAT(values.words("list"), testing::ElementsAre("p"));
  EXPECT_TRUE(values.has("flag"));
  EXPECT_FALSE(values.has("threads"));
  EXPECT_THROW(values.boolean("absent"), std::logic_error);
  EXPECT_THROW(values.real("flag"), std::logic_error);
  EXPECT_THROW(values.integer("flag"), std::logic_error);
  EXPECT_THROW(values.text("flag"), std::logic_error);
  EXPECT_THROW(values.words("flag"), std::logic_error);
  EXPECT_THROW(values.section("flag"), std::logic_error);
  EXPECT_THROW(values.section("many"), std::logic_error);
  EXPECT_THROW(values.sections("one"), std::logic_error);
}

}  // namespace
}  // namespace pliant
