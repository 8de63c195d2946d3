#pragma once

#include <concepts>
#include <optional>
#include <span>
#include <string>
#include <string_view>

/// @file Small helpers for messages.
namespace ricochet {

/// Returns the candidate nearest to `word` by edit distance (a transposition counts one), or "" if none is near enough
/// to be the intended one (more than max(2, length/3) edits away, or as many as the word has letters). Names with the
/// same number of parts between dots must be near in each part: "foot.gap" is not near "top.gap".
std::string nearest_name(std::string_view word, std::span<const std::string> candidates);

/// Returns the text between this beginning and this end; none if the text has another form.
std::optional<std::string_view> between(std::string_view text, std::string_view begin, std::string_view end);
/// Returns a message with every number replaced by 0 that stands alone and is not within quotes. Messages about the
/// same problem at different positions have the same form.
std::string message_pattern(std::string_view message);

/// Returns whether a text consists of decimal digits, from `least` to `most` of them.
bool is_digits(std::string_view text, std::size_t least, std::size_t most = std::string_view::npos);

/// Returns the finite number that a text represents: decimal, with at most one sign and nothing else around it. None
/// for "0.0m", "+-1", "1,5", "nan" and "inf".
std::optional<double> number_in(std::string_view text);
/// Returns whether a word can only be meant as a number, well spelt or not: it begins as numbers do, or is "nan" or
/// "inf" in any spelling. Names of columns are not.
bool is_like_number(std::string_view word);

/// Returns "a", "a or b", "a, b or c"; with quotes around each if `quoted`.
std::string join_names(std::span<const std::string> names, std::string_view last_separator = " and ",
                       bool quoted = true);

/// Returns "1 node", "2 nodes"; `plural` is given if it is more than the noun with an s.
std::string counted(std::integral auto count, std::string_view noun, std::string_view plural = {}) {
  std::string text = std::to_string(count) + " ";
  text += count == 1 || plural.empty() ? noun : plural;
  return count != 1 && plural.empty() ? text + "s" : text;
}

}  // namespace ricochet
