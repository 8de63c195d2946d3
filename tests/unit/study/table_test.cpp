#include "ricochet/study/table.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace ricochet {
namespace {

const ResultTable table{{{"time.step"}, {"v, m/s"}, {"empty"}, {"count", false}, {"text"}},
                        {{"1e-3", 1.0 / 3.0, {}, 7L, "a \"b\""}, {"5e-4", -2e-30, {}, 12L, "µ|<c>"}},
                        1};

TEST(ResultTable, IsExactInCsv) {
  EXPECT_EQ(to_csv(table),
            "time.step,\"v, m/s\",empty,count,text\n"
            "1e-3,0.3333333333333333,,7,\"a \"\"b\"\"\"\n"
            "5e-4,-2e-30,,12,µ|<c>\n");
}

TEST(ResultTable, IsRoundedForReaders) {
  EXPECT_EQ(to_markdown(table),
            "| time.step | v, m/s | text |\n|---:|---:|---|\n| 1e-3 | 0.3333 | a \"b\" |\n"
            "| 5e-4 | -2e-30 | µ\\|&lt;c&gt; |\n");
  EXPECT_EQ(to_aligned_text(table),
            "time.step  v, m/s  text\n"
            "     1e-3  0.3333  a \"b\"\n"
            "     5e-4  -2e-30  µ|<c>\n");
  EXPECT_NE(to_html(table).find("<td>µ|&lt;c&gt;</td>"), std::string::npos);
}

TEST(MarkdownText, IsReadAsItWasWritten) {
  EXPECT_EQ(markdown_text("peak_von_mises = 1e-3, [0, -1] (2) #1"), "peak_von_mises = 1e-3, [0, -1] (2) #1");
  EXPECT_EQ(markdown_text("<b>&|`*~$\\"), "&lt;b&gt;&amp;\\|\\`\\*\\~\\$\\\\");
  EXPECT_EQ(markdown_text("[a](http://b) _c_ __d"), "[a]\\(http://b) \\_c\\_ \\_\\_d");
  EXPECT_EQ(markdown_text("one\n# two\r"), "one # two ") << "it stays one line";
}

TEST(ResultTable, ShowsWideTablesInPartsThatBeginWithTheKeys) {
  ResultTable wide = table;
  wide.columns[4].part = 1;
  EXPECT_EQ(to_aligned_text(wide),
            "time.step  v, m/s\n     1e-3  0.3333\n     5e-4  -2e-30\n\n"
            "time.step  text\n     1e-3  a \"b\"\n     5e-4  µ|<c>\n");
}

TEST(ResultTable, FindsColumnsAndNumbers) {
  EXPECT_EQ(table.find("count"), 3u);
  EXPECT_EQ(table.find("none"), table.columns.size());
  EXPECT_EQ(number_of(table.rows[0][0]), 1e-3);
  EXPECT_EQ(number_of(table.rows[0][3]), 7.0);
  EXPECT_TRUE(std::isnan(number_of(table.rows[0][2])));
  EXPECT_TRUE(std::isnan(number_of(table.rows[0][4])));
}

}  // namespace
}  // namespace ricochet
