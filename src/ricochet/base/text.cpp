#include "ricochet/base/text.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

namespace ricochet {

namespace {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> cost(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) cost[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) cost[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substitution = cost[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      cost[i][j] = std::min({cost[i - 1][j] + 1, cost[i][j - 1] + 1, substitution});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        cost[i][j] = std::min(cost[i][j], cost[i - 2][j - 2] + 1);
      }
    }
  }
  return cost[a.size()][b.size()];
}

/// Number of edits between a word and the one it may be meant to be; none if they are too far apart. Every one-letter
/// word is one edit away from every other: to be near, some of the word must remain.
std::optional<std::size_t> near_distance(std::string_view word, std::string_view candidate) {
  if (word == candidate) return 0;
  if (word.empty()) return std::nullopt;
  const std::size_t most = std::min(std::max<std::size_t>(2, word.size() / 3), word.size() - 1);
  const std::size_t distance = edit_distance(word, candidate);
  return distance <= most ? std::optional(distance) : std::nullopt;
}

/// Compares part by part: a part that is too far off is not compensated by the length of another.
std::optional<std::size_t> dotted_distance(std::string_view word, std::string_view candidate) {
  if (std::ranges::count(word, '.') != std::ranges::count(candidate, '.')) return near_distance(word, candidate);
  std::size_t sum = 0;
  while (true) {
    const std::size_t dot = word.find('.'), other_dot = candidate.find('.');
    const std::optional<std::size_t> part = near_distance(word.substr(0, dot), candidate.substr(0, other_dot));
    if (!part) return std::nullopt;
    sum += *part;
    if (dot == std::string_view::npos) return sum;
    word.remove_prefix(dot + 1);
    candidate.remove_prefix(other_dot + 1);
  }
}

}  // namespace

std::string nearest_name(std::string_view word, std::span<const std::string> candidates) {
  const std::string* best = nullptr;
  std::size_t best_distance = 0;
  for (const std::string& candidate : candidates) {
    const std::optional<std::size_t> distance = dotted_distance(word, candidate);
    if (!distance || (best != nullptr && *distance >= best_distance)) continue;
    best_distance = *distance;
    best = &candidate;
  }
  return best != nullptr ? *best : "";
}

std::optional<std::string_view> between(std::string_view text, std::string_view begin, std::string_view end) {
  if (text.size() < begin.size() + end.size() || !text.starts_with(begin) || !text.ends_with(end)) return std::nullopt;
  return text.substr(begin.size(), text.size() - begin.size() - end.size());
}

std::string message_pattern(std::string_view message) {
  const auto is_any_of = [](char c, std::string_view these) { return these.find(c) != std::string_view::npos; };
  constexpr std::string_view digits = "0123456789";
  std::string form;
  bool in_quotes = false;
  for (std::size_t i = 0; i < message.size(); ++i) {
    const char c = message[i];
    if (c == '"') in_quotes = !in_quotes;
    const bool in_word = i > 0 && (std::isalnum(static_cast<unsigned char>(message[i - 1])) || message[i - 1] == '_');
    if (in_quotes || in_word || !is_any_of(c, "0123456789-")) {
      form += c;
      continue;
    }
    std::size_t end = i + 1;
    while (end < message.size() &&
           (is_any_of(message[end], "0123456789.e") || (is_any_of(message[end], "+-") && message[end - 1] == 'e')))
      ++end;
    const bool is_number = is_any_of(c, digits) || end > i + 1;
    // A full stop belongs to the sentence.
    while (end > i + 1 && !is_any_of(message[end - 1], digits)) --end;
    form += is_number ? '0' : c;
    i = end - 1;
  }
  return form;
}

bool is_digits(std::string_view text, std::size_t least, std::size_t most) {
  const bool digits = text.find_first_not_of("0123456789") == std::string_view::npos;
  return digits && text.size() >= least && text.size() <= most;
}

std::optional<double> number_in(std::string_view text) {
  if (text.starts_with('+')) {  // from_chars does not accept it
    text.remove_prefix(1);
    if (text.starts_with('-')) return std::nullopt;
  }
  double value = 0.0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

bool is_like_number(std::string_view word) {
  if (word.empty()) return false;
  if (std::string_view("+-.,0123456789").find(word.front()) != std::string_view::npos) return true;
  std::string start;
  for (const char c : word) start += char(std::tolower(static_cast<unsigned char>(c)));
  return start == "nan" || start.starts_with("nan(") || start == "inf" || start == "infinity";
}

std::string join_names(std::span<const std::string> names, std::string_view last_separator, bool quoted) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += (i + 1 == names.size()) ? std::string(last_separator) : ", ";
    text += quoted ? "\"" + names[i] + "\"" : names[i];
  }
  return text;
}

}  // namespace ricochet
