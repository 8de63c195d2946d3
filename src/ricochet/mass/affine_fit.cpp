#include "ricochet/mass/affine_fit.hpp"

#include <algorithm>
#include <cmath>

namespace ricochet {

namespace {

/// A pivot is the square of a row after elimination of the preceding rows: for a dependent row it is rounding error.
constexpr double smallest_pivot = 1e-14;
constexpr double smallest_size = 1e-12;
constexpr double rounding = 1e-14;

/// Cholesky factorization A = L Lᵀ; returns false if A is singular to rounding.
bool factorize(int dimension, const double (&a)[3][3], double (&lower)[3][3]) {
  for (int j = 0; j < dimension; ++j) {
    double pivot = a[j][j];
    for (int k = 0; k < j; ++k) pivot -= lower[j][k] * lower[j][k];
    if (!(pivot > smallest_pivot * a[j][j])) return false;
    lower[j][j] = std::sqrt(pivot);
    for (int i = j + 1; i < dimension; ++i) {
      double sum = a[i][j];
      for (int k = 0; k < j; ++k) sum -= lower[i][k] * lower[j][k];
      lower[i][j] = sum / lower[j][j];
    }
  }
  return true;
}

/// Solves axes ξ = x. The residual is at the rounding level of x, unlike that of a product with the inverse.
void solve(const AffineFrame& frame, int dimension, const double* x, double* xi) {
  for (int i = 0; i < dimension; ++i) {
    double sum = x[i];
    for (int k = 0; k < i; ++k) sum -= frame.axes[i][k] * xi[k];
    xi[i] = sum / frame.axes[i][i];
  }
}

/// Moves the origin of the frame to the centre of gravity and normalizes the second moments to the identity.
bool normalize(const Points& nodes, const int* of, int count, const Vector& node_weights, AffineFrame& frame) {
  const int d = int(nodes.rows());
  double mean[3] = {}, second[3][3] = {}, xi[3];
  for (int pass = 0; pass < 2; ++pass) {
    for (int j = 0; j < count; ++j) {
      affine_coordinates(frame, d, nodes.col(of[j]).data(), xi);
      const double share = node_weights[of[j]] / frame.total_weight;
      for (int a = 0; a < d; ++a) {
        if (pass == 0) mean[a] += share * xi[a];
        for (int b = 0; pass == 1 && b <= a; ++b) second[a][b] += share * (xi[a] - mean[a]) * (xi[b] - mean[b]);
      }
    }
  }
  double lower[3][3] = {};
  if (!factorize(d, second, lower)) return false;
  for (int i = 0; i < d; ++i) {
    for (int k = 0; k <= i; ++k) frame.offset[i] += frame.axes[i][k] * mean[k];
    for (int j = 0; j <= i; ++j) {
      double sum = 0.0;
      for (int k = j; k <= i; ++k) sum += frame.axes[i][k] * lower[k][j];
      frame.axes[i][j] = sum;  // later columns of this row only need axes of columns ≥ theirs
    }
  }
  return true;
}

/// Computes 2 − G, the inverse of a G that is the identity up to rounding.
void invert_gram(const Points& nodes, const int* of, int count, const Vector& node_weights, AffineFrame& frame) {
  const int d = int(nodes.rows());
  for (int a = 0; a <= d; ++a) frame.inverse_gram[a][a] = 2.0;
  for (int j = 0; j < count; ++j) {
    double p[4] = {1.0};
    affine_coordinates(frame, d, nodes.col(of[j]).data(), p + 1);
    const double share = node_weights[of[j]] / frame.total_weight;
    for (int a = 0; a <= d; ++a) {
      for (int b = 0; b <= d; ++b) frame.inverse_gram[a][b] -= share * p[a] * p[b];
    }
  }
}

}  // namespace

void affine_coordinates(const AffineFrame& frame, int dimension, const double* point, double* xi) {
  double relative[3];
  for (int k = 0; k < dimension; ++k) relative[k] = (point[k] - frame.base[k]) - frame.offset[k];
  solve(frame, dimension, relative, xi);
}

void affine_weight(const AffineFrame& frame, int dimension, const double* point, double node_weight,
                   double (&weight)[4]) {
  double p[4] = {1.0};
  affine_coordinates(frame, dimension, point, p + 1);
  for (int a = 0; a < 4; ++a) {
    weight[a] = 0.0;
    for (int b = 0; b <= dimension; ++b) weight[a] += frame.inverse_gram[a][b] * p[b];
    weight[a] *= node_weight / frame.total_weight;
  }
}

void affine_change(const AffineFrame& from, const AffineFrame& to, int dimension, double (&shift)[3],
                   double (&linear)[3][3]) {
  double relative[3], column[3], solved[3];
  for (int k = 0; k < dimension; ++k) relative[k] = (from.base[k] - to.base[k]) + (from.offset[k] - to.offset[k]);
  solve(to, dimension, relative, shift);
  for (int j = 0; j < dimension; ++j) {
    for (int i = 0; i < dimension; ++i) column[i] = from.axes[i][j];
    solve(to, dimension, column, solved);
    for (int i = 0; i < dimension; ++i) linear[i][j] = solved[i];
  }
}

bool make_affine_frame(const Points& nodes, const int* of, int count, const Vector& node_weights, AffineFrame& frame) {
  const int d = int(nodes.rows());
  if (count <= d) return false;
  frame = {};
  double size[3] = {}, largest[3] = {};
  for (int k = 0; k < d; ++k) frame.base[k] = nodes(k, of[0]);
  for (int j = 0; j < count; ++j) {
    frame.total_weight += node_weights[of[j]];
    for (int k = 0; k < d; ++k) {
      size[k] = std::max(size[k], std::abs(nodes(k, of[j]) - frame.base[k]));
      largest[k] = std::max(largest[k], std::abs(nodes(k, of[j])));
    }
  }
  const double longest = std::max({size[0], size[1], size[2]});
  for (int k = 0; k < d; ++k) {
    // Detects planes normal to a coordinate axis, whose extent is rounding error.
    if (!(size[k] > smallest_size * longest && size[k] > rounding * largest[k])) return false;
    frame.axes[k][k] = size[k];
  }
  // The second pass removes the rounding error of the first in flat cells: squares lose twice as many digits.
  for (int pass = 0; pass < 2; ++pass) {
    if (!normalize(nodes, of, count, node_weights, frame)) return false;
  }
  invert_gram(nodes, of, count, node_weights, frame);
  return true;
}

}  // namespace ricochet
