#include "ricochet/rigid/surface/surface_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>

#include "ricochet/base/error.hpp"
#include "ricochet/base/input_file.hpp"
#include "ricochet/base/number_lines.hpp"
#include "ricochet/base/text.hpp"

namespace ricochet {

namespace {

constexpr int header_of_stl = 80;  ///< bytes of the binary format without a meaning

[[noreturn]] void refuse(const std::string& where, const std::string& problem) {
  throw Error(ErrorKind::invalid_input, where + ": " + problem);
}

bool same(std::string_view a, std::string_view b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](char x, char y) {
           return (x >= 'A' && x <= 'Z' ? x - 'A' + 'a' : x) == y;
         });
}

void expect(TextWords& words, std::string_view word) {
  const std::string_view found = words.next();
  if (!same(found, word)) words.fail(fmt::format("expected \"{}\" but found \"{}\"", word, shown_word(found)));
}

/// Normals are not used, and those of triangles without area may be "nan"; any other word that is not a number is an
/// error.
void skip_normal(TextWords& words) {
  for (int k = 0; k < 3; ++k) {
    const std::string_view word = words.next();
    const bool is_nan = is_like_number(word) && word.find_first_of("nN") != std::string_view::npos;
    if (!is_nan && !number_in(word)) words.fail(fmt::format("\"{}\" is not a component of a normal", shown_word(word)));
  }
}

SurfaceFacets read_text(const std::string& file, const std::string& text, double scale) {
  TextWords words(file, text);
  SurfaceFacets result;
  expect(words, "solid");
  words.skip_line();
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    if (same(word, "endsolid") || same(word, "solid")) {
      words.skip_line();
      continue;
    }
    if (!same(word, "facet")) words.fail("expected \"facet\" or \"endsolid\"");
    expect(words, "normal");
    skip_normal(words);
    expect(words, "outer");
    expect(words, "loop");
    std::array<Eigen::Vector3d, 3> corners;
    for (Eigen::Vector3d& corner : corners) {
      expect(words, "vertex");
      for (double& x : corner) x = scale * words.number();
    }
    expect(words, "endloop");
    expect(words, "endfacet");
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
    refuse(
        file,
        fmt::format(
            "the file ends before the {} triangles that it announces ({} bytes): it is truncated, or not an STL file",
            count, bytes.size()));
  }
  SurfaceFacets result;
  result.corners.resize(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    std::array<float, 9> numbers{};
    std::memcpy(numbers.data(), bytes.data() + binary_header + binary_triangle * i + 12, sizeof numbers);
    for (std::size_t k = 0; k < 9; ++k) {
      if (!std::isfinite(numbers[k])) refuse(file, fmt::format("triangle {} has a corner that is not finite", i + 1));
      result.corners[i][k / 3][static_cast<Eigen::Index>(k % 3)] = scale * double(numbers[k]);
    }
  }
  return result;
}

}  // namespace

/// Binary files may begin with "solid", too: their size distinguishes them.
SurfaceFacets read_stl(const std::string& file, double scale) {
  const std::string bytes = read_input(file, "surface", header_of_stl);
  const bool is_binary = bytes.size() == binary_header + binary_triangle * std::size_t{count_of_binary(bytes)};
  const bool begins_as_text = same(std::string_view(bytes).substr(0, 5), "solid");
  SurfaceFacets result = is_binary || !begins_as_text ? read_binary(file, bytes, scale) : read_text(file, bytes, scale);
  if (result.corners.empty()) refuse(file, "it contains no triangles");
  return result;
}

SurfaceFacets read_polygons(const std::string& file, double scale) {
  const std::string text = read_input(file, "surface");
  SurfaceFacets result;
  result.in_space = false;
  std::optional<Eigen::Vector3d> before;
  NumberLines lines(file, text, NumberLines::Header::refused);
  while (lines.next()) {
    const std::vector<double>& numbers = lines.numbers();
    if (numbers.empty()) {
      before.reset();
      continue;
    }
    if (numbers.size() != 2)
      lines.fail(fmt::format("a line of a polygon must have two numbers, x and y of a corner; this one has {}",
                             numbers.size()));
    const Eigen::Vector3d corner(scale * numbers[0], scale * numbers[1], 0.0);
    if (before) result.corners.push_back({*before, corner, corner});
    before = corner;
  }
  if (result.corners.empty()) refuse(file, "it contains no polygon: each line must have x and y of a corner");
  return result;
}

}  // namespace ricochet
