#pragma once

#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>

/// @file Reading numbers from the content of a .msh file. TextReader and BinaryReader have the same interface, so that
/// one template parses a format whose two encodings hold the same sequence of numbers. Private to mesh/.
namespace ricochet::gmsh {

/// The content and the reading position.
class Cursor {
 public:
  Cursor(std::string_view content, std::string source)
      : begin_(content.data()), position_(begin_), end_(begin_ + content.size()), source_(std::move(source)) {}

  const char* position() const { return position_; }
  const char* end() const { return end_; }
  void move_to(const char* position) { position_ = position; }
  std::size_t remaining() const { return std::size_t(end_ - position_); }
  std::string_view rest() const { return {position_, remaining()}; }
  bool binary() const { return binary_; }
  void set_binary() { binary_ = true; }
  const std::string& source() const { return source_; }

  /// Skips blanks and line ends.
  void skip_space();
  /// Returns the rest of the line without its end, and moves behind it.
  std::string_view line();
  /// Throws Error(invalid_input) that names the file and the line (ASCII) or the byte (binary) of the position.
  [[noreturn]] void fail(const std::string& message) const;

 private:
  const char* begin_;
  const char* position_;
  const char* end_;
  std::string source_;
  bool binary_ = false;
};

/// Numbers separated by blanks. Strict about lines: a record that is too short must not swallow the next one.
class TextReader {
 public:
  explicit TextReader(Cursor& cursor) : cursor_(cursor) {}

  void begin_record() { cursor_.skip_space(); }
  void end_record();
  int integer(const char* what) { return narrow(integer64(what), what); }
  std::int64_t integer64(const char* what);
  /// Reads the tag of a node or an element.
  std::int64_t tag(const char* what) { return integer64(what); }
  double number(const char* what);
  /// Reads a number of items of at least so many bytes each. Refuses it if the rest of the file cannot hold them, so
  /// that no absurd size is ever allocated.
  std::size_t count(const char* what, std::size_t text_bytes_each, std::size_t binary_bytes_each);
  Cursor& cursor() { return cursor_; }

 private:
  void skip_blanks();
  bool ends_token(const char* position) const;
  int narrow(std::int64_t value, const char* what) const;
  [[noreturn]] void fail_token(const char* what, const char* kind) const;

  Cursor& cursor_;
};

/// Numbers in the machine's own representation, without padding.
class BinaryReader {
 public:
  explicit BinaryReader(Cursor& cursor) : cursor_(cursor) {}

  void begin_record() {}
  void end_record() {}
  int integer(const char* what) { return read<std::int32_t>(what); }
  std::int64_t tag(const char* what);
  double number(const char* what) { return read<double>(what); }
  std::size_t count(const char* what, std::size_t text_bytes_each, std::size_t binary_bytes_each);
  Cursor& cursor() { return cursor_; }

 private:
  template <class T>
  T read(const char* what) {
    if (cursor_.remaining() < sizeof(T)) fail_end(what);
    T value;
    std::memcpy(&value, cursor_.position(), sizeof(T));
    cursor_.move_to(cursor_.position() + sizeof(T));
    return value;
  }
  [[noreturn]] void fail_end(const char* what) const;

  Cursor& cursor_;
};

/// Refuses `count` items of at least `bytes_each` bytes if the rest of the file cannot hold them.
void check_room(const Cursor& cursor, std::uint64_t count, std::size_t bytes_each, const char* what);

// The functions below are called for every number of the file, hence inline.

inline bool TextReader::ends_token(const char* position) const {
  return position == cursor_.end() || *position == ' ' || *position == '\n' || *position == '\r' || *position == '\t';
}

inline void TextReader::skip_blanks() {
  const char* position = cursor_.position();
  while (position != cursor_.end() && (*position == ' ' || *position == '\t')) ++position;
  cursor_.move_to(position);
}

inline std::int64_t TextReader::integer64(const char* what) {
  skip_blanks();
  std::int64_t value = 0;
  const auto [next, error] = std::from_chars(cursor_.position(), cursor_.end(), value);
  if (error != std::errc{} || !ends_token(next)) fail_token(what, "a whole number");
  cursor_.move_to(next);
  return value;
}

inline std::int64_t BinaryReader::tag(const char* what) {
  const auto value = read<std::uint64_t>(what);
  constexpr auto largest = std::uint64_t(std::numeric_limits<std::int64_t>::max());
  // Out of range is invalid; −1 is refused, with a message that names the tag, when nodes and elements are numbered.
  return value > largest ? -1 : std::int64_t(value);
}

}  // namespace ricochet::gmsh
