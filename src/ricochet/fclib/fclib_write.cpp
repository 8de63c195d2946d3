#include <fmt/format.h>

#include "ricochet/base/error.hpp"
#include "ricochet/fclib/fclib_file.hpp"
#include "ricochet/hdf5/hdf5_file.hpp"

namespace ricochet {

namespace {

void write_triplets(Hdf5Writer& file, const std::string& group, const SparseMatrix& matrix) {
  std::vector<int> rows, columns;
  for (int j = 0; j < int(matrix.cols()); ++j) {
    for (SparseMatrix::InnerIterator entry(matrix, j); entry; ++entry) {
      rows.push_back(int(entry.row()));
      columns.push_back(j);
    }
  }
  file.integers(group + "/p", rows.data(), matrix.nonZeros());
  file.integers(group + "/i", columns.data(), matrix.nonZeros());
  file.reals(group + "/x", matrix.valuePtr(), matrix.nonZeros());
}

/// `compressed` is either a SparseMatrix (by columns) or a SparseRowMatrix (by rows).
template <class Compressed>
void write_compressed(Hdf5Writer& file, const std::string& group, const Compressed& compressed) {
  file.integers(group + "/p", compressed.outerIndexPtr(), compressed.outerSize() + 1);
  file.integers(group + "/i", compressed.innerIndexPtr(), compressed.nonZeros());
  file.reals(group + "/x", compressed.valuePtr(), compressed.nonZeros());
}

void write_matrix(Hdf5Writer& file, const std::string& group, const SparseMatrix& matrix, FclibMatrixForm form) {
  SparseMatrix whole = matrix;
  whole.makeCompressed();
  const auto count = int(whole.nonZeros());
  file.group(group);
  file.integer(group + "/nzmax", count);
  file.integer(group + "/m", int(whole.rows()));
  file.integer(group + "/n", int(whole.cols()));
  file.integer(group + "/nz", form == FclibMatrixForm::triplet           ? count
                              : form == FclibMatrixForm::compressed_rows ? -2
                                                                         : -1);
  if (form == FclibMatrixForm::triplet) return write_triplets(file, group, whole);
  if (form == FclibMatrixForm::compressed_columns) return write_compressed(file, group, whole);
  write_compressed(file, group, SparseRowMatrix(whole));
}

void write_vector(Hdf5Writer& file, const std::string& name, const Vector& values) {
  file.reals(name, values.data(), values.size());
}

void write_solution(Hdf5Writer& file, const std::string& group, const FclibSolution& solution) {
  file.group(group);
  if (solution.multiplier.size() > 0) write_vector(file, group + "/l", solution.multiplier);
  write_vector(file, group + "/u", solution.motion);
  write_vector(file, group + "/r", solution.reaction);
}

void write_info(Hdf5Writer& file, const FclibProblem& problem) {
  const bool has_text = !(problem.title.empty() && problem.description.empty() && problem.math_info.empty());
  if (!has_text && problem.points.empty() && problem.q_rounding.size() == 0) return;
  file.group("/fclib_local/info");
  if (!problem.title.empty()) file.text("/fclib_local/info/title", problem.title);
  if (!problem.description.empty()) file.text("/fclib_local/info/description", problem.description);
  if (!problem.math_info.empty()) file.text("/fclib_local/info/math_info", problem.math_info);
  if (problem.q_rounding.size() > 0) write_vector(file, "/fclib_local/info/q_rounding", problem.q_rounding);
  if (problem.points.empty()) return;
  const std::vector<int> points(problem.points.begin(), problem.points.end());
  file.integers("/fclib_local/info/points", points.data(), Index(points.size()));
}

}  // namespace

void write_fclib(const std::string& path, const FclibProblem& problem, FclibMatrixForm form) {
  Hdf5Writer file(path);
  file.group("/fclib_local");
  file.integer("/fclib_local/spacedim", int(problem.dimension));
  write_matrix(file, "/fclib_local/W", problem.w, form);
  const bool constrained = problem.constraint_count() > 0;
  if (constrained) {
    write_matrix(file, "/fclib_local/V", problem.v, form);
    write_matrix(file, "/fclib_local/R", problem.r, form);
  }
  file.group("/fclib_local/vectors");
  write_vector(file, "/fclib_local/vectors/q", problem.q);
  write_vector(file, "/fclib_local/vectors/mu", problem.mu);
  if (constrained) write_vector(file, "/fclib_local/vectors/s", problem.s);
  write_info(file, problem);
  if (problem.solution) write_solution(file, "/solution", *problem.solution);
  if (!problem.guesses.empty()) {
    file.group("/guesses");
    file.integer("/guesses/number_of_guesses", int(problem.guesses.size()));
    for (std::size_t k = 0; k < problem.guesses.size(); ++k)
      write_solution(file, fmt::format("/guesses/{}", k + 1), problem.guesses[k]);
  }
  file.close();
}

}  // namespace ricochet
