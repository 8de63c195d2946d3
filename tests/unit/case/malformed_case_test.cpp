#include <gtest/gtest.h>

#include "case_text.hpp"
#include "support/message_table.hpp"

// Malformed case files: tests/data/messages/malformed_case.txt has the messages.
namespace ricochet::case_test {

class MalformedCase : public testing::TestWithParam<MessageRow> {};

TEST_P(MalformedCase, HasAllMessagesThatFollow) {
  const std::vector<std::string>& cells = GetParam().cells;
  const std::string document = edited_case(std::stoul(cells.at(0)), cells.at(1));
  EXPECT_EQ(problems_of(document), cells.at(2)) << document;
}

INSTANTIATE_TEST_SUITE_P(All, MalformedCase,
                         testing::ValuesIn(read_messages("malformed_case.txt", {{"schemes", all_schemes()},
                                                                                {"keys_of_time", keys_of_time()}})),
                         name_of_row);

TEST(MalformedCaseFile, NamesKeysOfOtherSectionsWithThem) {
  const std::string wall = "[obstacle.wall]\ntype = 'plane'\npoint = [0, 0]\nnormal = [0, 1]\n";
  const std::vector<std::pair<std::string, std::string>> expected{
      {"friction = 0.3",
       "unknown key \"friction\" in [obstacle.wall] (\"friction\" is a key of [[contact]]); its keys "
       "are \"type\", "},
      {"rest_gap = 0.1", "(\"rest_gap\" is a key of [mesh] and of [part.NAME]); "},
      {"frictoin = 0.3", "unknown key \"frictoin\" in [obstacle.wall]; its keys are "},
      // too many sections have it, or it is one
      {"group = 'a'", "unknown key \"group\" in [obstacle.wall]; "},
      {"contact = 1", "unknown key \"contact\" in [obstacle.wall]; "}};
  for (const auto& [key, problem] : expected) EXPECT_TRUE(has(problems_of(edited_case(0, wall + key)), problem));
}

TEST(MalformedCaseFile, PartsOfANameSuggestIt) {
  EXPECT_TRUE(has(problems_of(edited_case(7, "mu = 1.0\nlaw = 'neohooke'")),
                  "found the text \"neohooke\"; did you mean \"neo-hookean\"?"));
  EXPECT_TRUE(has(problems_of(edited_case(0, "[output]\nfields = ['stres']")),
                  "found the text \"stres\"; did you mean \"stress\"?"));
  // Several names have this part.
  EXPECT_FALSE(has(problems_of(edited_case(9, "scheme = 'alpha'")), "did you mean"));
}

}  // namespace ricochet::case_test
