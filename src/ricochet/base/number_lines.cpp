#include "ricochet/base/number_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <utility>

#include "ricochet/base/error.hpp"
#include "ricochet/base/text.hpp"

namespace ricochet {

namespace {

constexpr std::string_view blanks = " \t\r\n\v\f";

bool is_one_of(char c, std::string_view these) { return these.find(c) != std::string_view::npos; }

/// Returns whether c is an ASCII letter or a byte of a character outside ASCII.
bool is_letter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0 || static_cast<unsigned char>(c) >= 0x80;
}

[[noreturn]] void refuse_at(const std::string& file, long line, std::size_t column, const std::string& problem) {
  throw Error(ErrorKind::invalid_input, fmt::format("{}:{}:{}: {}", file, line, column, problem));
}

}  // namespace

std::string shown_word(std::string_view word) {
  if (word.empty()) return "the end of the file";
  constexpr std::size_t most = 40;
  std::size_t size = std::min(word.size(), most);
  while (size < word.size() && (static_cast<unsigned char>(word[size]) & 0xC0U) == 0x80U) --size;  // inside a character
  std::string text;
  for (const char c : word.substr(0, size)) text += (static_cast<unsigned char>(c) < ' ' || c == '\x7f') ? '?' : c;
  return word.size() > size ? text + "…" : text;
}

TextWords::TextWords(const std::string& file, std::string_view text)
    : file_(file), at_(text.data()), end_(text.data() + text.size()), line_begin_(at_), word_(at_) {}

std::string_view TextWords::next() {
  for (; at_ != end_ && is_one_of(*at_, blanks); ++at_) {
    if (*at_ != '\n') continue;
    ++line_;
    line_begin_ = at_ + 1;
  }
  word_ = at_;
  while (at_ != end_ && !is_one_of(*at_, blanks)) ++at_;
  return {word_, std::size_t(at_ - word_)};
}

void TextWords::skip_line() { at_ = std::find(at_, end_, '\n'); }

double TextWords::number() {
  const std::string_view word = next();
  const std::optional<double> value = number_in(word);
  if (!value) fail(fmt::format("\"{}\" is not a finite number", shown_word(word)));
  return *value;
}

void TextWords::fail(const std::string& problem) const {
  refuse_at(file_, line_, std::size_t(word_ - line_begin_) + 1, problem);
}

NumberLines::NumberLines(const std::string& file, std::string_view text, Header header)
    : file_(file), rest_(text), may_be_header_(header == Header::allowed) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (rest_.starts_with(byte_order_mark)) rest_.remove_prefix(byte_order_mark.size());
}

bool NumberLines::next() {
  if (rest_.empty()) return false;
  const std::size_t end = std::min(rest_.find('\n'), rest_.size());
  const std::string_view line = rest_.substr(0, end);
  rest_.remove_prefix(std::min(end + 1, rest_.size()));
  ++line_;
  numbers_.clear();
  split(line);
  if (words_.empty()) return true;
  const bool is_first = std::exchange(may_be_header_, false);
  if (is_first && is_header()) {
    for (const Word& word : words_) header_.emplace_back(word.text);
    header_line_ = line_;
    return true;
  }
  if (decimal_comma_ > 0)
    fail_at(decimal_comma_, "commas and blanks in one line: use decimal points and one kind of separator");
  for (const Word& word : words_) {
    const std::optional<double> value = number_in(word.text);
    if (!value) refuse(word);
    numbers_.push_back(*value);
  }
  return true;
}

/// Splits a line into words. A separator may follow the last word, but not precede the first or another separator.
void NumberLines::split(std::string_view line) {
  words_.clear();
  line = line.substr(0, line.find('#'));
  if (line.find(',') != std::string_view::npos && line.find(';') != std::string_view::npos)
    fail_at(line.find(',') + 1, "commas and semicolons in one line: use decimal points and one kind of separator");
  bool wants_word = true;  // a separator here would have nothing before it
  bool has_blanks = false;
  std::size_t tight_comma = 0;  // column of a comma between two characters that are not blanks
  for (std::size_t at = 0; at < line.size();) {
    if (is_one_of(line[at], blanks)) {
      ++at;
    } else if (is_one_of(line[at], ",;")) {
      if (wants_word) fail_at(at + 1, fmt::format("a number is missing before this \"{}\"", line[at]));
      wants_word = true;
      if (line[at++] == ',' && at < line.size() && !is_one_of(line[at], blanks) && !is_one_of(line[at - 2], blanks))
        tight_comma = at;
    } else {
      const std::size_t end = std::min(line.find_first_of(" \t\r\v\f,;", at), line.size());
      has_blanks |= !wants_word;
      words_.push_back({line.substr(at, end - at), at + 1});
      wants_word = false;
      at = end;
    }
  }
  decimal_comma_ = has_blanks ? tight_comma : 0;
}

/// Returns whether the words form a header: the first begins with a letter and may be quoted, and none is a number
/// behind quotes, brackets or a typographical minus, which would be a number that cannot be read.
bool NumberLines::is_header() const {
  const auto bare = [](std::string_view text) {
    constexpr std::string_view minus = "\xE2\x88\x92";
    while (!text.empty() && is_one_of(text.front(), "\"'([{")) text.remove_prefix(1);
    return text.starts_with(minus) ? text.substr(minus.size()) : text;
  };
  const std::string_view first = bare(words_.front().text);
  return !first.empty() && !is_like_number(first) && is_letter(first.front()) &&
         std::ranges::none_of(words_, [&](const Word& word) { return is_like_number(bare(word.text)); });
}

void NumberLines::refuse(const Word& word) const {
  fail_at(word.column, fmt::format("\"{}\" is not a finite number; a line contains only numbers, such as 1.5e-3, "
                                   "separated by blanks, commas or semicolons, and '#' begins a comment",
                                   shown_word(word.text)));
}

void NumberLines::fail_at(std::size_t column, const std::string& problem) const {
  refuse_at(file_, line_, column, problem);
}

void NumberLines::fail(const std::string& problem, long line) const {
  throw Error(ErrorKind::invalid_input, fmt::format("{}:{}: {}", file_, line, problem));
}

}  // namespace ricochet
