#pragma once

#include <concepts>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// @file Small helpers for messages.
namespace ricochet {

/// The candidate nearest to `word` by edit distance (transpositions count one), or "" when none is near enough to be
/// what was meant (more than max(2, length/3) edits away, or as many as the word has letters). Names of as many parts
/// between dots must be near in each part: "foot.gap" is not "top.gap".
std::string nearest_name(std::string_view word, std::span<const std::string> candidates);

/// What stands between this beginning and this end; none where the text has another form.
std::optional<std::string_view> between(std::string_view text, std::string_view begin, std::string_view end);
/// Of a message: every number that stands alone, and not within quotes, is 0. Two that say the same of different places
/// have the same form.
std::string form_of(std::string_view message);

/// Decimal digits alone, at least so many and at most so many.
bool is_digits(std::string_view text, std::size_t least, std::size_t most = std::string_view::npos);

/// The finite number that a text is: decimal, with one sign at most and nothing else around it. None for "0.0m", "+-1",
/// "1,5", "nan" and "inf".
std::optional<double> number_in(std::string_view text);
/// Whether a word can only be meant as a number, well spelt or not: it begins as numbers do, or is "nan" or "inf" of
/// any spelling. Names of columns are not.
bool is_like_number(std::string_view word);

/// "a", "a or b", "a, b or c"; with quotes around each when `quoted`.
std::string join_names(std::span<const std::string> names, std::string_view last_separator = " and ",
                       bool quoted = true);

/// "1 node", "2 nodes"; `plural` where that is more than an s behind the noun.
std::string counted(std::integral auto count, std::string_view noun, std::string_view plural = {}) {
  std::string text = std::to_string(count) + " ";
  text += count == 1 || plural.empty() ? noun : plural;
  return count != 1 && plural.empty() ? text + "s" : text;
}

}  // namespace ricochet
