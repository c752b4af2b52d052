#include "framework/io/text_lines.h"

#include <gmock/gmock.h>

#include "tests/io/test_files.h"

namespace pliant {
namespace {

using test::data_error_of;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

class TextLinesFile : public test::TestFiles {};

TEST_F(TextLinesFile, AreSplitIntoWordsWhateverEndsThem) {
  TextLines lines(write("a.txt", std::string("\xEF\xBB\xBF"
                                             "one\ttwo \r\n\n# all a comment\rlast#one")));
  auto line = lines.next();
  EXPECT_EQ(line->number, 1);
  EXPECT_THAT(line->words, ElementsAre("one", "two"));
  EXPECT_THAT(lines.next()->words, IsEmpty());
  EXPECT_THAT(lines.next()->words, IsEmpty());
  line = lines.next();
  EXPECT_EQ(line->number, 4);
  EXPECT_THAT(line->words, ElementsAre("last"));
  EXPECT_FALSE(lines.next());
}

TEST_F(TextLinesFile, NumbersAreReadWhateverTheLocale) {
  TextLines lines(write("a.txt", std::string("1.5e3 +2 -7 12\n")));
  const auto line = *lines.next();
  EXPECT_EQ(lines.real(line, 0), 1500);
  EXPECT_EQ(lines.real(line, 1), 2);
  EXPECT_EQ(lines.integer(line, 2), -7);
  EXPECT_EQ(lines.integer(line, 3), 12);
}

TEST_F(TextLinesFile, WhatIsNoNumberIsToldWithItsLine) {
  TextLines lines(write("a.txt", std::string("\n1,5 nan 1e999 1.5 0x10 +-1 \x01\x1b[1m\n")));
  lines.next();
  const auto line = *lines.next();
  const std::string place = file("a.txt") + ":2: ";
  EXPECT_EQ(data_error_of([&] { lines.real(line, 0); }), place + "'1,5' is not a number");
  for (const std::size_t word : {1, 2, 4, 5}) data_error_of([&] { lines.real(line, word); });
  EXPECT_EQ(data_error_of([&] { lines.integer(line, 3); }), place + "'1.5' is not a whole number");
  EXPECT_EQ(data_error_of([&] { lines.real(line, 6); }), place + "'??[1m' is not a number");
  EXPECT_EQ(data_error_of([&] { lines.real(line, 7); }), place + "a number is missing");
}

}  // namespace
}  // namespace pliant
