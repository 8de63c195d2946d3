#include "ricochet/mass/mass_conditions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "ricochet/base/dense_decompositions.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/linear_algebra/graph_components.hpp"
#include "ricochet/mass/mass.hpp"

namespace ricochet {

namespace {

/// Scales the frame by the extent of the body in each direction, for coordinates of order one.
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

/// Largest rounding error of the nodes of a body, in its frame.
double position_rounding(const Points& nodes, const MassBody& body) {
  const Index d = nodes.rows();
  const Matrix inverse = body.axes.triangularView<Eigen::Lower>().solve(Matrix::Identity(d, d)).cwiseAbs();
  Vector largest = Vector::Zero(d);
  for (const Index node : body.nodes) largest = largest.cwiseMax(nodes.col(node).cwiseAbs());
  return std::numeric_limits<double>::epsilon() * (inverse * largest).maxCoeff();
}

/// Moves the origin to the centre of gravity and normalizes the second moments to the identity.
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
  for (std::vector<Index>& members : graph_components(MatrixGraph(mass, 1))) {
    // Tied nodes have none: their mass is on the nodes to which they are tied.
    const bool has_mass = members.size() > 1 || mass.col(members.front()).nonZeros() > 0;
    if (!has_mass) continue;
    MassBody body;
    body.nodes = std::move(members);
    start_frame(nodes, frames, body);
    // The second pass removes the rounding error of the first in flat bodies.
    for (int pass = 0; pass < 2; ++pass) normalize(mass, frames, body);
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

double moment_defect(const SparseMatrix& found, const SparseMatrix& target, const MassFrames& frames,
                     const MassBody& body) {
  const Matrix right = mass_moments(target, frames, body);
  const double difference = (mass_moments(found, frames, body) - right).cwiseAbs().maxCoeff();
  return difference == 0.0 ? 0.0 : difference / right.cwiseAbs().maxCoeff();
}

void check_moments(const MassInput& input, const SparseMatrix& mass, const std::string& type) {
  const MassFrames frames = mass_frames(input.inertia_matrix(), *input.nodes);
  for (const MassBody& body : frames.bodies) {
    const double defect = moment_defect(mass, *input.consistent, frames, body);
    // Σ|w| is about ten if the weights extrapolate by a few cells.
    if (defect <= 1e-10 + 100.0 * position_rounding(*input.nodes, body)) continue;
    throw Error(
        ErrorKind::invalid_input,
        fmt::format("mass type \"{}\": the moments of inertia of the body with the node at {} would be wrong by {:.2g} "
                    "of the largest, as the nodes off the contact boundary that would carry them are far away, or "
                    "nearly on a line or in a plane; refine the mesh around the contact boundary, or use mass type "
                    "\"consistent\" or \"lumped\" with scheme \"contact-stabilized\" or \"newmark\"",
                    type, text_of_point(*input.nodes, body.nodes.front()), defect));
  }
}

double top_eigenvalue(const SparseMatrix& mass, const Vector& diagonal) {
  constexpr int steps = 40;
  const Vector scale = diagonal.cwiseSqrt().cwiseInverse();
  Vector x(diagonal.size());
  for (Index i = 0; i < x.size(); ++i) x[i] = mass.coeff(i, i) * scale[i] * scale[i];
  double result = 0.0;
  for (int step = 0; step < steps; ++step) {
    const double size = x.norm();
    if (!(size > 0.0)) return result;
    x /= size;
    const Vector y = scale.cwiseProduct(mass * scale.cwiseProduct(x));
    result = x.dot(y);
    x = y;
  }
  return result;
}

std::string text_of_point(const Points& nodes, Index node) {
  std::string text;
  for (Index k = 0; k < nodes.rows(); ++k) text += fmt::format("{}{:.6g}", k == 0 ? "(" : ", ", nodes(k, node));
  return text + ")";
}

namespace {

Matrix relative_positions(const Points& nodes, const Vector& centre, const std::vector<Index>& of) {
  Matrix result(nodes.rows(), Index(of.size()));
  for (Index k = 0; k < result.cols(); ++k) result.col(k) = nodes.col(of[std::size_t(k)]) - centre;
  return result;
}

/// Dimension of the affine span of points of a body, in the frame in which the body is equally wide: 0 for one point.
int span_dimension(const Points& nodes, const std::vector<Index>& body, const std::vector<Index>& points) {
  Vector centre = Vector::Zero(nodes.rows());
  for (const Index node : body) centre += nodes.col(node) / double(body.size());
  // X Xᵀ = Rᵀ R: R⁻ᵀ makes the body equally wide without forming squares, which lose half of the digits of flat bodies.
  const Matrix axes = upper_of_qr(relative_positions(nodes, centre, body).transpose());
  Matrix relative = relative_positions(nodes, nodes.col(points.front()), points);
  if (axes.diagonal().cwiseAbs().minCoeff() > 0.0)  // else the body itself lies in a plane
    relative = axes.transpose().triangularView<Eigen::Lower>().solve(relative);
  // The tolerance exceeds the rounding of single-precision coordinates.
  return int(PivotedQr(relative, 1e-6).rank());
}

}  // namespace

std::string degeneracy(const Points& nodes, const std::vector<Index>& body, const std::vector<Index>& points) {
  if (points.empty()) return "";
  const char* const words[] = {"at one point", "on one line", "in one plane"};
  const int rank = span_dimension(nodes, body, points);
  return rank < nodes.rows() ? words[rank] : "";
}

bool span_space(const Points& nodes, const std::vector<Index>& body, const std::vector<Index>& points) {
  return !points.empty() && span_dimension(nodes, body, points) == nodes.rows();
}

std::string describe_massive_nodes(const Points& nodes, const std::vector<Index>& body,
                                   const std::vector<Index>& points) {
  if (points.empty()) return "no node off the contact boundary";
  std::string text = points.size() == 1 ? "one node off the contact boundary, at "
                                        : fmt::format("{} nodes off the contact boundary, at ", points.size());
  const std::size_t shown = std::min<std::size_t>(points.size(), 3);
  for (std::size_t k = 0; k < shown; ++k) {
    const bool last = k + 1 == points.size();
    text += fmt::format("{}{}", k == 0 ? "" : last ? " and " : ", ", text_of_point(nodes, points[k]));
  }
  if (shown < points.size()) text += ", ...";
  const std::string lie = points.size() > 2 ? degeneracy(nodes, body, points) : "";
  return lie.empty() ? text : text + ", all " + lie;
}

}  // namespace ricochet
