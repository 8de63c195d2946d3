#include "ricochet/contact/surface/surface_file.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <optional>
#include <sstream>

#include "ricochet/base/error.hpp"
#include "ricochet/base/input_file.hpp"

namespace ricochet {

namespace {

constexpr int header_of_stl = 80;  ///< bytes of the binary format that mean nothing

std::string contents(const std::string& file, int header = 0) {
  const std::string why_not = why_no_input(file, header);
  std::ifstream stream;
  if (why_not.empty()) stream.open(file, std::ios::binary);
  if (!why_not.empty() || !stream.is_open())
    throw Error(ErrorKind::file_access,
                fmt::format("cannot read the surface \"{}\": {}", file, why_not.empty() ? "no such file" : why_not));
  std::ostringstream text;
  text << stream.rdbuf();
  if (stream.bad()) throw Error(ErrorKind::file_access, fmt::format("cannot read the surface \"{}\" to its end", file));
  return std::move(text).str();
}

[[noreturn]] void refuse(const std::string& where, const std::string& problem) {
  throw Error(ErrorKind::invalid_input, where + ": " + problem);
}

/// Words of a text with the line that each is in.
class Words {
 public:
  Words(const std::string& file, const std::string& text)
      : file_(file), at_(text.data()), end_(text.data() + text.size()) {}

  /// The next word; empty at the end.
  std::string_view next() {
    while (at_ != end_ && (*at_ == ' ' || *at_ == '\t' || *at_ == '\r' || *at_ == '\n')) {
      if (*at_ == '\n') ++line_;
      ++at_;
    }
    const char* const first = at_;
    while (at_ != end_ && *at_ != ' ' && *at_ != '\t' && *at_ != '\r' && *at_ != '\n') ++at_;
    return {first, static_cast<std::size_t>(at_ - first)};
  }
  void skip_line() {
    while (at_ != end_ && *at_ != '\n') ++at_;
  }
  void expect(std::string_view word) {
    const std::string_view found = next();
    if (!same(found, word)) fail(fmt::format("expected \"{}\" but found \"{}\"", word, shown(found)));
  }
  double number() {
    const std::string_view word = next();
    double value = 0.0;
    const char* const first = word.starts_with('+') ? word.data() + 1 : word.data();
    const auto [rest, error] = std::from_chars(first, word.data() + word.size(), value);
    if (error != std::errc() || rest != word.data() + word.size() || word.empty() || !std::isfinite(value))
      fail(fmt::format("\"{}\" is no finite number", shown(word)));
    return value;
  }
  [[noreturn]] void fail(const std::string& problem) const { refuse(fmt::format("{}:{}", file_, line_), problem); }
  static bool same(std::string_view a, std::string_view b) {
    return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](char x, char y) {
             return (x >= 'A' && x <= 'Z' ? x - 'A' + 'a' : x) == y;
           });
  }

 private:
  static std::string shown(std::string_view word) {
    if (word.empty()) return "the end of the file";
    constexpr std::size_t most = 40;
    return std::string(word.substr(0, most)) + (word.size() > most ? "…" : "");
  }
  const std::string& file_;
  const char *at_, *end_;
  int line_ = 1;
};

SurfaceFacets read_text(const std::string& file, const std::string& text, double scale) {
  Words words(file, text);
  SurfaceFacets result;
  words.expect("solid");
  words.skip_line();
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    if (Words::same(word, "endsolid") || Words::same(word, "solid")) {
      words.skip_line();
      continue;
    }
    if (!Words::same(word, "facet")) words.fail("expected \"facet\" or \"endsolid\"");
    words.expect("normal");
    for (int k = 0; k < 3; ++k) (void)words.next();
    words.expect("outer");
    words.expect("loop");
    std::array<Eigen::Vector3d, 3> corners;
    for (Eigen::Vector3d& corner : corners) {
      words.expect("vertex");
      for (double& x : corner) x = scale * words.number();
    }
    words.expect("endloop");
    words.expect("endfacet");
    result.corners.push_back(corners);
  }
  return result;
}

constexpr std::size_t binary_header = 84, binary_triangle = 50;

std::uint32_t count_of_binary(const std::string& bytes) {
  std::uint32_t count = 0;
  if (bytes.size() >= binary_header) std::memcpy(&count, bytes.data() + 80, sizeof count);
  return count;
}

SurfaceFacets read_binary(const std::string& file, const std::string& bytes, double scale) {
  const std::uint32_t count = count_of_binary(bytes);
  if (bytes.size() < binary_header || (bytes.size() - binary_header) / binary_triangle < count) {
    refuse(file, fmt::format("the file ends before the {} triangles that it announces ({} bytes): it is cut off, or no "
                             "STL",
                             count, bytes.size()));
  }
  SurfaceFacets result;
  result.corners.resize(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    std::array<float, 9> numbers{};
    std::memcpy(numbers.data(), bytes.data() + binary_header + binary_triangle * i + 12, sizeof numbers);
    for (std::size_t k = 0; k < 9; ++k) {
      if (!std::isfinite(numbers[k])) refuse(file, fmt::format("triangle {} has a corner that is not finite", i + 1));
      result.corners[i][k / 3][static_cast<Eigen::Index>(k % 3)] = scale * static_cast<double>(numbers[k]);
    }
  }
  return result;
}

}  // namespace

/// Binary files may begin with "solid", too: their size tells.
SurfaceFacets read_stl(const std::string& file, double scale) {
  const std::string bytes = contents(file, header_of_stl);
  const bool is_binary = bytes.size() == binary_header + binary_triangle * std::size_t{count_of_binary(bytes)};
  const bool begins_as_text = Words::same(std::string_view(bytes).substr(0, 5), "solid");
  SurfaceFacets result = is_binary || !begins_as_text ? read_binary(file, bytes, scale) : read_text(file, bytes, scale);
  if (result.corners.empty()) refuse(file, "there are no triangles in it");
  return result;
}

SurfaceFacets read_polygons(const std::string& file, double scale) {
  std::istringstream stream(contents(file));
  SurfaceFacets result;
  result.in_space = false;
  std::optional<Eigen::Vector3d> before;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    line.resize(std::min(line.size(), line.find('#')));
    for (char& c : line) {
      if (c == ',' || c == ';') c = ' ';
    }
    Words words(file, line);
    const std::string_view first = words.next();
    if (first.empty()) {
      before.reset();
      continue;
    }
    Eigen::Vector3d corner(0.0, 0.0, 0.0);
    Words numbers(file, line);
    try {
      corner[0] = scale * numbers.number();
      corner[1] = scale * numbers.number();
    } catch (const Error&) {
      refuse(fmt::format("{}:{}", file, number), "a line of a polygon has two numbers, x and y of a corner");
    }
    if (!numbers.next().empty())
      refuse(fmt::format("{}:{}", file, number), "a line of a polygon has two numbers; this one has more");
    if (before) result.corners.push_back({*before, corner, corner});
    before = corner;
  }
  if (result.corners.empty()) refuse(file, "there is no polygon in it: x and y of a corner in each line");
  return result;
}

}  // namespace ricochet
