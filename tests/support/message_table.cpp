#include "support/message_table.hpp"

#include <fstream>
#include <ostream>
#include <stdexcept>

#include "support/paths.hpp"

namespace ricochet::test_support {

namespace {

/// Replaces {name} by the text of that name, and \n and \\ by what they stand for.
std::string expanded(const std::string& cell, const std::map<std::string, std::string>& texts) {
  std::string result;
  for (std::size_t i = 0; i < cell.size(); ++i) {
    const std::size_t end = cell[i] == '{' ? cell.find('}', i) : std::string::npos;
    const auto text = end == std::string::npos ? texts.end() : texts.find(cell.substr(i + 1, end - i - 1));
    if (text != texts.end()) {
      result += text->second;
      i = end;
    } else if (cell[i] == '\\') {
      result += cell.at(++i) == 'n' ? '\n' : cell[i];
    } else {
      result += cell[i];
    }
  }
  return result;
}

}  // namespace

std::vector<MessageRow> read_messages(const std::string& file, std::map<std::string, std::string> texts) {
  std::ifstream lines(data_path("messages/" + file));
  if (!lines) throw std::runtime_error(file + " cannot be read");
  std::vector<MessageRow> rows;
  std::string line, section;
  for (int number = 1; std::getline(lines, line); ++number) {
    const std::size_t equals = line.find("} = ");
    if (line.empty() || line[0] == '#') continue;
    if (line[0] == '{' && equals != std::string::npos) {
      texts[line.substr(1, equals - 1)] = expanded(line.substr(equals + 4), texts);
    } else if (line[0] == '[' && line.back() == ']') {
      section = line.substr(1, line.size() - 2);
    } else {
      MessageRow row{section + '_' + std::to_string(number), {}};
      for (std::size_t begin = 0; begin != std::string::npos;) {
        const std::size_t end = line.find(" | ", begin);
        row.cells.push_back(expanded(line.substr(begin, end == std::string::npos ? end : end - begin), texts));
        begin = end == std::string::npos ? end : end + 3;
      }
      rows.push_back(row);
    }
  }
  return rows;
}

void PrintTo(const MessageRow& row, std::ostream* stream) {
  for (const std::string& cell : row.cells) *stream << cell << '\n';
}

}  // namespace ricochet::test_support
