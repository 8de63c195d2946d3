#pragma once

#include <Eigen/Geometry>
#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/contact/mortar/body_contact.hpp"
#include "ricochet/contact/mortar/surface_segments.hpp"
#include "ricochet/contact/turning_normal.hpp"

/// @file Two surfaces that slide along each other without limit: what faces what is found anew at every displacement.
///
/// A contact point is a multiplier ψ_i of the own surface. Each place ξ of its support is seen on the opposite surface
/// along the normal n(x) of its own facet, into the body, at x_m = Π x_s(ξ), where the opposite surface has the normal
/// ν. With h = n·(x_s − x_m) and areas dA of the reference configuration
///   D_i = ∫_Γi ψ_i dA,   ḡ_i(x) = (1/D_i) ∫_Γi ψ_i h dA,   g_i(x) = ḡ_i / |(1/D_i) ∫_Γi ψ_i ν/(n·ν) dA|,
/// Γ_i the part of the support that faces the opposite surface. At a fixed ξ the distance changes by
///   δh = ν·(δx_s − δx_m − h δn)/(n·ν),
/// whichever material point x_m is, so that the row of a point is known in closed form:
///   D_i ∂ḡ_i/∂x = ∫ψ_i φˢ_j ν/(n·ν),  −∫ψ_i φᵐ_k∘Π ν/(n·ν),  −Σ_facets (∂n/∂x)ᵀ ∫ψ_i h ν/(n·ν)
/// on the nodes of the own surface, of the opposite one, and of the facets' normals. No rigid motion of both bodies
/// changes g_i: rows have neither resultant nor moment about where nodes are. Divided by that length their part on the
/// own body is a unit vector, so that a reaction is the force on the body. Places that are seen at grazing angles count
/// for less, by a smooth function of n·ν that is 1 up to 45 degrees: those of the sides at a corner come and go. What
/// the change of that function, of the length and of the rim of Γ_i does is left out: it is multiplied by gaps, which
/// are small where a force acts.
namespace ricochet {

/// Three coordinates, the third 0 in two dimensions.
using SlidingVector = Eigen::Vector3d;

/// Where a node is; `nodes`: reference positions, d × count.
[[nodiscard]] inline SlidingVector place_of(const Points& nodes, Index node, const Vector& displacement) {
  const Index d = nodes.rows();
  SlidingVector result = SlidingVector::Zero();
  result.head(d) = nodes.col(node) + displacement.segment(node * d, d);
  return result;
}

/// What a contact point sees at one displacement.
struct SlidingView {
  using Weights = std::vector<std::pair<Index, double>>;
  using Vectors = std::vector<std::pair<Index, SlidingVector>>;

  bool faces = false;       ///< false: nothing, and what follows is empty
  double gap = 0.0;         ///< g_i
  SlidingVector direction;  ///< of the force on the own body, of length 1
  Weights own, opposite;    ///< c_ij and m_ik, ascending by nodes; of views with rows
  Vectors row;              ///< ∂g_i/∂x per node, ascending
};

class SlidingPair {
 public:
  struct Point {
    Index number = 0;  ///< among all contact points
    Multiplier multiplier;
    TurningNormal normal;           ///< of the facets around it, into the body
    double offset = 0.0;            ///< added to the gap
    std::array<bool, 3> is_free{};  ///< components that no support holds
  };
  struct Data {
    Body body;
    std::string multipliers;  ///< the space's name
    std::vector<Index> facets, opposite_facets;
    std::vector<Point> points;
    bool is_one_of_many = false;  ///< ContactPair::is_one_of_many

    /// Both are one surface, whose facets do not see those within two rings around them.
    [[nodiscard]] bool is_self() const { return facets == opposite_facets; }
  };

  /// Keeps what the body points to.
  explicit SlidingPair(Data data);
  ~SlidingPair();
  SlidingPair(const SlidingPair&) = delete;
  SlidingPair& operator=(const SlidingPair&) = delete;

  [[nodiscard]] const Data& data() const;
  [[nodiscard]] const std::vector<Point>& points() const { return data().points; }
  [[nodiscard]] bool is_self() const;
  /// Where both surfaces are one: how deep the place that sees least sees into itself.
  [[nodiscard]] double sight() const;
  /// Of the displacement.
  [[nodiscard]] int degree() const;
  [[nodiscard]] int dimension() const;
  /// Of both surfaces, ascending.
  [[nodiscard]] const std::vector<Index>& nodes() const;
  /// The least height of the cells behind the facets.
  [[nodiscard]] double height() const;
  /// The unit normal of the facets around a point, into the body.
  [[nodiscard]] SlidingVector normal(std::size_t point, const Vector& displacement) const;

  enum class Wanted { gap, row };
  /// What the points see, of those that are not left out (empty: all): `views` has one for each. Overlaps deeper than
  /// half a cell are none, but for points of `any_depth` (empty: none). Where both surfaces are one, overlaps deeper
  /// than a quarter of the body's thickness at the start are none, for every point.
  void look(const Vector& displacement, Wanted wanted, const std::vector<char>& left_out,
            const std::vector<char>& any_depth, std::vector<SlidingView>& views) const;

  /// What a node of the own surface sees along a direction (unit, into its body): the distance; NaN: nothing.
  [[nodiscard]] double node_gap(Index node, const SlidingVector& direction, const Vector& displacement) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// The longest way that a node of the pair goes between two displacements of all nodes; of a surface that touches
/// itself beside its mean motion. Which of its points may touch decides which of them stand for others, and must not
/// depend on who looks on.
[[nodiscard]] double longest_way(const SlidingPair& pair, const Vector& to, const Vector& from);

/// Of a surface that touches itself: parts that come nearer by more in a step than it sees into itself may pass through
/// each other unseen. Warns, and is true, where they may.
bool warn_of_blind_step(const SlidingPair& pair, const Vector& to, const Vector& from);

}  // namespace ricochet
