#include "support/grid_matrix.hpp"

#include <cmath>
#include <vector>

namespace ricochet::test_support {

Vector random_vector(Index size, unsigned seed) {
  std::mt19937 random(seed);
  return uniform(size, random);
}

SparseMatrix grid_matrix(int dimension, int side, int components, unsigned seed) {
  std::mt19937 random(seed);
  int nodes = 1;
  for (int d = 0; d < dimension; ++d) nodes *= side;
  std::vector<Eigen::Triplet<double>> entries;
  Vector diagonal = Vector::Zero(Index(nodes) * components);
  const auto couple = [&](int a, int b) {
    for (int i = 0; i < components; ++i) {
      for (int j = 0; j < components; ++j) {
        const int row = components * a + i, column = components * b + j;
        const double value = uniform(random);
        entries.emplace_back(row, column, value);
        entries.emplace_back(column, row, value);
        diagonal[row] += std::abs(value);
        diagonal[column] += std::abs(value);
      }
    }
  };
  for (int node = 0; node < nodes; ++node) {
    for (int offset = 1; offset < 27; ++offset) {
      int other = 0, factor = 1;
      bool inside = true;
      for (int d = 0, rest = node, by = offset; d < dimension; ++d, rest /= side, by /= 3, factor *= side) {
        const int at = rest % side + by % 3 - 1;
        inside = inside && at >= 0 && at < side;
        other += at * factor;
      }
      if (inside && other > node) couple(node, other);
    }
  }
  for (Index i = 0; i < diagonal.size(); ++i) entries.emplace_back(int(i), int(i), 1.01 * diagonal[i] + 0.1);
  SparseMatrix matrix(diagonal.size(), diagonal.size());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace ricochet::test_support
