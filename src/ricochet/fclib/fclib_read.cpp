#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "ricochet/fclib/fclib_file.hpp"
#include "ricochet/hdf5/hdf5_file.hpp"

namespace ricochet {

namespace {

using Integers = std::vector<std::int64_t>;

/// Largest difference of W_ij and W_ji relative to √(W_ii W_jj).
constexpr double asymmetry_limit = 1e-8;

/// Reads a size or count: not negative, and small enough for the index of a sparse matrix.
std::int64_t read_count(const Hdf5Reader& file, const std::string& name) {
  const std::int64_t value = file.integer(name);
  if (value < 0) file.fail(name, fmt::format("is {}, but a count cannot be negative", value));
  if (value >= std::numeric_limits<int>::max()) file.fail(name, fmt::format("is {}, which is too large", value));
  return value;
}

void check_indices(const Hdf5Reader& file, const std::string& name, const Integers& indices, std::int64_t used,
                   std::int64_t end) {
  for (std::int64_t k = 0; k < used; ++k) {
    const std::int64_t index = indices[std::size_t(k)];
    if (index < 0 || index >= end)
      file.fail(name, fmt::format("entry {} is {}, outside the range 0 to {}", k, index, end - 1));
  }
}

/// Checks starts of compressed columns or rows: from 0, never falling, at most nzmax.
void check_starts(const Hdf5Reader& file, const std::string& name, const Integers& starts, std::int64_t limit) {
  if (starts.front() != 0) file.fail(name, fmt::format("starts with {} where 0 is expected", starts.front()));
  for (std::size_t k = 1; k < starts.size(); ++k) {
    if (starts[k] < starts[k - 1])
      file.fail(name, fmt::format("decreases from {} to {} at entry {}", starts[k - 1], starts[k], k));
    if (starts[k] > limit) file.fail(name, fmt::format("entry {} is {}, more than nzmax = {}", k, starts[k], limit));
  }
}

using Triplets = std::vector<Eigen::Triplet<double, int>>;

SparseMatrix assemble(const Triplets& entries, std::int64_t rows, std::int64_t columns) {
  SparseMatrix result(rows, columns);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

/// Returns the length of one of a matrix's data sets: count entries, or space for nzmax of them, of which the first
/// count are used. FCLib writes triplets of nz entries and compressed forms of nzmax; its older versions wrote nzmax
/// everywhere. It reads both.
std::int64_t stored_length(const Hdf5Reader& file, const std::string& name, std::int64_t count, std::int64_t limit) {
  const std::int64_t found = file.size(name);
  if (found != count && found != limit) {
    file.fail(name, count == limit
                        ? fmt::format("has {} entries where {} are expected", found, count)
                        : fmt::format("has {} entries where {}, or nzmax = {}, are expected", found, count, limit));
  }
  return found;
}

SparseMatrix read_triplets(const Hdf5Reader& file, const std::string& group, std::int64_t count, std::int64_t limit,
                           std::int64_t rows, std::int64_t columns) {
  if (count > limit) file.fail(group + "/nz", fmt::format("is {}, more than nzmax = {}", count, limit));
  const auto length = [&](const std::string& name) { return stored_length(file, name, count, limit); };
  const Integers row = file.integers(group + "/p", length(group + "/p"));
  const Integers column = file.integers(group + "/i", length(group + "/i"));
  const Vector value = file.leading_reals(group + "/x", count, length(group + "/x"));
  check_indices(file, group + "/p", row, count, rows);
  check_indices(file, group + "/i", column, count, columns);
  Triplets entries;
  entries.reserve(std::size_t(count));
  for (std::size_t k = 0; k < std::size_t(count); ++k)
    entries.emplace_back(int(row[k]), int(column[k]), value[Index(k)]);
  return assemble(entries, rows, columns);
}

/// Returns whether the entries of every column (row) are in order, each once.
bool is_sorted(const std::vector<int>& starts, const std::vector<int>& indices) {
  for (std::size_t k = 0; k + 1 < starts.size(); ++k) {
    const auto begin = indices.begin() + starts[k], end = indices.begin() + starts[k + 1];
    if (std::adjacent_find(begin, end, std::greater_equal<>()) != end) return false;
  }
  return true;
}

SparseMatrix read_compressed(const Hdf5Reader& file, const std::string& group, bool by_column, std::int64_t limit,
                             std::int64_t rows, std::int64_t columns) {
  const std::int64_t outer = by_column ? columns : rows;
  const Integers read_starts = file.integers(group + "/p", outer + 1);
  check_starts(file, group + "/p", read_starts, limit);
  const std::int64_t count = read_starts.back();
  const Integers read_indices = file.integers(group + "/i", stored_length(file, group + "/i", count, limit));
  const Vector value = file.leading_reals(group + "/x", count, stored_length(file, group + "/x", count, limit));
  check_indices(file, group + "/i", read_indices, count, by_column ? rows : columns);
  const std::vector<int> starts(read_starts.begin(), read_starts.end());
  const std::vector<int> indices(read_indices.begin(), read_indices.begin() + count);
  if (is_sorted(starts, indices)) {
    if (by_column)
      return Eigen::Map<const SparseMatrix>(rows, columns, count, starts.data(), indices.data(), value.data());
    return Eigen::Map<const SparseRowMatrix>(rows, columns, count, starts.data(), indices.data(), value.data());
  }
  Triplets entries;
  entries.reserve(indices.size());
  for (std::size_t k = 0; k + 1 < starts.size(); ++k) {
    for (int at = starts[k]; at < starts[k + 1]; ++at) {
      const int other = indices[std::size_t(at)], own = int(k);
      entries.emplace_back(by_column ? other : own, by_column ? own : other, value[at]);
    }
  }
  return assemble(entries, rows, columns);
}

SparseMatrix read_matrix(const Hdf5Reader& file, const std::string& group) {
  if (!file.has_group(group)) file.fail(group, "there is no such group");
  const std::int64_t limit = read_count(file, group + "/nzmax");
  const std::int64_t rows = read_count(file, group + "/m");
  const std::int64_t columns = read_count(file, group + "/n");
  const std::int64_t form = file.integer(group + "/nz");
  if (form < -2) {
    file.fail(group + "/nz", fmt::format("is {}; a number of triplets, -1 (compressed columns) or -2 (compressed rows) "
                                         "is expected",
                                         form));
  }
  SparseMatrix result = form >= 0 ? read_triplets(file, group, form, limit, rows, columns)
                                  : read_compressed(file, group, form == -1, limit, rows, columns);
  for (Index k = 0; k < result.nonZeros(); ++k) {
    // Finite entries at the same position may add up to infinity.
    if (!std::isfinite(result.valuePtr()[k])) file.fail(group + "/x", "has entries whose sum is not finite");
  }
  return result;
}

/// Returns the symmetric part; throws if the rest is more than rounding.
SparseMatrix symmetric_part(const Hdf5Reader& file, const std::string& group, const SparseMatrix& matrix) {
  const SparseMatrix transposed = matrix.transpose();
  const auto same = [&](const auto* a, const auto* b, Index count) { return std::equal(a, a + count, b); };
  if (same(matrix.outerIndexPtr(), transposed.outerIndexPtr(), matrix.cols() + 1) &&
      same(matrix.innerIndexPtr(), transposed.innerIndexPtr(), matrix.nonZeros()) &&
      same(matrix.valuePtr(), transposed.valuePtr(), matrix.nonZeros())) {
    return matrix;
  }
  const Vector diagonal = matrix.diagonal().cwiseAbs().cwiseSqrt();
  const SparseMatrix difference = matrix - transposed;
  double worst = 0.0;
  Index row = -1, column = -1;
  for (Index j = 0; j < difference.outerSize(); ++j) {
    for (SparseMatrix::InnerIterator entry(difference, j); entry; ++entry) {
      // Divided one after the other: a product of very small numbers would vanish.
      const double size = std::abs(entry.value()) / diagonal[entry.row()] / diagonal[j];
      if (entry.value() == 0.0 || size <= worst) continue;
      worst = size;
      row = std::min(entry.row(), j);  // the same of the two, independent of their order in the file
      column = std::max(entry.row(), j);
    }
  }
  if (worst == 0.0) return matrix;
  if (!(worst <= asymmetry_limit)) {
    file.fail(group, fmt::format("is not symmetric: the entry in row {0} and column {1} (counted from 0) is {2:.17g}, "
                                 "that in row {1} and column {0} is {3:.17g}",
                                 row, column, matrix.coeff(row, column), matrix.coeff(column, row)));
  }
  return 0.5 * matrix + 0.5 * transposed;
}

void read_constraints(const Hdf5Reader& file, FclibProblem& problem) {
  const bool has_v = file.has_group("/fclib_local/V"), has_r = file.has_group("/fclib_local/R");
  if (has_v != has_r)
    file.fail(has_v ? "/fclib_local/R" : "/fclib_local/V", "there is no such group; V and R must both be present");
  problem.v.resize(problem.w.rows(), 0);
  problem.r.resize(0, 0);
  problem.s.resize(0);
  if (!has_v) return;
  problem.v = read_matrix(file, "/fclib_local/V");
  const SparseMatrix r = read_matrix(file, "/fclib_local/R");
  if (r.rows() != r.cols()) file.fail("/fclib_local/R", fmt::format("has {} rows and {} columns", r.rows(), r.cols()));
  problem.r = symmetric_part(file, "/fclib_local/R", r);
  if (problem.v.rows() != problem.w.rows() || problem.v.cols() != r.rows()) {
    file.fail("/fclib_local/V", fmt::format("has {} rows and {} columns where {} (rows of W) and {} (rows of R) are "
                                            "expected",
                                            problem.v.rows(), problem.v.cols(), problem.w.rows(), r.rows()));
  }
  problem.s = file.reals("/fclib_local/vectors/s", r.rows());
}

void read_info(const Hdf5Reader& file, FclibProblem& problem) {
  const auto read = [&](const char* name, std::string& text) {
    const std::string path = std::string("/fclib_local/info/") + name;
    if (file.has_dataset(path)) text = file.text(path);
  };
  read("title", problem.title);
  read("description", problem.description);
  read("math_info", problem.math_info);
  const std::string points = "/fclib_local/info/points", rounding = "/fclib_local/info/q_rounding";
  if (file.has_dataset(points)) {
    const Integers numbers = file.integers(points, problem.point_count());
    problem.points.assign(numbers.begin(), numbers.end());
  }
  if (!file.has_dataset(rounding)) return;
  problem.q_rounding = file.reals(rounding, problem.w.rows());
  for (Index row = 0; row < problem.q_rounding.size(); ++row) {
    if (!(problem.q_rounding[row] >= 0.0))
      file.fail(rounding,
                fmt::format("entry {} is {}: the size of an error cannot be negative", row, problem.q_rounding[row]));
  }
}

FclibSolution read_solution(const Hdf5Reader& file, const std::string& group, const FclibProblem& problem) {
  FclibSolution result;
  result.motion = file.reals(group + "/u", problem.w.rows());
  result.reaction = file.reals(group + "/r", problem.w.rows());
  result.multiplier.resize(0);
  if (problem.constraint_count() > 0) result.multiplier = file.reals(group + "/l", problem.constraint_count());
  return result;
}

void read_solutions(const Hdf5Reader& file, FclibProblem& problem) {
  if (file.has_group("/solution")) problem.solution = read_solution(file, "/solution", problem);
  if (!file.has_group("/guesses")) return;
  const std::int64_t count = read_count(file, "/guesses/number_of_guesses");
  for (std::int64_t k = 1; k <= count; ++k) {
    const std::string group = fmt::format("/guesses/{}", k);
    if (!file.has_group(group))
      file.fail(group, fmt::format("there is no such group, but number_of_guesses is {}", count));
    problem.guesses.push_back(read_solution(file, group, problem));
  }
}

void read_local(const Hdf5Reader& file, FclibProblem& problem) {
  problem.dimension = file.integer("/fclib_local/spacedim");
  if (problem.dimension != 2 && problem.dimension != 3)
    file.fail("/fclib_local/spacedim", fmt::format("is {}; 2 or 3 is expected", problem.dimension));
  const SparseMatrix w = read_matrix(file, "/fclib_local/W");
  if (w.rows() != w.cols()) file.fail("/fclib_local/W", fmt::format("has {} rows and {} columns", w.rows(), w.cols()));
  if (w.rows() % problem.dimension != 0) {
    file.fail("/fclib_local/W",
              fmt::format("has {} rows, which is not a multiple of {} (spacedim)", w.rows(), problem.dimension));
  }
  problem.w = symmetric_part(file, "/fclib_local/W", w);
  Index negative = 0;
  if (w.rows() > 0 && problem.w.diagonal().minCoeff(&negative) < 0.0) {
    file.fail("/fclib_local/W", fmt::format("is not positive semi-definite: the entry in row and column {} (counted "
                                            "from 0) is {:.17g}",
                                            negative, problem.w.coeff(negative, negative)));
  }
  problem.q = file.reals("/fclib_local/vectors/q", w.rows());
  problem.mu = file.reals("/fclib_local/vectors/mu", w.rows() / problem.dimension);
  for (Index i = 0; i < problem.mu.size(); ++i) {
    if (problem.mu[i] < 0.0)
      file.fail("/fclib_local/vectors/mu",
                fmt::format("entry {} is {}: a coefficient of friction cannot be negative", i, problem.mu[i]));
  }
  read_constraints(file, problem);
  read_info(file, problem);
  read_solutions(file, problem);
}

}  // namespace

FclibProblem read_fclib(const std::string& path) {
  const Hdf5Reader file(path);
  if (!file.has_group("/fclib_local")) {
    if (file.has_group("/fclib_global")) {
      file.fail("/fclib_global",
                "is a global problem, but only local problems (group /fclib_local) are supported: eliminate v by W = "
                "H^T M^-1 H, q = w + H^T M^-1 f first");
    }
    file.fail("/fclib_local", "there is no such group: this is not an FCLib file, or it is damaged");
  }
  FclibProblem problem;
  problem.path = path;
  try {
    read_local(file, problem);
  } catch (const std::bad_alloc&) {
    file.fail("/fclib_local", "does not fit into memory, or its sizes are damaged");
  }
  return problem;
}

}  // namespace ricochet
