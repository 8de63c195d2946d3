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

/// @file Bodies of one mesh that go through each other.
namespace ricochet {

/// Two bodies of which one was found inside of the other.
struct BodyPair {
  int first = 0, second = 0;  ///< numbers of the bodies; `first` < `second`
  DeepestPoint deepest;       ///< a node of either that no contact keeps out
  DeepestPoint at_contact;    ///< a node of either that a contact keeps out, deeper than its allowance
  int contact = -1;           ///< index of that ContactPair
};

/// Looks for nodes of one body inside of the surface of another. It looks at the start, and then whenever nodes have
/// moved so far that what was apart may have met, or that bodies that are near each other may have moved by a quarter
/// of an edge of their boundary against each other: none of them gets deeper than that unseen. Nodes of a contact
/// between the two may be inside by their allowance, since its conditions hold in the mean over facets, and by the gap
/// that the contact itself sees there, which some schemes let become negative: beyond that their pairing is wrong.
class BodyWatch {
 public:
  /// `positions`: d × nodes; `size`: of the body that a node belongs to, per node; `kept`: the nodes of contacts.
  BodyWatch(const Points& positions, const std::vector<CellBlock>& cells, const std::vector<CellFacet>& boundary,
            const ConnectedBodies& bodies, const std::vector<double>& size, const std::vector<KeptNode>& kept = {});
  void save(Snapshot& snapshot, const std::string& name) const;
  void load(const Snapshot& snapshot, const std::string& name);

  /// Of the nodes of the contact boundary, at the displacement that is looked at.
  using NodeGaps = std::function<const Vector&()>;

  /// After a step; `now`: whatever has moved (which changes nothing of when the next look is due). Asks for gaps where
  /// it looks and there are nodes of contacts. Allocates nothing, unless bodies are found that have met.
  void look(const Vector& displacement, double time, bool now, const NodeGaps& gaps = {});

  [[nodiscard]] const std::vector<BodyPair>& pairs() const { return pairs_; }
  [[nodiscard]] long looks() const { return looks_; }

 private:
  [[nodiscard]] bool is_due(const Vector& displacement) const;
  /// Returns a distance that they are apart by, at least; 0 where they are not.
  double look_at(int first, int second, double time);
  double look_at_nodes(int of, int inside, double time);
  void take_kept(const std::vector<KeptNode>& kept, const ConnectedBodies& bodies);
  [[nodiscard]] bool has_found(int first, int second) const;
  BodyPair& pair_of(int first, int second);

  const Points& positions_;
  std::vector<BodySurface> surfaces_;  ///< one of each body; none where there is one body only
  std::vector<double> size_;           ///< of each body
  std::vector<BodyPair> pairs_;        ///< that have met
  /// What a contact allows a node of a surface in another body.
  struct Kept {
    double allowance = 0.0;  ///< 0: no contact keeps it out
    int contact = -1;
    Index entry = -1;
    [[nodiscard]] double depth_allowed(const Vector& gap) const;
  };
  const Vector* gap_ = nullptr;                            ///< of nodes of contacts, while it looks
  std::map<std::pair<int, int>, std::vector<Kept>> kept_;  ///< (body of the node, other body) → per node of its surface
  double resolution_ = 0.0;   ///< relative motion between two looks at bodies that are near each other
  std::vector<Index> nodes_;  ///< of all surfaces
  Vector seen_;               ///< their displacement at the last look, d per node
  double free_way_ = 0.0;     ///< how far a node may move before the next one
  long looks_ = 0;
};

}  // namespace ricochet
