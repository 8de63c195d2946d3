#pragma once

#include <string>
#include <variant>
#include <vector>

/// @file A table of results: as a file for programs (CSV), for readers (Markdown) and on a terminal.
namespace ricochet {

/// Nothing, a number, a count or a text.
using TableCell = std::variant<std::monostate, double, long, std::string>;

struct TableColumn {
  std::string name;
  /// Also in the tables for readers, unless no row has anything there.
  bool is_for_readers = true;
  int digits = 4;  ///< of numbers for readers
  int part = 0;    ///< of the tables for readers, which show wide tables in parts
};

struct ResultTable {
  std::vector<TableColumn> columns;
  std::vector<std::vector<TableCell>> rows;  ///< each as long as the columns
  std::size_t key_columns = 0;               ///< so many at the beginning are repeated in each part

  /// The number of a column; that of columns where there is none.
  [[nodiscard]] std::size_t find(const std::string& name) const;
  [[nodiscard]] std::vector<std::string> names() const;
};

/// The number in a cell, also one that is there as text; NaN where there is none.
[[nodiscard]] double number_of(const TableCell& cell);
/// In full: numbers in the shortest form that is exact, an empty text for nothing.
[[nodiscard]] std::string text_of(const TableCell& cell);

/// RFC 4180 but for line ends (\n): a header row, then the rows; what contains a comma, a quote or a line end is
/// quoted.
[[nodiscard]] std::string to_csv(const ResultTable& table);

/// For readers: rounded, without columns that say nothing, in parts.
[[nodiscard]] std::string to_markdown(const ResultTable& table);
[[nodiscard]] std::string to_html(const ResultTable& table);
/// In columns of equal width, for a terminal.
[[nodiscard]] std::string to_aligned_text(const ResultTable& table);

/// A text as one line of Markdown, in a table or not: what a user or a mesh file has named stays what it is.
[[nodiscard]] std::string markdown_text(const std::string& text);
/// For HTML.
[[nodiscard]] std::string escaped(const std::string& text);

}  // namespace ricochet
