#include "ricochet/mesh/msh_cursor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "ricochet/base/error.hpp"

namespace ricochet::gmsh {

namespace {

bool is_space(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }

/// Returns a token in printable form for messages.
std::string printable(std::string_view token) {
  std::string text;
  for (const char c : token.substr(0, 30)) text += (c >= ' ' && c <= '~') ? c : '?';
  return token.size() > 30 ? text + "…" : text;
}

}  // namespace

void Cursor::skip_space() {
  while (position_ != end_ && is_space(*position_)) ++position_;
}

std::string_view Cursor::line() {
  const char* start = position_;
  const char* stop = std::find(start, end_, '\n');
  position_ = stop == end_ ? end_ : stop + 1;
  if (stop != start && *(stop - 1) == '\r') --stop;
  return {start, std::size_t(stop - start)};
}

void Cursor::fail(const std::string& message) const {
  if (binary_)
    throw Error(ErrorKind::invalid_input, fmt::format("{}: byte {}: {}", source_, position_ - begin_, message));
  const auto line = std::count(begin_, position_, '\n') + 1;
  throw Error(ErrorKind::invalid_input, fmt::format("{}:{}: {}", source_, line, message));
}

void check_room(const Cursor& cursor, std::uint64_t count, std::size_t bytes_each, const char* what) {
  if (count <= cursor.remaining() / bytes_each) return;
  cursor.fail(
      fmt::format("{} is {}, which the remaining {} bytes of the file cannot hold; the file is truncated or damaged",
                  what, count, cursor.remaining()));
}

void TextReader::end_record() {
  skip_blanks();
  const char* position = cursor_.position();
  if (position != cursor_.end() && *position == '\r') ++position;
  if (position == cursor_.end()) return;
  if (*position != '\n') {
    const std::string_view extra = cursor_.rest().substr(0, cursor_.rest().find_first_of(" \t\r\n"));
    cursor_.fail(fmt::format("the line should end before \"{}\"", printable(extra)));
  }
  cursor_.move_to(position + 1);
}

double TextReader::number(const char* what) {
  skip_blanks();
  const char* start = cursor_.position();
  if (start != cursor_.end() && *start == '+') {  // from_chars does not accept it
    ++start;
    if (start != cursor_.end() && *start == '-') fail_token(what, "a number");
  }
  double value = 0.0;
  const auto [next, error] = std::from_chars(start, cursor_.end(), value);
  if (error == std::errc::result_out_of_range) {
    value = std::strtod(std::string(start, next).c_str(), nullptr);  // ±infinity, or the number nearest to a tiny one
  } else if (error != std::errc{}) {
    fail_token(what, "a number");
  }
  if (!ends_token(next)) fail_token(what, "a number");
  cursor_.move_to(next);
  return value;
}

std::size_t TextReader::count(const char* what, std::size_t text_bytes_each, std::size_t /*binary_bytes_each*/) {
  const std::int64_t value = integer64(what);
  if (value < 0) cursor_.fail(fmt::format("{} is negative ({})", what, value));
  check_room(cursor_, std::uint64_t(value), text_bytes_each, what);
  return std::size_t(value);
}

int TextReader::narrow(std::int64_t value, const char* what) const {
  if (value < std::numeric_limits<int>::min() || value > std::numeric_limits<int>::max()) {
    cursor_.fail(fmt::format("{} is {}, which is out of range", what, value));
  }
  return int(value);
}

void TextReader::fail_token(const char* what, const char* kind) const {
  const std::string_view rest = cursor_.rest();
  const std::string_view token = rest.substr(0, rest.find_first_of(" \t\r\n"));
  if (rest.empty()) cursor_.fail(fmt::format("the file ends where {} should be; it is truncated", what));
  if (token.empty()) cursor_.fail(fmt::format("the line ends where {} should be", what));
  cursor_.fail(fmt::format("found \"{}\" where {} should be; it is not {}", printable(token), what, kind));
}

std::size_t BinaryReader::count(const char* what, std::size_t /*text_bytes_each*/, std::size_t binary_bytes_each) {
  const auto value = read<std::uint64_t>(what);
  check_room(cursor_, value, binary_bytes_each, what);
  return std::size_t(value);
}

void BinaryReader::fail_end(const char* what) const {
  cursor_.fail(fmt::format("the file ends where {} should be; it is truncated", what));
}

}  // namespace ricochet::gmsh
