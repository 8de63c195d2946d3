#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>
#include <string>

#include "ricochet/base/error.hpp"
#include "ricochet/solver/delassus/delassus_problem.hpp"

// Errors of contact problems without a solution, or for which none was found.

namespace ricochet {

/// Names the positions and the contacts, by their numbers in the case and the normals of their obstacles.
void DelassusProblem::throw_contradiction(const std::vector<Index>& contradiction) const {
  const auto as_text = [](const auto& vector) {
    std::string text;
    for (const double component : vector) text += fmt::format("{}{:.6g}", text.empty() ? "" : ", ", component);
    return "(" + text + ")";
  };
  std::set<std::string> positions, contacts;
  bool between_bodies = false;
  for (const Index candidate : contradiction) {
    const Index point = candidates_.points()[std::size_t(candidate)];
    Vector at = Vector::Zero(problem_.dimension);
    problem_.contact.visit_own_nodes(point,
                                     [&](Index node, double weight) { at += weight * problem_.nodes.col(node); });
    positions.insert(as_text(at));
    between_bodies = between_bodies || problem_.contact.between_bodies(point);
    contacts.insert(fmt::format("contact.{} (normal {})", problem_.contact.pair[std::size_t(point)],
                                as_text(rows_->normals.col(point))));
  }
  constexpr std::size_t shown = 3;
  std::vector<std::string> some(positions.begin(), positions.end());
  const std::size_t more = some.size() > shown ? some.size() - shown : 0;
  some.resize(some.size() - more);
  const bool one = contacts.size() == 1;
  const std::string where =
      fmt::format("{}{}", fmt::join(some, ", "), more > 0 ? fmt::format(" and {} more positions", more) : "");
  // The conditions of an iteration may have no solution although the step has one.
  const ErrorKind kind = problem_.internal_force->is_linear() ? ErrorKind::invalid_input : ErrorKind::not_converged;
  if (between_bodies) {
    throw Error(
        kind,
        fmt::format("no motion meets the conditions of contact: at {} (reference position) bodies would simultaneously "
                    "have to be outside their counterparts in {}{}; {}",
                    where, fmt::join(contacts, ", "),
                    one ? " and in the positions where supports hold them" : ", which leaves them no room",
                    one ? "change the supports"
                        : "leave more room between them, change the supports or the motion of obstacles, or remove one "
                          "of these contacts"));
  }
  throw Error(
      kind,
      fmt::format("no motion meets the conditions of contact: the body at {} (reference position) would simultaneously "
                  "have to be outside the {} of {}{}; {}",
                  where, one ? "obstacle" : "obstacles", fmt::join(contacts, ", "),
                  one ? " and in the position where supports hold it" : ", which leave it no room",
                  one ? "change the supports or the obstacle's motion"
                      : "leave more room between them, end their motion earlier, or remove one of these contacts"));
}

void DelassusProblem::throw_not_solved() const {
  if (!contact_solution_.contradiction.empty()) throw_contradiction(contact_solution_.contradiction);
  const bool tresca = ((bound_.array() > 0.0) && (coefficient_.array() == 0.0)).any();
  const char* const advice =
      tresca ? "; with a friction_bound alone a step may have no solution: set a friction coefficient as well" : "";
  throw Error(
      ErrorKind::not_converged,
      fmt::format("the contact problem{} of {} points was not solved in {} iterations (relative residual {:.3g}): "
                  "{}{}",
                  friction_ ? " with friction" : "", contact_.points(), contact_solution_.iterations,
                  contact_solution_.residual, contact_solution_.reason, advice));
}

}  // namespace ricochet
