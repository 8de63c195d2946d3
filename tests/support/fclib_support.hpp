#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "ricochet/fclib/fclib_file.hpp"
#include "ricochet/hdf5/hdf5_file.hpp"
#include "support/errors.hpp"
#include "support/uniform.hpp"

/// @file FCLib files for tests: complete ones, and ones written entry by entry, so that each entry can be wrong.
namespace ricochet::test_support {

struct TemporaryFile {
  std::string path;
  TemporaryFile() {
    static int count = 0;
    path = (std::filesystem::temp_directory_path() /
            ("ricochet-fclib-" + std::to_string(getpid()) + "-" + std::to_string(++count) + ".hdf5"))
               .string();
  }
  ~TemporaryFile() { std::filesystem::remove(path); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
};

inline std::string contents(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

inline Matrix random_operator(Index size, std::mt19937& random) {
  Matrix square(size, size);
  for (Index j = 0; j < size; ++j) square.col(j) = uniform(size, random);
  Matrix result = square * square.transpose();
  result.diagonal().array() += 0.1;
  result.triangularView<Eigen::StrictlyUpper>() = result.transpose();
  return result;
}

/// Returns a problem in which every field is filled.
inline FclibProblem example(Index dimension, Index points, Index constraints) {
  std::mt19937 random(7);
  const Index rows = dimension * points;
  // A positive semidefinite matrix [W, V; Vᵀ, R], as an assembly of bodies and joints has it.
  const Matrix whole = random_operator(rows + constraints, random);
  FclibProblem result;
  result.dimension = dimension;
  result.w = Matrix(whole.topLeftCorner(rows, rows)).sparseView();
  result.v = Matrix(whole.topRightCorner(rows, constraints)).sparseView();
  result.r = Matrix(whole.bottomRightCorner(constraints, constraints)).sparseView();
  result.q = uniform(rows, random);
  result.mu = uniform(points, random).cwiseAbs();
  result.s = uniform(constraints, random);
  result.title = "a title";
  result.description = "a description\nof two lines, with an ü";
  result.math_info = "positive definite";
  for (Index i = 0; i < points; ++i) result.points.push_back(3 * i + 1);
  result.q_rounding = 1e-16 * uniform(rows, random).cwiseAbs();
  result.solution = FclibSolution{uniform(rows, random), uniform(rows, random), uniform(constraints, random)};
  result.guesses.push_back({uniform(rows, random), uniform(rows, random), uniform(constraints, random)});
  result.guesses.push_back({uniform(rows, random), uniform(rows, random), uniform(constraints, random)});
  return result;
}

inline bool same(const SparseMatrix& a, const SparseMatrix& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() && Matrix(a) == Matrix(b);
}

inline bool same(const Vector& a, const Vector& b) { return a.size() == b.size() && a == b; }

inline bool same(const FclibSolution& a, const FclibSolution& b) {
  return same(a.motion, b.motion) && same(a.reaction, b.reaction) && same(a.multiplier, b.multiplier);
}

/// Compares bit for bit.
inline bool same(const FclibProblem& a, const FclibProblem& b) {
  if (a.guesses.size() != b.guesses.size() || a.solution.has_value() != b.solution.has_value()) return false;
  for (std::size_t k = 0; k < a.guesses.size(); ++k) {
    if (!same(a.guesses[k], b.guesses[k])) return false;
  }
  if (a.solution && !same(*a.solution, *b.solution)) return false;
  return a.dimension == b.dimension && same(a.w, b.w) && same(a.v, b.v) && same(a.r, b.r) && same(a.q, b.q) &&
         same(a.mu, b.mu) && same(a.s, b.s) && a.title == b.title && a.description == b.description &&
         a.math_info == b.math_info && a.points == b.points && same(a.q_rounding, b.q_rounding);
}

/// The data sets of a file by name. Groups are made as needed.
struct Raw {
  std::map<std::string, std::vector<int>> integers;
  std::map<std::string, std::vector<double>> reals;
  std::map<std::string, std::string> texts;
  std::vector<std::string> groups;

  void write(const std::string& path) const {
    Hdf5Writer file(path);
    std::vector<std::string> made;
    const auto make = [&](const std::string& name) {
      for (std::size_t end = name.find('/', 1); end != std::string::npos; end = name.find('/', end + 1)) {
        const std::string group = name.substr(0, end);
        if (std::ranges::find(made, group) != made.end()) continue;
        file.group(group);
        made.push_back(group);
      }
    };
    for (const std::string& group : groups) make(group + "/");
    for (const auto& [name, values] : integers) {
      make(name);
      file.integers(name, values.data(), Index(values.size()));
    }
    for (const auto& [name, values] : reals) {
      make(name);
      file.reals(name, values.data(), Index(values.size()));
    }
    for (const auto& [name, value] : texts) {
      make(name);
      file.text(name, value);
    }
    file.close();
  }
};

/// One point in two dimensions, W = [2 1; 1 3] in five triplets, no constraints.
inline Raw raw_example() {
  Raw raw;
  raw.integers = {{"/fclib_local/spacedim", {2}},
                  {"/fclib_local/W/nzmax", {5}},
                  {"/fclib_local/W/m", {2}},
                  {"/fclib_local/W/n", {2}},
                  {"/fclib_local/W/nz", {5}},
                  {"/fclib_local/W/p", {0, 0, 1, 1, 1}},
                  {"/fclib_local/W/i", {0, 1, 0, 1, 1}}};
  raw.reals = {{"/fclib_local/W/x", {2.0, 1.0, 1.0, 3.0, 0.0}},
               {"/fclib_local/vectors/q", {-1.0, 0.5}},
               {"/fclib_local/vectors/mu", {0.3}}};
  return raw;
}

}  // namespace ricochet::test_support
