#pragma once

#include <string>
#include <vector>

#include "ricochet/base/snapshot.hpp"
#include "ricochet/contact/contact_boundary.hpp"
#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/scheme/state.hpp"

/// @file Bodies that are inside each other though no force acts. Between bodies gaps are means over facets: a corner or
/// a ridge of one side against larger facets of the other is met when the mean closes, which is late, or never.
namespace ricochet {

class LateContactWatch {
 public:
  /// Keeps references to problem and pairs.
  LateContactWatch(const Body& body, const SemidiscreteProblem& problem, const std::vector<ContactPair>& pairs);
  void save(Snapshot& snapshot, const std::string& name) const;
  void load(const Snapshot& snapshot, const std::string& name);

  /// After every step, and of the starting state: warns, once, of each contact between bodies that carries no force
  /// while a node of it is inside of the other body by more than a tenth of the largest facet there.
  void look(const State& state);

 private:
  struct Node {
    Index entry = 0;         ///< in ContactBoundary::nodes
    double allowance = 0.0;  ///< how deep it may be inside
  };
  struct Contact {
    std::size_t number = 0;
    std::vector<Index> points;
    std::vector<Node> nodes;
    bool told = false;
  };
  void tell(const Contact& contact, Index entry, double time) const;

  const SemidiscreteProblem& problem_;
  const std::vector<ContactPair>& pairs_;
  std::vector<Contact> contacts_;
  Vector gap_;
};

}  // namespace ricochet
