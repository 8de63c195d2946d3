#pragma once

#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "ricochet/base/snapshot.hpp"
#include "ricochet/fem/connected_bodies.hpp"
#include "ricochet/mesh/boundary_facets.hpp"
#include "ricochet/simulation/monitor/body_surface.hpp"
#include "ricochet/simulation/monitor/deepest_point.hpp"
#include "ricochet/simulation/monitor/facet_sizes.hpp"

/// @file Interpenetration of the bodies of a mesh.
namespace ricochet {

/// Two bodies, one of which was found inside the other.
struct BodyPair {
  int first = 0, second = 0;  ///< numbers of the bodies; `first` < `second`
  DeepestPoint deepest;       ///< a node of either without a contact against penetration
  DeepestPoint at_contact;    ///< a node of either at a contact, deeper than its allowance
  int contact = -1;           ///< index of that ContactPair

  [[nodiscard]] auto members() { return std::tie(first, second, contact, deepest, at_contact); }
};

/// Searches for nodes of one body inside the surface of another: at the start, and then whenever nodes have moved so
/// far that separated bodies may have met, or that neighbouring bodies may have moved by a quarter of an edge of their
/// boundary relative to each other, so that no body gets deeper than that undetected. Nodes of a contact between the
/// two may be inside by their allowance, since its conditions hold in the mean over facets, and by the gap that the
/// contact itself has there, which some schemes let become negative: if they are deeper, their pairing is wrong.
class BodyWatch {
 public:
  /// `positions`: d × nodes; `size`: per node, of the body to which it belongs; `node_allowances`: the nodes of
  /// contacts.
  BodyWatch(const Points& positions, const std::vector<CellBlock>& cells, const std::vector<CellFacet>& boundary,
            const ConnectedBodies& bodies, const std::vector<double>& size,
            const std::vector<ContactNodeAllowance>& node_allowances = {});
  void persist(const SnapshotVisitor& visit);

  /// Gaps of the nodes of the contact boundary at the displacement that is checked.
  using NodeGaps = std::function<const Vector&()>;

  /// Checks the bodies after a step if a check is due, or if `now` (which leaves the next due check unchanged). Calls
  /// `gaps` if it checks and there are nodes of contacts. Allocates nothing unless an overlap is found.
  void check(const Vector& displacement, double time, bool now, const NodeGaps& gaps = {});

  [[nodiscard]] const std::vector<BodyPair>& pairs() const { return pairs_; }
  [[nodiscard]] long checks() const { return checks_; }

 private:
  [[nodiscard]] bool is_due(const Vector& displacement) const;
  /// Returns a lower bound of the distance between two bodies; 0 if they are not separated.
  double check_pair(int first, int second, double time);
  double check_nodes(int of, int inside, double time);
  void set_allowances(const std::vector<ContactNodeAllowance>& node_allowances, const ConnectedBodies& bodies);
  [[nodiscard]] bool has_found(int first, int second) const;
  BodyPair& pair_of(int first, int second);

  const Points& positions_;
  std::vector<BodySurface> surfaces_;  ///< one per body; empty if there is only one body
  std::vector<double> size_;           ///< per body
  std::vector<BodyPair> pairs_;        ///< pairs of overlapping bodies
  /// Allowance of a contact for a surface node inside another body.
  struct Allowance {
    double allowance = 0.0;  ///< 0: no contact
    int contact = -1;
    Index entry = -1;
    [[nodiscard]] double depth_allowed(const Vector& gap) const;
  };
  const Vector* gap_ = nullptr;  ///< gaps of contact nodes during a check
  std::map<std::pair<int, int>, std::vector<Allowance>>
      allowances_;            ///< (body of the node, other body) → per surface node
  double resolution_ = 0.0;   ///< relative motion of neighbouring bodies between two checks
  std::vector<Index> nodes_;  ///< of all surfaces
  Vector last_displacement_;  ///< displacement at the last check, d per node
  double free_way_ = 0.0;     ///< distance that a node may move before the next check
  long checks_ = 0;
};

}  // namespace ricochet
