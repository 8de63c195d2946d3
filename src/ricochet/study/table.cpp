#include "ricochet/study/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <limits>
#include <map>
#include <string_view>

#include "ricochet/base/text.hpp"

namespace ricochet {

namespace {

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

/// Returns a cell for readers.
std::string rounded(const TableCell& cell, int digits) {
  const double* const number = std::get_if<double>(&cell);
  return number != nullptr ? fmt::format("{:.{}g}", *number, digits) : text_of(cell);
}

/// Table for readers: the names of columns, then the cells of each row; and which columns contain only numbers.
struct ReadersTable {
  std::vector<std::vector<std::string>> lines;
  std::vector<bool> is_number;
};

ReadersTable readers_table(const ResultTable& table, const std::vector<std::size_t>& columns) {
  ReadersTable result;
  result.lines.resize(table.rows.size() + 1);
  for (const std::size_t c : columns) {
    result.is_number.push_back(std::ranges::none_of(table.rows, [c](const auto& row) {
      const auto* text = std::get_if<std::string>(&row[c]);
      return text != nullptr && !text->empty() && !number_in(*text);
    }));
    result.lines[0].push_back(table.columns[c].name);
    for (std::size_t r = 0; r < table.rows.size(); ++r)
      result.lines[r + 1].push_back(rounded(table.rows[r][c], table.columns[c].digits));
  }
  return result;
}

/// Returns the parts with entries besides the keys.
std::vector<ReadersTable> parts_of(const ResultTable& table) {
  std::map<int, std::vector<std::size_t>> columns;
  for (std::size_t c = table.key_columns; c < table.columns.size(); ++c) {
    const auto is_empty = [c](const auto& row) { return text_of(row[c]).empty(); };
    if (!table.columns[c].is_for_readers || std::ranges::all_of(table.rows, is_empty)) continue;
    std::vector<std::size_t>& part = columns[table.columns[c].part];
    if (part.empty()) {
      for (std::size_t key = 0; key < table.key_columns; ++key) part.push_back(key);
    }
    part.push_back(c);
  }
  std::vector<ReadersTable> parts;
  for (const auto& [part, shown] : columns) parts.push_back(readers_table(table, shown));
  return parts;
}

/// Returns the number of UTF-8 characters, not bytes.
std::size_t width_of(const std::string& text) {
  return std::size_t(
      std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

}  // namespace

std::size_t ResultTable::find(const std::string& name) const {
  const auto found = std::ranges::find_if(columns, [&](const TableColumn& column) { return column.name == name; });
  return std::size_t(found - columns.begin());
}

std::vector<std::string> ResultTable::names() const {
  std::vector<std::string> result;
  for (const TableColumn& column : columns) result.push_back(column.name);
  return result;
}

double number_of(const TableCell& cell) {
  if (const auto* real = std::get_if<double>(&cell)) return *real;
  if (const auto* count = std::get_if<long>(&cell)) return double(*count);
  const auto* text = std::get_if<std::string>(&cell);
  return text != nullptr ? number_in(*text).value_or(std::numeric_limits<double>::quiet_NaN())
                         : std::numeric_limits<double>::quiet_NaN();
}

std::string text_of(const TableCell& cell) {
  if (const auto* real = std::get_if<double>(&cell)) return fmt::format("{}", *real);
  if (const auto* count = std::get_if<long>(&cell)) return fmt::format("{}", *count);
  const auto* text = std::get_if<std::string>(&cell);
  return text != nullptr ? *text : "";
}

std::string to_csv(const ResultTable& table) {
  std::string csv;
  for (const TableColumn& column : table.columns) csv += quoted(column.name) + ",";
  csv.back() = '\n';
  for (const auto& row : table.rows) {
    for (const TableCell& cell : row) csv += quoted(text_of(cell)) + ",";
    csv.back() = '\n';
  }
  return csv;
}

namespace {

std::string part_to_markdown(const ReadersTable& shown) {
  std::string text;
  for (std::size_t r = 0; r < shown.lines.size(); ++r) {
    text += "|";
    for (const std::string& cell : shown.lines[r]) {
      text += fmt::format(" {} |", markdown_text(cell));
    }
    text += "\n";
    if (r > 0) continue;
    text += "|";
    for (const bool is_number : shown.is_number) text += is_number ? "---:|" : "---|";
    text += "\n";
  }
  return text;
}

std::string part_to_html(const ReadersTable& shown) {
  std::string text = "<table>\n";
  for (std::size_t r = 0; r < shown.lines.size(); ++r) {
    text += "<tr>";
    for (std::size_t c = 0; c < shown.lines[r].size(); ++c) {
      const char* const tag = r == 0 ? "th" : "td";
      text += fmt::format("<{}{}>{}</{}>", tag, shown.is_number[c] ? " class=\"number\"" : "",
                          escaped(shown.lines[r][c]), tag);
    }
    text += "</tr>\n";
  }
  return text + "</table>\n";
}

std::string part_to_aligned_text(const ReadersTable& shown) {
  std::vector<std::size_t> widths(shown.is_number.size());
  for (const auto& line : shown.lines) {
    for (std::size_t c = 0; c < line.size(); ++c) widths[c] = std::max(widths[c], width_of(line[c]));
  }
  std::string text;
  for (const auto& line : shown.lines) {
    std::string row;
    for (std::size_t c = 0; c < line.size(); ++c) {
      const std::string padding(widths[c] - width_of(line[c]), ' ');
      row += shown.is_number[c] ? padding + line[c] : line[c] + padding;
      row += "  ";
    }
    row.erase(row.find_last_not_of(' ') + 1);
    text += row + "\n";
  }
  return text;
}

std::string joined(const ResultTable& table, std::string (*write)(const ReadersTable&)) {
  std::string text;
  for (const ReadersTable& part : parts_of(table)) {
    if (!text.empty()) text += "\n";
    text += write(part);
  }
  return text;
}

}  // namespace

std::string to_markdown(const ResultTable& table) { return joined(table, part_to_markdown); }

std::string to_html(const ResultTable& table) { return joined(table, part_to_html); }

std::string to_aligned_text(const ResultTable& table) { return joined(table, part_to_aligned_text); }

std::string markdown_text(const std::string& text) {
  std::string result;
  const auto is_word = [&](std::size_t i) {
    return i < text.size() && std::isalnum(static_cast<unsigned char>(text[i]));
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    // As entities, since not every Markdown reader supports \<.
    if (c == '<' || c == '>' || c == '&') {
      result += escaped(std::string(1, c));
    } else if (c == '\n' || c == '\r') {
      result += ' ';
    } else {
      // _ has no meaning inside a word, and ( makes a link only after ]: names and formulas stay legible.
      const bool is_underscore = c == '_' && !(i > 0 && is_word(i - 1) && is_word(i + 1));
      const bool is_link = c == '(' && i > 0 && text[i - 1] == ']';
      if (is_underscore || is_link || std::string_view("\\|`*~$").find(c) != std::string_view::npos) result += '\\';
      result += c;
    }
  }
  return result;
}

std::string escaped(const std::string& text) {
  static const std::map<char, std::string_view> entities{{'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}};
  std::string result;
  for (const char c : text) {
    const auto entity = entities.find(c);
    result += entity != entities.end() ? entity->second : std::string_view(&c, 1);
  }
  return result;
}

}  // namespace ricochet
