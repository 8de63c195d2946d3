#pragma once

#include <string>
#include <vector>

#include "ricochet/simulation/monitor/body_watch.hpp"
#include "ricochet/simulation/monitor/obstacle_watch.hpp"
#include "ricochet/simulation/monitor/penetration_report.hpp"
#include "ricochet/simulation/monitor/self_watch.hpp"
#include "ricochet/simulation/monitor/tunnelling_watch.hpp"

/// @file Penetration that no contact prevents: the whole boundary against every obstacle, bodies against each other and
/// against themselves.
namespace ricochet {

/// Obstacle and its name in the case.
struct NamedObstacle {
  std::string name;
  const Obstacle* obstacle = nullptr;
};

class PenetrationWatch {
 public:
  /// Keeps references to body and problem.
  PenetrationWatch(const Body& body, const SemidiscreteProblem& problem, const std::vector<ContactPair>& pairs,
                   const std::vector<NamedObstacle>& obstacles);
  /// As above, with known bodies. `step_work`: work of a step, of which checks for self-penetration may take a share
  /// (SelfWatch).
  PenetrationWatch(const Body& body, const SemidiscreteProblem& problem, const std::vector<ContactPair>& pairs,
                   const std::vector<NamedObstacle>& obstacles, BodiesOfMesh bodies, double step_work);
  void persist(const SnapshotVisitor& visit);

  /// Checks the starting state and the state after every step. Warns, once, of each obstacle, contact and pair of
  /// bodies. Allocates nothing if there is nothing to report.
  void check(const State& state);
  /// Checks the state after each part of a divided step, before check(): within the whole step a node may move round an
  /// edge.
  void check_part(const State& state) { passages_.check(state); }
  /// Checks the last state in addition: bodies even if none has moved far.
  void check_end(const State& state);

  /// Current report. A continuing run requests it repeatedly, so its cost does not grow with the mesh.
  [[nodiscard]] PenetrationReport report() const;

 private:
  /// Group of boundary facets of the mesh.
  struct BoundaryGroup {
    std::string name;
    std::vector<Index> nodes;  ///< sorted
  };
  [[nodiscard]] bool is_on_boundary(Index node) const;
  [[nodiscard]] std::vector<std::string> groups_of(Index node) const;
  [[nodiscard]] std::vector<double> coordinates_of(const Eigen::Vector3d& position) const;
  [[nodiscard]] UnwatchedPenetration describe(const DeepestPoint& deepest, const std::vector<int>& bodies) const;
  [[nodiscard]] UnwatchedPenetration in_obstacle(std::size_t obstacle) const;
  [[nodiscard]] UnwatchedPenetration through_obstacle(std::size_t obstacle) const;
  [[nodiscard]] UnwatchedPenetration of_pair(const BodyPair& pair) const;
  [[nodiscard]] UnwatchedPenetration at_contact(const BodyPair& pair) const;
  [[nodiscard]] UnwatchedPenetration self_penetration(const SelfPenetration& found) const;
  [[nodiscard]] UnwatchedPenetration self_penetration_at_contact(const SelfPenetration& found) const;
  /// Boundary groups of the mesh to which all nodes of a facet belong; node −1 is absent.
  [[nodiscard]] std::vector<std::string> groups_of_facet(const std::array<Index, 3>& nodes) const;
  [[nodiscard]] std::vector<const ContactPair*> contacts_between(int first, int second) const;
  void warn_of(const BodyPair& pair) const;
  void warn_at_contact(const BodyPair& pair) const;
  [[nodiscard]] ContactBeyondRim beyond(const RimContact& rim) const;
  /// Advice on a node that enters an obstacle without a contact.
  [[nodiscard]] std::string advice(std::size_t obstacle) const;
  void check_bodies(const State& state, bool now);
  void warn();
  void warn_of_bodies();
  void warn_of_self_penetration();
  void warn_of(const SelfPenetration& found) const;
  void warn_at_contact(const SelfPenetration& found) const;
  /// Lines of a case that define a contact which keeps a body out of itself.
  [[nodiscard]] std::string contact_with_itself(int body, const UnwatchedPenetration& found) const;

  const Body& body_;
  const std::vector<ContactPair>& pairs_;
  std::vector<NamedObstacle> named_;
  BodiesOfMesh bodies_;
  std::vector<double> size_;  ///< per node, of its body
  ObstacleWatch obstacles_;
  TunnellingWatch passages_;
  BodyWatch body_watch_;
  SelfWatch self_watch_;
  const SemidiscreteProblem& problem_;
  Vector node_gap_;
  std::vector<BoundaryGroup> boundary_groups_;
  long checks_ = 0;
  // Warnings that have been logged.
  std::vector<char> obstacle_warned_, tunnelling_warned_;
  std::size_t rims_warned_ = 0;
  std::vector<char> pairs_warned_, contacts_warned_;  ///< per pair of bodies
  std::vector<char> self_penetration_warned_, self_contact_warned_;
};

}  // namespace ricochet
