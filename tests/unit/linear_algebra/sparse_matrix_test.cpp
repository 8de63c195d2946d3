#include "ricochet/linear_algebra/sparse_matrix.hpp"

#include <gtest/gtest.h>

#include <random>

namespace ricochet {
namespace {

/// About a third of the entries, column 2 empty.
SparseMatrix random_sparse_matrix(Index size, unsigned seed) {
  std::mt19937 random(seed);
  Matrix dense = Matrix::Zero(size, size);
  for (Index i = 0; i < size; ++i) {
    for (Index j = 0; j < size; ++j) {
      if (j != 2 && random() % 3 == 0) dense(i, j) = double(random()) / 2147483648.0 - 1.0;
    }
  }
  return dense.sparseView();
}

TEST(SparseMatrix, ExtractTakesTheNumberedRowsAndColumns) {
  const SparseMatrix matrix = random_sparse_matrix(6, 61);
  const std::vector<int> rows{1, -1, 0, -1, 2, -1};
  const std::vector<int> columns{-1, 0, -1, 1, -1, -1};
  const Matrix found = extract(matrix, rows, 3, columns, 2);
  const Matrix dense = matrix;
  const std::vector<Index> row_of{2, 0, 4};
  const std::vector<Index> column_of{1, 3};
  EXPECT_TRUE(found == Matrix(dense(row_of, column_of)));
}

TEST(SparseMatrix, SumsHaveTheEntriesOfBoth) {
  for (const Index size : {0, 1, 7, 40}) {
    const SparseMatrix a = random_sparse_matrix(size, 1), b = random_sparse_matrix(size, 2);
    const SparseMatrix sum = add_sparse(a, b), expected = a + b;
    EXPECT_TRUE(sum.isCompressed());
    EXPECT_EQ(sum.nonZeros(), expected.nonZeros());
    EXPECT_TRUE(Matrix(sum) == Matrix(expected));
    for (Index column = 0; column < size; ++column) {
      Index last = -1;
      for (SparseMatrix::InnerIterator entry(sum, column); entry; ++entry) {
        EXPECT_GT(entry.row(), last);
        last = entry.row();
      }
    }
  }
}

}  // namespace
}  // namespace ricochet
