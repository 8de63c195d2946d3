#include "ricochet/base/number_lines.hpp"

#include <gtest/gtest.h>

#include "ricochet/base/text.hpp"
#include "support/errors.hpp"

/// @file A misspelt number is neither skipped nor mistaken for a header, on any line.
namespace ricochet::test_support {
namespace {

using Rows = std::vector<std::vector<double>>;
using Header = NumberLines::Header;

Rows rows_of(const std::string& text, Header header = Header::allowed) {
  const std::string file = "f";
  NumberLines lines(file, text, header);
  Rows rows;
  while (lines.next()) {
    if (!lines.numbers().empty()) rows.push_back(lines.numbers());
  }
  return rows;
}

std::string problem_of(const std::string& text, Header header = Header::allowed) {
  const std::string message = message_of([&] { (void)rows_of(text, header); });
  return message;
}

TEST(NumberLines, SeparateNumbersByBlanksCommasOrSemicolons) {
  const Rows expected{{0.0, 1.5e-3}, {-2.0, 0.25}};
  for (const std::string text :
       {"0 1.5e-3\n-2 .25\n", "0,1.5e-3\r\n-2, .25,\r\n", "\t0;1.5e-3 # start\n\n# end\n-2 ; .25",
        "t ux\n0 1.5e-3\n-2 .25", "# t, ux\n\"t [s]\",µ_x\n0 +1.5E-3\n-2 .25\n",
        "\xEF\xBB\xBF"
        "0 1.5e-3\n-2 .25\n"})
    EXPECT_EQ(rows_of(text), expected) << text;
}

TEST(NumberLines, RefuseCommasThatMayBeDecimalOnes) {
  EXPECT_EQ(problem_of("0,5 1,0\n").find("f:1:6: commas and blanks in one line: use decimal points"), 0U);
  EXPECT_EQ(problem_of("1 2\n0,5\t1\n").find("f:2:2: commas and blanks"), 0U);
  EXPECT_EQ(problem_of("0,5;1,0\n").find("f:1:2: commas and semicolons"), 0U);
  EXPECT_EQ(problem_of("0.5, 1.0,\n"), "");
  EXPECT_EQ(problem_of("0.5 ,1.0\n"), "");
}

TEST(NumberLines, ShowWholeCharacters) {
  const std::string ascii(39, 'a');
  EXPECT_EQ(shown_word(ascii + "\xC3\xA9\xC3\xA9"), ascii + "…") << "the fortieth byte is half of a character";
  EXPECT_EQ(shown_word(ascii + "b"), ascii + "b");
  EXPECT_EQ(shown_word(ascii + "bc"), ascii + "b…");
}

/// Each of these words was once mistaken for a header on the first line.
TEST(NumberLines, TakeNoMisspeltNumberForAHeader) {
  for (const std::string word : {"0.0m", "nan", "NaN", "inf", "-Infinity", "1.5.2", "1e", "0x10", "+-1", "--1", "1d3",
                                 ".", "-", "1e999", "12:30", "3rd", "\"0.0\"",
                                 "\xE2\x88\x92"
                                 "0.1",
                                 "(0.0"}) {
    EXPECT_FALSE(number_in(word)) << word;
    for (const Header header : {Header::allowed, Header::refused}) {
      EXPECT_EQ(problem_of("0.0 " + word + " 0.0\n", header).find("f:1:5: \"" + word + "\" is not a finite number"), 0U)
          << problem_of("0.0 " + word + " 0.0\n", header);
      EXPECT_EQ(problem_of(word + "\n", header).find("f:1:1: "), 0U) << word;
      EXPECT_EQ(problem_of("\n0 0\n0 " + word, header).find("f:3:3: "), 0U) << word;
    }
    EXPECT_EQ(problem_of("time x " + word + "\n").find("f:1:"), 0U) << "a header is letters alone: " << word;
  }
  EXPECT_EQ(problem_of("\xEF\xBB\xBF"
                       "0.0m 0\n")
                .find("f:1:1: "),
            0U);
}

TEST(NumberLines, HaveOneHeaderAtMost) {
  EXPECT_EQ(problem_of("t x\ns mm\n0 1\n").find("f:2:1: \"s\" is not a finite number"), 0U);
  EXPECT_EQ(problem_of("0 1\nt x\n").find("f:2:1: \"t\""), 0U);
  EXPECT_EQ(problem_of("t x\n0 1\n", Header::refused).find("f:1:1: \"t\""), 0U);
  const std::string file = "f", text = "# a\n time, \"ux\"\n0 1\n";
  NumberLines lines(file, text, Header::allowed);
  while (lines.next()) {
  }
  EXPECT_EQ(lines.header(), (std::vector<std::string>{"time", "\"ux\""}));
  EXPECT_EQ(lines.header_line(), 2);
}

/// An omitted value would shift the others by a column; "0,5;1,0" can be read as two numbers or as four.
TEST(NumberLines, RefuseWhatCouldBeReadInTwoWays) {
  EXPECT_EQ(problem_of("0,,1\n").find("f:1:3: a number is missing before this \",\""), 0U);
  EXPECT_EQ(problem_of("1 2\n, 1\n").find("f:2:1: a number is missing"), 0U);
  EXPECT_EQ(problem_of("0,5;1,0\n").find("f:1:2: commas and semicolons"), 0U);
}

TEST(TextWords, KnowTheirPlaces) {
  const std::string file = "f", text = "a  12\n\n \tb +.5x";
  TextWords words(file, text);
  EXPECT_EQ(words.next(), "a");
  EXPECT_EQ(words.number(), 12.0);
  EXPECT_EQ(words.next(), "b");
  EXPECT_EQ(message_of([&] { (void)words.number(); }), "f:3:5: \"+.5x\" is not a finite number");
  EXPECT_EQ(words.next(), "");
}

}  // namespace
}  // namespace ricochet::test_support
