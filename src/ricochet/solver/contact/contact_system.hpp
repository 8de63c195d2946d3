#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "ricochet/base/types.hpp"
#include "ricochet/solver/contact/contact_point.hpp"
#include "ricochet/solver/contact/contact_problem.hpp"

/// @file The contact problem as presented to solvers: the points that may matter, scaled.
namespace ricochet {

/// Rounding of a sum, in units of the sum of absolute values.
inline constexpr double sum_rounding = 32.0 * std::numeric_limits<double>::epsilon();
/// Addition of Newton's methods to W's diagonal, relative to it, if the matrix is singular to rounding: a step of the
/// proximal point algorithm, which has the same limits. Small enough to require few steps, large enough to hide the
/// rounding of W.
inline constexpr double proximal_size = 0x1p-30;
/// Residual that is accepted if rounding is required and nothing improves any more.
inline constexpr double loosest_residual = 1e-12;
/// F above which the cone is insensitive to a penetration: its residual is 1/F of it. The law itself is then checked,
/// too.
inline constexpr double steep_coefficient = 30.0;

/// State of the iteration and the quantities that follow from it, all scaled.
struct ContactIterate {
  Vector reaction;  ///< r
  Vector motion;    ///< u = q + W r
  Vector size;      ///< |q| + Σ_j |W_ij r_j|, on which the rounding of u depends; with products, as far as it is known
};

/// Rows and columns are scaled by powers of two, one exponent per point, so that the largest diagonal entry of each
/// block of W lies in [1, 4) and the data (below) in [1, 2): solvers then depend neither on units nor on a scaling of
/// rows, and nothing is rounded. With u' = S D u, W' = e D W D, r' = (S/e) D⁻¹ r it is u' = q' + W' r'.
///
/// The measure. At each point the natural map e_i of the cone complementarity problem (contact_point.hpp) is taken in
/// the unit in which W_ii is one: |e_i| √w_i with w_i its mean diagonal entry. The residual is the largest of these
/// over the points, divided by the data: that of r = 0, the scale of the problem (points that stay open without help do
/// not count). Its rounding floor is the effect of 32 ε (|q| + Σ|W r|) + offset_rounding on it. If the first of the two
/// terms is above a hundredth of the largest q, reactions are so large that rounding hides the law: that is no
/// solution. Nor is a floor an excuse if the law itself (Alart and Curnier's residual) is violated by so much; at
/// points with F > 30, where the cone is insensitive to a penetration, that is no solution at any tolerance.
class ContactSystem {
 public:
  /// Analyses W and its scales.
  void analyse(const ContactProblem& problem);
  /// Selects the points of the system out of the eligible ones, in their order, and the data of this problem. A dense W
  /// is gathered for them, unless it already is.
  void select(const ContactProblem& problem, const std::vector<char>& selected);
  /// Sets q, F and bounds of the problem, and the size of the data. To be called before `select`.
  void set_data(const ContactProblem& problem);

  /// True if q_N is below `margin` times the largest data, in the unit of the residual.
  [[nodiscard]] bool is_near(const ContactProblem& problem, Index point, double margin) const {
    const auto at = std::size_t(point);
    return motion_scale(point) * problem.offset[problem.row_offset[at]] < margin * data_ * std::sqrt(normal_[at]);
  }
  [[nodiscard]] const std::vector<ContactPoint>& points() const { return points_; }
  [[nodiscard]] const PointOperator& point_operator(std::size_t k) const { return point_operators_[k]; }
  [[nodiscard]] Index rows() const { return offset_.size(); }
  /// Row of the problem for a row of the system, and back (−1: not in the system): data kept from one selection of
  /// points to the next are identified by rows of the problem.
  [[nodiscard]] Index problem_row(Index row) const { return row_of_[std::size_t(row)]; }
  [[nodiscard]] Index system_row(Index problem_row) const;
  [[nodiscard]] const Vector& offset() const { return offset_; }
  /// Largest natural map of r = 0, over all eligible points. In [1, 2), or zero: r = 0 is a solution.
  [[nodiscard]] double data() const { return data_; }
  [[nodiscard]] bool data_are_finite() const { return data_are_finite_; }
  /// Error in W; empty if none has been found so far.
  [[nodiscard]] const std::string& fault() const { return fault_; }
  /// Whether W is symmetric and positive semi-definite (ContactProblem::is_symmetric).
  [[nodiscard]] bool is_symmetric() const { return is_symmetric_; }
  /// W′ of the system's rows if entries are available (no product operator of many rows).
  [[nodiscard]] const Matrix* dense() const { return mode_ == Mode::dense ? &matrix_ : nullptr; }
  [[nodiscard]] const SparseMatrix* sparse() const { return mode_ == Mode::sparse ? &sparse_ : nullptr; }
  [[nodiscard]] bool has_entries() const { return mode_ != Mode::product; }

  /// Evaluates u = q + W r and its size afresh.
  void evaluate(ContactIterate& iterate) const;
  /// Computes y = W x.
  void multiply(const Vector& x, Vector& y) const;
  /// Updates u += W · (change of the reaction of a point). Requires entries.
  void add_change(const ContactPoint& point, const PaddedVector& change, Vector& motion) const;
  /// Updates u in single precision, for sweeps through a W that exceeds the caches: it reads half as much. u must be
  /// evaluated afresh before its remainder has lost its digits.
  void add_change_roughly(const ContactPoint& point, const PaddedVector& change, Vector& motion) const;
  /// True if add_change_roughly is faster than add_change.
  [[nodiscard]] bool has_rough_entries() const { return mode_ == Mode::dense && single_.size() > 0; }

  /// |e_i| √w_i of one point.
  [[nodiscard]] static double residual(const ContactPoint& point, const PaddedVector& reaction,
                                       const PaddedVector& motion);
  /// Largest residual over the points, not divided by the data.
  [[nodiscard]] double residual(const ContactIterate& iterate) const;
  /// Measure of an iterate, not divided by the data.
  struct Measure {
    double residual = 0.0;        ///< largest over the points
    double beyond_floor = 0.0;    ///< largest excess over the rounding floor of a point; zero: rounding
    double rounding_floor = 0.0;  ///< largest over the points
    bool is_exact = true;         ///< the residual is rounding even if q is taken as exact
  };
  [[nodiscard]] Measure measure(const ContactIterate& iterate) const;
  /// True if the residual is at most `tolerance` of the data, or rounding.
  [[nodiscard]] bool is_solved(const ContactIterate& iterate, double tolerance) const {
    return measure(iterate).beyond_floor <= tolerance * data_;
  }
  /// Rounding floor of u at a point: normal, and tangential.
  struct Floor {
    double normal = 0.0, tangential = 0.0;
    double of_offset = 0.0;  ///< largest part due to the rounding of q
    double of_sums = 0.0;    ///< and not due to it
  };
  [[nodiscard]] Floor floor_of(const ContactPoint& point, const ContactIterate& iterate) const;

  /// Convert from rows of the problem to those of the system and back; entries outside the system are zero.
  void scale_reaction(const Vector& reaction, Vector& scaled) const;
  void unscale_reaction(const Vector& scaled, Vector& reaction) const;
  /// Requires a system with all rows of the problem.
  void unscale_motion(const Vector& scaled, Vector& motion) const;
  /// Scaled residual of any eligible point of the problem, in or out of the system, from r and u in the problem's
  /// units.
  [[nodiscard]] double residual_of(const ContactProblem& problem, Index point, const Vector& reaction,
                                   const Vector& motion) const;

 private:
  enum class Mode { dense, sparse, product };
  [[nodiscard]] ContactPoint make_point(const ContactProblem& problem, Index i) const;
  [[nodiscard]] double motion_scale(Index i) const { return data_scale_ * scale_[std::size_t(i)]; }
  [[nodiscard]] double reaction_scale(Index i) const { return data_scale_ / operator_scale_ / scale_[std::size_t(i)]; }
  void gather(const ContactProblem& problem);
  void copy_dense();
  void note_sum(double sum);
  void copy_sparse();

  Mode mode_ = Mode::dense;
  bool is_symmetric_ = true;
  std::shared_ptr<const ContactOperator> operator_;
  std::shared_ptr<const ContactOperator> found_;  ///< entries of a product operator of few rows
  std::vector<Index> problem_row_offset_;
  std::vector<double> scale_;          ///< D, per point of the problem
  std::vector<PointMatrix> blocks_;    ///< W_ii, per point of the problem, unscaled
  std::vector<double> normal_, mean_;  ///< w, per point of the problem, scaled: of the normal, of the block
  double operator_scale_ = 1.0;        ///< e
  double data_scale_ = 1.0;            ///< S
  double data_ = 0.0;
  bool data_are_finite_ = true;
  std::string fault_;

  std::vector<Index> gathered_;    ///< points of the problem in the system, eligible or not
  std::vector<Index> chosen_;      ///< points requested for the system
  std::vector<Index> rows_;        ///< of these, in the problem
  std::vector<Index> runs_;        ///< work space of copy_dense
  std::vector<Index> row_of_;      ///< per row of the system: the problem's row
  std::vector<double> row_scale_;  ///< per row of the system: D
  std::vector<ContactPoint> points_, last_points_;
  std::vector<PointOperator> point_operators_;
  Matrix matrix_;
  Eigen::MatrixXf single_;  ///< matrix_ in single precision, if there are many rows
  SparseMatrix sparse_;
  Vector offset_, offset_rounding_;
  double largest_offset_ = 0.0;
  mutable Vector product_argument_, product_result_;
};

}  // namespace ricochet
