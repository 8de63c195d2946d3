#pragma once

#include <array>
#include <functional>
#include <utility>
#include <vector>

#include "ricochet/base/snapshot.hpp"
#include "ricochet/fem/connected_bodies.hpp"
#include "ricochet/mesh/shapes/cell_shape.hpp"
#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/simulation/monitor/deepest_point.hpp"
#include "ricochet/simulation/monitor/facet_sizes.hpp"
#include "ricochet/simulation/monitor/self_overlap.hpp"

/// @file Bodies that penetrate themselves.
namespace ricochet {

/// Body a region of which was found inside another region of it.
struct SelfPenetration {
  int body = 0;
  DeepestPoint deepest;  ///< of the nodes without a contact
  /// Nodes of the flat piece of a facet at that node which faces `through` most.
  std::array<Index, 3> own{-1, -1, -1};
  std::array<Index, 3> through{-1, -1, -1};  ///< nodes of the flat piece that the node passed through
  DeepestPoint at_contact;                   ///< of the nodes at a contact of the body with itself
  int contact = -1;                          ///< index of that ContactPair

  [[nodiscard]] auto members() { return std::tie(deepest, at_contact, contact, own, through); }
};

/// Searches for nodes of a body's boundary inside another region of the same body (SelfOverlap): at the start, at the
/// end, and when two nodes may have approached each other by a fortieth of an edge, within a share of the time of the
/// steps (estimated from sizes, so that nothing depends on the clock). Overlaps at the start that are no deeper than
/// half an edge are attributed to facets that approximate curved surfaces, and up to twice that depth is tolerated from
/// then on. Also tolerated are the distance of flat pieces from a curved facet and, where a contact of the body with
/// itself keeps two regions apart in the mean, half a facet and the penetration of that contact. Nodes of tied facets
/// are excluded, since they are tied to what they lie in, and so are those of sharp notches and edges.
class SelfWatch {
 public:
  /// Largest share of all checks in the time of the steps.
  static constexpr double share = 0.01;

  /// `step_work`: as for PeakStress; if infinite, all checks that are due are performed. On several ranks nothing is
  /// checked, as none has the whole boundary.
  SelfWatch(const Body& body, const SemidiscreteProblem& problem, const std::vector<ContactPair>& pairs,
            const BodiesOfMesh& bodies, double step_work);
  void persist(const SnapshotVisitor& visit);

  /// Gaps of the nodes of the contact boundary at the displacement that is checked.
  using NodeGaps = std::function<const Vector&()>;

  /// Checks the bodies after a step if a check is due, or if `now` (which leaves the next due check unchanged).
  /// Allocates nothing.
  void check(const Vector& displacement, double time, bool now, const NodeGaps& gaps);

  /// One entry per body; bodies with self-penetration have deepest.found() or at_contact.found().
  [[nodiscard]] const std::vector<SelfPenetration>& bodies() const { return found_; }
  [[nodiscard]] bool watches() const { return !watched_.empty(); }
  [[nodiscard]] long checks() const { return checks_; }
  /// Largest distance, in mean edges, that a node has moved between two checks relative to a rigid motion of its body.
  /// It counts only if twice of it exceeds the clearance at the check before. Regions that penetrate and separate again
  /// within this distance are not detected.
  [[nodiscard]] double ignored_motion() const;

 private:
  /// Contact of the body with itself of which a node is a member.
  struct NodeContact {
    int pair = -1;
    bool own = false, opposite = false;  ///< the surface or surfaces on which the node is
    Index entry = -1;                    ///< in ContactBoundary::nodes
    double allowance = 0.0;              ///< half of the largest facet of both surfaces
  };
  struct Facet {
    CellShape shape;
    std::vector<Index> nodes;  ///< vertices first
  };
  /// Nodes of a pair of surfaces in contact, before it is known on which bodies they are.
  struct PairNodes {
    bool is_tied = false;
    std::vector<Index> own, opposite;
    double allowance = 0.0;  ///< as in NodeContact
  };
  /// Body and its surface.
  struct WatchedBody {
    explicit WatchedBody(BodySurface own_surface) : surface(std::move(own_surface)) {}
    BodySurface surface;
    std::vector<Facet> facets;
    std::vector<std::size_t> facet_of_piece;
    std::vector<std::vector<NodeContact>> contacts;  ///< per node of the surface
    std::vector<char> is_left_out;                   ///< likewise
    Vector at_start;                                 ///< likewise, initial depth
    Vector last_displacement;                        ///< displacement at the last check, d per node
    double ignored = 0.0;                            ///< see ignored_motion()
    /// Least distance of nodes, along their normals, from surfaces that they face, at the last check.
    double clearance = 0.0;
    double size = 0.0;  ///< diameter, for rounding
    double work = 0.0;  ///< of a check, relative to reading a number
  };
  [[nodiscard]] WatchedBody watch_body(const Body& body, const std::vector<CellFacet>& facets, double size) const;
  static void set_contacts(const std::vector<PairNodes>& pairs, const ContactBoundary& boundary, WatchedBody& watched);
  /// Returns the largest distance that a node has moved since the last check relative to the rigid motion that is
  /// nearest to that of the surface: a body that flies and spins has not approached itself.
  [[nodiscard]] double largest_deformation_since(const WatchedBody& watched, const Vector& displacement) const;
  void enter_ignored(WatchedBody& watched, const Vector& displacement) const;
  [[nodiscard]] bool is_due(const WatchedBody& watched, double limit, const Vector& displacement) const;
  void check_body(std::size_t number, const Vector& displacement, double time, const NodeGaps& gaps);
  /// Contact that keeps a node apart from a piece; null if none.
  [[nodiscard]] static const NodeContact* contact_at(const WatchedBody& watched, int node, int piece);
  /// Distance between the flat pieces and the curved facet that they approximate.
  [[nodiscard]] double sagitta_of(const Facet& facet, const Vector& displacement) const;
  [[nodiscard]] bool fits(const SelfPenetration& found) const;
  [[nodiscard]] std::array<Index, 3> nodes_of(const WatchedBody& watched, int piece) const;

  const Points& positions_;
  bool axisymmetric_;
  std::vector<WatchedBody> watched_;                ///< per body
  std::vector<SelfPenetration> found_;              ///< likewise
  double work_per_step_ = 0.0, work_budget_ = 0.0;  ///< admissible work of checks, and the unused part
  long checks_ = 0;
  int pair_count_;  ///< number of ContactPairs
};

}  // namespace ricochet
