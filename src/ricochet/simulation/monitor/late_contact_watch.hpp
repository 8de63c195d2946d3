#pragma once

#include <vector>

#include "ricochet/base/snapshot.hpp"
#include "ricochet/contact/contact_boundary.hpp"
#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/scheme/state.hpp"

/// @file Bodies that overlap without a contact force. Gaps between bodies are means over facets: if a corner or a ridge
/// of one side meets larger facets of the other, contact begins when the mean closes, which is late, or never.
namespace ricochet {

class LateContactWatch {
 public:
  /// Keeps references to problem and pairs.
  LateContactWatch(const Body& body, const SemidiscreteProblem& problem, const std::vector<ContactPair>& pairs);
  void persist(const SnapshotVisitor& visit);

  /// Checks the starting state and the state after every step: warns, once, of each contact between bodies that carries
  /// no force while one of its nodes is inside the other body by more than a tenth of the largest facet there.
  void check(const State& state);

 private:
  struct Node {
    Index entry = 0;         ///< in ContactBoundary::nodes
    double allowance = 0.0;  ///< admissible depth
  };
  struct Contact {
    std::size_t number = 0;
    std::vector<Index> points;
    std::vector<Node> nodes;
    bool is_warned = false;
  };
  void warn(const Contact& contact, Index entry, double time) const;

  const SemidiscreteProblem& problem_;
  const std::vector<ContactPair>& pairs_;
  std::vector<Contact> contacts_;
  Vector gap_;
};

}  // namespace ricochet
