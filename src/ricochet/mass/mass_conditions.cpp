#include "ricochet/mass/mass_conditions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/base/dense_decompositions.hpp"
#include "ricochet/linear_algebra/graph_components.hpp"

namespace ricochet {

namespace {

/// Size of the body in each direction, for numbers near one.
void start_frame(const Points& nodes, MassFrames& frames, MassBody& body) {
  const Index d = nodes.rows();
  Vector low = nodes.col(body.nodes.front()), high = low;
  for (const Index node : body.nodes) {
    low = low.cwiseMin(nodes.col(node));
    high = high.cwiseMax(nodes.col(node));
  }
  const Vector size = (high - low).unaryExpr([](double length) { return length > 0.0 ? length : 1.0; });
  body.centre = 0.5 * (low + high);
  body.axes = size.asDiagonal();
  for (const Index node : body.nodes) {
    frames.monomials(0, node) = 1.0;
    frames.monomials.col(node).tail(d) = (nodes.col(node) - body.centre).cwiseQuotient(size);
  }
}

/// Moves the origin into the centre of gravity and makes the second moments one.
void normalize(const SparseMatrix& mass, MassFrames& frames, MassBody& body) {
  const Index d = body.centre.size();
  const Matrix moments = mass_moments(mass, frames, body);
  if (!(moments(0, 0) > 0.0)) return;
  const Vector shift = moments.col(0).tail(d) / moments(0, 0);
  const SmallCholesky spread(moments.bottomRightCorner(d, d) / moments(0, 0) - shift * shift.transpose());
  if (!spread.positive_definite()) return;
  body.centre += body.axes * shift;
  body.axes = (body.axes * spread.lower()).eval();
  for (const Index node : body.nodes) {
    const Vector relative = frames.monomials.col(node).tail(d) - shift;
    frames.monomials.col(node).tail(d) = spread.solve_lower(relative);
  }
}

}  // namespace

MassFrames mass_frames(const SparseMatrix& mass, const Points& nodes) {
  MassFrames frames;
  frames.monomials.setZero(nodes.rows() + 1, nodes.cols());
  for (std::vector<Index>& members : graph_components(mass, 1)) {
    MassBody body;
    body.nodes = std::move(members);
    start_frame(nodes, frames, body);
    // The second round takes away what rounding left of the first in flat bodies.
    for (int round = 0; round < 2; ++round) normalize(mass, frames, body);
    frames.bodies.push_back(std::move(body));
  }
  return frames;
}

Matrix mass_moments(const SparseMatrix& mass, const MassFrames& frames, const MassBody& body) {
  const Index size = frames.monomials.rows();
  const double* const monomials = frames.monomials.data();
  double moments[4][4] = {};
  for (const Index node : body.nodes) {
    double product[4] = {};
    for (SparseMatrix::InnerIterator entry(mass, node); entry; ++entry) {
      for (Index a = 0; a < size; ++a) product[a] += entry.value() * monomials[entry.row() * size + a];
    }
    for (Index a = 0; a < size; ++a) {
      for (Index b = 0; b < size; ++b) moments[a][b] += product[a] * monomials[node * size + b];
    }
  }
  Matrix result(size, size);
  for (Index a = 0; a < size; ++a) {
    for (Index b = 0; b < size; ++b) result(a, b) = moments[a][b];
  }
  return result;
}

double moment_defect(const SparseMatrix& found, const SparseMatrix& wanted, const MassFrames& frames,
                     const MassBody** worst) {
  double result = 0.0;
  for (const MassBody& body : frames.bodies) {
    const Matrix right = mass_moments(wanted, frames, body);
    const double difference = (mass_moments(found, frames, body) - right).cwiseAbs().maxCoeff();
    if (difference == 0.0) continue;
    const double defect = difference / right.cwiseAbs().maxCoeff();  // infinite where nothing is wanted
    if (defect <= result) continue;
    result = defect;
    if (worst != nullptr) *worst = &body;
  }
  return result;
}

std::string text_of_point(const Points& nodes, Index node) {
  std::string text;
  for (Index k = 0; k < nodes.rows(); ++k) text += fmt::format("{}{:.6g}", k == 0 ? "(" : ", ", nodes(k, node));
  return text + ")";
}

std::string degeneracy(const Points& nodes, const std::vector<Index>& points) {
  if (points.empty()) return "";
  const Index d = nodes.rows();
  Matrix relative(d, static_cast<Index>(points.size()));
  for (Index k = 0; k < relative.cols(); ++k)
    relative.col(k) = nodes.col(points[static_cast<std::size_t>(k)]) - nodes.col(points.front());
  // Coordinates of single precision are told from positions that matter.
  const PivotedQr factor(relative, 1e-6);
  const char* const words[] = {"at one point", "on one line", "in one plane"};
  return factor.rank() < d ? words[factor.rank()] : "";
}

bool span_space(const Points& nodes, const std::vector<Index>& body, const std::vector<Index>& points) {
  const Index d = nodes.rows();
  if (static_cast<Index>(points.size()) <= d) return false;
  const auto relative_to = [&](const Vector& centre, const std::vector<Index>& of) {
    Matrix result(d, static_cast<Index>(of.size()));
    for (Index k = 0; k < result.cols(); ++k) result.col(k) = nodes.col(of[static_cast<std::size_t>(k)]) - centre;
    return result;
  };
  Vector centre = Vector::Zero(d);
  for (const Index node : body) centre += nodes.col(node) / static_cast<double>(body.size());
  // X Xᵀ = Rᵀ R: R⁻ᵀ makes the body round, without the squares that lose half of the digits of flat bodies.
  const Matrix axes = upper_of_qr(relative_to(centre, body).transpose());
  if (axes.diagonal().cwiseAbs().minCoeff() == 0.0) return false;  // nor does the body
  const Matrix relative =
      axes.transpose().triangularView<Eigen::Lower>().solve(relative_to(nodes.col(points.front()), points));
  return PivotedQr(relative, 1e-6).rank() == d;
}

std::string describe_free_nodes(const Points& nodes, const std::vector<Index>& points) {
  if (points.empty()) return "no node off the contact boundary";
  std::string text = points.size() == 1 ? "one node off the contact boundary, at "
                                        : fmt::format("{} nodes off the contact boundary, at ", points.size());
  const std::size_t shown = std::min<std::size_t>(points.size(), 3);
  for (std::size_t k = 0; k < shown; ++k) {
    const bool last = k + 1 == points.size();
    text += fmt::format("{}{}", k == 0 ? "" : last ? " and " : ", ", text_of_point(nodes, points[k]));
  }
  if (shown < points.size()) text += ", ...";
  const std::string lie = points.size() > 2 ? degeneracy(nodes, points) : "";
  return lie.empty() ? text : text + ", all " + lie;
}

}  // namespace ricochet
