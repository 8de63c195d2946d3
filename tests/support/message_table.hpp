#pragma once

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

/// @file Tables of malformed input and of the messages about it, in tests/data/messages.
namespace ricochet::test_support {

struct MessageRow {
  std::string name;  ///< of a test: the section of the table and the number of the line, as in structure_12
  std::vector<std::string> cells;
};

/// Reads a table. Cells are separated by " | "; in cells \n is a new line and {name} one of `texts`, to which lines
/// "{name} = text" add; [name] begins a section, and # a comment.
std::vector<MessageRow> read_messages(const std::string& file, std::map<std::string, std::string> texts = {});

/// Names of tests, for INSTANTIATE_TEST_SUITE_P.
inline std::string name_of_row(const testing::TestParamInfo<MessageRow>& parameter) { return parameter.param.name; }
/// A failing test prints its row.
void PrintTo(const MessageRow& row, std::ostream* stream);

}  // namespace ricochet::test_support
