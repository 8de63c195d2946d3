#pragma once

#include <string>
#include <variant>
#include <vector>

/// @file A table of results: as a file for programs (CSV), for readers (Markdown) and on a terminal.
namespace ricochet {

/// Empty, a number, a count or a text.
using TableCell = std::variant<std::monostate, double, long, std::string>;

struct TableColumn {
  std::string name;
  /// Also appears in the tables for readers, unless it is empty in every row.
  bool is_for_readers = true;
  int digits = 4;  ///< of numbers for readers
  int part = 0;    ///< part of the tables for readers, which divide wide tables
};

struct ResultTable {
  std::vector<TableColumn> columns;
  std::vector<std::vector<TableCell>> rows;  ///< each as long as the columns
  std::size_t key_columns = 0;               ///< number of leading columns that each part repeats

  /// Returns the index of a column; the number of columns if there is none of this name.
  [[nodiscard]] std::size_t find(const std::string& name) const;
  [[nodiscard]] std::vector<std::string> names() const;
};

/// Returns the number in a cell, including one stored as text; NaN if there is none.
[[nodiscard]] double number_of(const TableCell& cell);
/// Returns the full text: numbers in the shortest exact form; "" for an empty cell.
[[nodiscard]] std::string text_of(const TableCell& cell);

/// Returns RFC 4180 text except for line ends (\n): a header row, then the rows; entries that contain a comma, a quote
/// or a line end are quoted.
[[nodiscard]] std::string to_csv(const ResultTable& table);

/// Makes a table for readers: rounded, without empty columns, in parts.
[[nodiscard]] std::string to_markdown(const ResultTable& table);
[[nodiscard]] std::string to_html(const ResultTable& table);
/// Makes columns of equal width, for a terminal.
[[nodiscard]] std::string to_aligned_text(const ResultTable& table);

/// Returns a text as one line of Markdown, in a table or not, such that names given by users or mesh files appear
/// unchanged.
[[nodiscard]] std::string markdown_text(const std::string& text);
/// Escapes a text for HTML.
[[nodiscard]] std::string escaped(const std::string& text);

}  // namespace ricochet
