#pragma once

#include <Eigen/Geometry>
#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/contact/mortar/body_contact.hpp"
#include "ricochet/contact/mortar/surface_segments.hpp"
#include "ricochet/contact/rotating_normal.hpp"

/// @file Two surfaces with unlimited sliding: the pairing is found anew at every displacement.
///
/// A contact point is a multiplier ψ_i of the own surface. Each point ξ of its support is projected onto the opposite
/// surface along the normal n(x) of its own facet, into the body, at x_m = Π x_s(ξ), where the opposite surface has the
/// normal ν. With h = n·(x_s − x_m) and areas dA of the reference configuration
///   D_i = ∫_Γi ψ_i dA,   ḡ_i(x) = (1/D_i) ∫_Γi ψ_i h dA,   g_i(x) = ḡ_i / |(1/D_i) ∫_Γi ψ_i ν/(n·ν) dA|,
/// Γ_i the part of the support that faces the opposite surface. At a fixed ξ the distance changes by
///   δh = ν·(δx_s − δx_m − h δn)/(n·ν),
/// whichever material point x_m is, so that the row of a point has a closed form:
///   D_i ∂ḡ_i/∂x = ∫ψ_i φˢ_j ν/(n·ν),  −∫ψ_i φᵐ_k∘Π ν/(n·ν),  −Σ_facets (∂n/∂x)ᵀ ∫ψ_i h ν/(n·ν)
/// on the nodes of the own surface, of the opposite one, and of the facets' normals. No rigid motion of both bodies
/// changes g_i: rows have no resultant and no moment about the current positions. Divided by that length their part on
/// the own body is a unit vector, so that a reaction equals the force on the body. Points seen at grazing angles have
/// reduced weight, by a smooth function of n·ν that is 1 up to 45 degrees, because points on the lateral faces at a
/// corner appear and disappear. The derivatives of that function, of the length and of the boundary of Γ_i are
/// neglected: they are multiplied by gaps, which are small where a force acts. Rims of the opposite surface are
/// rounded: where little of a support faces it, a gap is larger by the allowance of rim_distance.hpp, whose derivative
/// is part of the row.
namespace ricochet {

/// Vector of three components, the third 0 in 2D.
using SlidingVector = Eigen::Vector3d;

/// Current position of a node; `nodes`: reference positions, d × count.
[[nodiscard]] inline SlidingVector current_position(const Points& nodes, Index node, const Vector& displacement) {
  const Index d = nodes.rows();
  SlidingVector result = SlidingVector::Zero();
  result.head(d) = nodes.col(node) + displacement.segment(node * d, d);
  return result;
}

/// View of the opposite surface from a contact point at one displacement.
struct SlidingView {
  using Weights = std::vector<std::pair<Index, double>>;
  using Vectors = std::vector<std::pair<Index, SlidingVector>>;

  bool faces = false;       ///< false if it faces nothing; the other members are then empty
  double gap = 0.0;         ///< g_i
  double distance = 0.0;    ///< g_i without the allowance at a rim
  SlidingVector direction;  ///< of the force on the own body, a unit vector
  Weights own, opposite;    ///< c_ij and m_ik, ascending by nodes; only in views with rows
  Vectors row;              ///< ∂g_i/∂x per node, ascending
  Vectors rim;              ///< W ∂c/∂x, c the cover at a rim, part of which is in `row`; work space
};

class SlidingPair {
 public:
  struct Point {
    Index number = 0;  ///< among all contact points
    Multiplier multiplier;
    RotatingNormal normal;          ///< of the facets around it, into the body
    double offset = 0.0;            ///< added to the gap
    std::array<bool, 3> is_free{};  ///< components without support
  };
  struct Data {
    Body body;
    std::string multipliers;  ///< name of the space
    std::vector<Index> facets, opposite_facets;
    std::vector<Point> points;
    bool is_one_of_many = false;  ///< ContactPair::is_one_of_many

    /// Whether both are one surface, whose facets ignore those within two rings around them.
    [[nodiscard]] bool is_self() const { return facets == opposite_facets; }
  };

  /// Keeps the pointers of the body.
  explicit SlidingPair(Data data);
  ~SlidingPair();
  SlidingPair(const SlidingPair&) = delete;
  SlidingPair& operator=(const SlidingPair&) = delete;

  [[nodiscard]] const Data& data() const;
  [[nodiscard]] const std::vector<Point>& points() const { return data().points; }
  [[nodiscard]] bool is_self() const;
  /// For a surface in contact with itself: smallest detectable depth of penetration over all facets.
  [[nodiscard]] double detection_depth() const;
  /// Degree of the displacement.
  [[nodiscard]] int degree() const;
  [[nodiscard]] int dimension() const;
  /// Nodes of both surfaces, ascending.
  [[nodiscard]] const std::vector<Index>& nodes() const;
  /// Smallest height of the cells behind the facets.
  [[nodiscard]] double height() const;
  /// Unit normal of the facets around a point, into the body.
  [[nodiscard]] SlidingVector normal(std::size_t point, const Vector& displacement) const;

  enum class Content { gap, row };
  /// Computes the views of all points that are not left out (empty: all): `views` has one for each point. Overlaps
  /// deeper than half a cell are ignored, except for points of `any_depth` (empty: none). If both surfaces are one,
  /// overlaps deeper than a quarter of the body's initial thickness are ignored for every point.
  void compute_views(const Vector& displacement, Content content, const std::vector<char>& left_out,
                     const std::vector<char>& any_depth, std::vector<SlidingView>& views) const;

  /// Number of calls of compute_views() so far.
  [[nodiscard]] long projection_count() const;

  /// Distance of a node of the own surface along a direction (unit, into its body); NaN if it faces nothing.
  [[nodiscard]] double node_gap(Index node, const SlidingVector& direction, const Vector& displacement) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Largest displacement of a node of the pair between two displacements of all nodes; for a surface in contact with
/// itself, relative to its mean motion. It decides which of its points are active and hence which are selected, and
/// must not depend on the frame of the observer.
[[nodiscard]] double largest_motion(const SlidingPair& pair, const Vector& to, const Vector& from);

/// For a surface in contact with itself: parts that approach by more than its detectable depth in one step may pass
/// through each other undetected. Logs a warning and returns true in that case.
bool warn_of_undetected_contact(const SlidingPair& pair, const Vector& to, const Vector& from);

}  // namespace ricochet
