#pragma once

#include <array>
#include <functional>
#include <utility>
#include <vector>

#include "ricochet/base/snapshot.hpp"
#include "ricochet/fem/connected_bodies.hpp"
#include "ricochet/mesh/cell_type.hpp"
#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/simulation/monitor/deepest_point.hpp"
#include "ricochet/simulation/monitor/facet_sizes.hpp"
#include "ricochet/simulation/monitor/self_overlap.hpp"

/// @file Bodies that penetrate themselves.
namespace ricochet {

/// Body of which one part was found inside another part.
struct SelfPenetration {
  int body = 0;
  DeepestPoint deepest;                      ///< of the nodes without a contact
  std::array<Index, 3> own{-1, -1, -1};      ///< nodes of the facet at that node which faces `through`
  std::array<Index, 3> through{-1, -1, -1};  ///< nodes of the facet that the node passed through
  DeepestPoint at_contact;                   ///< of the nodes at a contact of the body with itself
  int contact = -1;                          ///< index of that ContactPair
};

/// Searches for nodes of a body's boundary inside another part of the same body (SelfOverlap): at the start, at the
/// end, and when nodes have moved by a fortieth of an edge relative to each other, within a share of the time of the
/// steps (estimated from sizes, so that nothing depends on the clock). Overlaps at the start that are no deeper than
/// half an edge are attributed to facets that approximate curved surfaces, and are tolerated from then on. Also
/// tolerated are half a facet where a contact keeps the two parts apart in the mean, and the distance of flat pieces
/// from a curved facet. Nodes of tied facets are excluded, since they are tied to what they lie in, and so are those of
/// sharp notches and edges.
class SelfWatch {
 public:
  /// Share of all checks in the time of the steps.
  static constexpr double share = 0.01;

  /// `step_work`: as for PeakStress; if infinite, all checks that are due are performed. On several ranks nothing is
  /// checked, as none has the whole boundary.
  SelfWatch(const Body& body, const SemidiscreteProblem& problem, const std::vector<ContactPair>& pairs,
            const BodiesOfMesh& bodies, double step_work);
  void save(Snapshot& snapshot, const std::string& name) const;
  void load(const Snapshot& snapshot, const std::string& name);

  /// Gaps of the nodes of the contact boundary at the displacement that is checked.
  using NodeGaps = std::function<const Vector&()>;

  /// Checks the bodies after a step if a check is due, or if `now` (which leaves the next due check unchanged).
  /// Allocates nothing.
  void check(const Vector& displacement, double time, bool now, const NodeGaps& gaps);

  /// One entry per body; bodies with self-penetration have deepest.found() or at_contact.found().
  [[nodiscard]] const std::vector<SelfPenetration>& bodies() const { return found_; }
  [[nodiscard]] bool watches() const { return !parts_.empty(); }
  [[nodiscard]] long checks() const { return checks_; }
  /// Largest distance, in mean edges, that a node has moved between two checks relative to a rigid motion of its body,
  /// counted only if parts that faced each other were near enough to meet by it: parts that pass into each other and
  /// out again within this distance are not detected.
  [[nodiscard]] double ignored_motion() const;

 private:
  /// Contact of the body with itself at a node.
  struct Side {
    int contact = -1;
    bool own = false, opposite = false;  ///< the surface or surfaces on which the node is
    Index entry = -1;                    ///< in ContactBoundary::nodes
    double allowance = 0.0;              ///< half of the largest facet of both surfaces
  };
  struct Facet {
    CellShape shape;
    std::vector<Index> nodes;  ///< vertices first
  };
  /// Body and its surface.
  struct Part {
    explicit Part(BodySurface own_surface) : surface(std::move(own_surface)) {}
    BodySurface surface;
    std::vector<Facet> facets;
    std::vector<std::size_t> facet_of_piece;
    std::vector<std::vector<Side>> sides;  ///< per node of the surface
    std::vector<char> is_left_out;         ///< likewise
    Vector at_start;                       ///< likewise, initial depth
    Vector last_displacement;              ///< displacement at the last check, d per node
    double ignored = 0.0;                  ///< see ignored_motion()
    double clearance = 0.0;                ///< least distance of nodes from surfaces that they face, at the last check
    double size = 0.0, work = 0.0;         ///< `work`: of a check, relative to reading a number
  };
  [[nodiscard]] Part make_part(const Body& body, const std::vector<CellFacet>& facets, double size) const;
  void set_contacts(const Body& body, const ContactBoundary& contact, const std::vector<ContactPair>& pairs,
                    Part& part) const;
  [[nodiscard]] double strain_since(const Part& part, const Vector& displacement) const;
  void enter_ignored(Part& part, const Vector& displacement) const;
  [[nodiscard]] bool is_due(const Part& part, double limit, const Vector& displacement) const;
  void check_body(std::size_t number, const Vector& displacement, double time, const NodeGaps& gaps);
  /// Contact that keeps a node apart from a piece; null if none.
  [[nodiscard]] static const Side* contact_at(const Part& part, int node, int piece);
  /// Distance between the flat pieces and the curved facet that they approximate.
  [[nodiscard]] double bend_of(const Facet& facet, const Vector& displacement) const;
  [[nodiscard]] std::array<Index, 3> nodes_of(const Part& part, int piece) const;

  const Points& positions_;
  bool axisymmetric_;
  std::vector<Part> parts_;                         ///< per body
  std::vector<SelfPenetration> found_;              ///< likewise
  double work_per_step_ = 0.0, work_budget_ = 0.0;  ///< admissible work of checks, and the unused part
  long checks_ = 0;
  int contacts_;  ///< number of ContactPairs
};

}  // namespace ricochet
