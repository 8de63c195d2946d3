#pragma once

#include <string>
#include <string_view>
#include <vector>

/// @file Words and numbers of text files, each with its line and column: motions, polygons, ASCII STL.
namespace ricochet {

/// Words of a text, separated by blanks.
class TextWords {
 public:
  /// Keeps references to both arguments, which must outlive this object.
  TextWords(const std::string& file, std::string_view text);

  /// Returns the next word; empty at the end of the text.
  [[nodiscard]] std::string_view next();
  void skip_line();
  /// Returns the next word as a finite number. Throws Error(invalid_input) if it is not one.
  [[nodiscard]] double number();
  /// Throws Error(invalid_input) with file, line and column of the last word.
  [[noreturn]] void fail(const std::string& problem) const;

 private:
  const std::string& file_;
  const char *at_, *end_, *line_begin_, *word_;
  long line_ = 1;
};

/// Returns a word as messages show it: the beginning of a long one, and "the end of the file" for an empty one.
[[nodiscard]] std::string shown_word(std::string_view word);

/// Lines of finite numbers, separated by blanks, commas or semicolons; '#' begins a comment. The first line that has
/// words may be a header: words, the first of which begins with a letter; quotes and brackets may surround them. A word
/// that begins as a number does, or is "nan", is a misspelt number and not the name of a column.
class NumberLines {
 public:
  enum class Header { allowed, refused };
  /// Keeps references to both arguments, which must outlive this object. Skips a byte order mark at the beginning.
  NumberLines(const std::string& file, std::string_view text, Header header);

  /// Advances to the next line; returns false if there is none. Throws Error(invalid_input) with file, line and column
  /// if a word is not a finite number, if nothing stands between two separators, and if commas may be decimal ones, as
  /// blanks or semicolons separate numbers, too.
  [[nodiscard]] bool next();
  /// Numbers of this line; none if it is blank, a comment or the header.
  [[nodiscard]] const std::vector<double>& numbers() const { return numbers_; }
  /// Words of the header; none if there is no header.
  [[nodiscard]] const std::vector<std::string>& header() const { return header_; }
  /// Throws Error(invalid_input) with file and line: this line, or the given one.
  [[noreturn]] void fail(const std::string& problem) const { fail(problem, line_); }
  [[noreturn]] void fail(const std::string& problem, long line) const;
  [[nodiscard]] long header_line() const { return header_line_; }

 private:
  /// A word of a line with its column, counted from 1.
  struct Word {
    std::string_view text;
    std::size_t column;
  };
  void split(std::string_view line);
  [[nodiscard]] bool is_header() const;
  [[noreturn]] void refuse(const Word& word) const;
  [[noreturn]] void fail_at(std::size_t column, const std::string& problem) const;

  const std::string& file_;
  std::string_view rest_;
  bool may_be_header_;
  long line_ = 0, header_line_ = 0;
  std::vector<Word> words_;
  std::size_t decimal_comma_ = 0;  ///< column of a comma of this line that may be a decimal one; 0 if there is none
  std::vector<double> numbers_;
  std::vector<std::string> header_;
};

}  // namespace ricochet
