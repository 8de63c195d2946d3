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

/// @file Bodies that go through themselves.
namespace ricochet {

/// A body of which one part was found inside of another.
struct BodyInItself {
  int body = 0;
  DeepestPoint deepest;                      ///< of the nodes that no contact keeps out
  std::array<Index, 3> own{-1, -1, -1};      ///< nodes of the facet around that node that faces what it went through
  std::array<Index, 3> through{-1, -1, -1};  ///< nodes of the facet that it went through
  DeepestPoint at_contact;                   ///< of those that a contact of the body with itself keeps out
  int contact = -1;                          ///< index of that ContactPair
};

/// Looks for nodes of a body's boundary inside of another part of the same body (SelfOverlap): at the start, at the
/// end, and when nodes have moved by a fortieth of an edge against each other, as far as a share of the steps' time
/// pays for it (an estimate from sizes, so that nothing depends on the clock). Overlaps of the start are those of
/// facets that stand for curved surfaces, if they are no deeper than half an edge, and are allowed from then on. So are
/// half a facet where a contact keeps the two parts apart in the mean, and what flat pieces miss of a curved facet.
/// Nodes of tied facets are left out, as what they lie in is tied to them, and so are those of sharp notches and edges.
class SelfWatch {
 public:
  /// Share of the steps' time that all looks together take.
  static constexpr double share = 0.01;

  /// `step_work`: as of PeakStress; infinite: every look that is due is taken. Looks at nothing where there are several
  /// processes, of which none has all of the boundary.
  SelfWatch(const Body& body, const SemidiscreteProblem& problem, const std::vector<ContactPair>& pairs,
            const BodiesOfMesh& bodies, double step_work);
  void save(Snapshot& snapshot, const std::string& name) const;
  void load(const Snapshot& snapshot, const std::string& name);

  /// Gaps of the nodes of the contact boundary, at the displacement that is looked at.
  using NodeGaps = std::function<const Vector&()>;

  /// After a step; `now`: whatever has moved (which changes nothing of when the next look is due). Allocates nothing.
  void look(const Vector& displacement, double time, bool now, const NodeGaps& gaps);

  /// One of each body; those that were found have deepest.found() or at_contact.found().
  [[nodiscard]] const std::vector<BodyInItself>& bodies() const { return found_; }
  [[nodiscard]] bool watches() const { return !parts_.empty(); }
  [[nodiscard]] long looks() const { return looks_; }
  /// How far a node has gone between two looks beside a rigid motion of its body, at most, in mean edges, where parts
  /// that faced each other were near enough to meet by that: those that go through each other and out again meanwhile
  /// are not found.
  [[nodiscard]] double unseen_motion() const;

 private:
  /// A contact of the body with itself at a node.
  struct Side {
    int contact = -1;
    bool own = false, opposite = false;  ///< which of the two surfaces the node is on
    Index entry = -1;                    ///< in ContactBoundary::nodes
    double allowance = 0.0;              ///< half of the largest facet of the two
  };
  struct Facet {
    CellShape shape;
    std::vector<Index> nodes;  ///< vertices first
  };
  /// A body.
  struct Part {
    explicit Part(BodySurface own_surface) : surface(std::move(own_surface)) {}
    BodySurface surface;
    std::vector<Facet> facets;
    std::vector<std::size_t> facet_of_piece;
    std::vector<std::vector<Side>> sides;  ///< per node of the surface
    std::vector<char> is_left_out;         ///< likewise
    Vector at_start;                       ///< likewise, how deep it was
    Vector seen;                           ///< displacement at the last look, d per node
    double unseen = 0.0;                   ///< see unseen_motion()
    double clearance = 0.0;                ///< of nodes from surfaces that face them, at the last look, at least
    double size = 0.0, work = 0.0;         ///< work of a look, in that of reading a number
  };
  [[nodiscard]] Part make_part(const Body& body, const std::vector<CellFacet>& facets, double size) const;
  void take_contacts(const Body& body, const ContactBoundary& contact, const std::vector<ContactPair>& pairs,
                     Part& part) const;
  [[nodiscard]] double strain_since(const Part& part, const Vector& displacement) const;
  void enter_unseen(Part& part, const Vector& displacement) const;
  [[nodiscard]] bool is_due(const Part& part, double limit, const Vector& displacement) const;
  void look_at(std::size_t number, const Vector& displacement, double time, const NodeGaps& gaps);
  /// The contact that keeps a node apart from a piece; null: there is none.
  [[nodiscard]] static const Side* contact_at(const Part& part, int node, int piece);
  /// Distance of flat pieces from the curved facet that they stand for.
  [[nodiscard]] double bend_of(const Facet& facet, const Vector& displacement) const;
  [[nodiscard]] std::array<Index, 3> nodes_of(const Part& part, int piece) const;

  const Points& positions_;
  bool axisymmetric_;
  std::vector<Part> parts_;                   ///< of each body
  std::vector<BodyInItself> found_;           ///< likewise
  double work_per_step_ = 0.0, saved_ = 0.0;  ///< that looks may do, and of that what is left
  long looks_ = 0;
  int contacts_;  ///< number of ContactPairs
};

}  // namespace ricochet
