#pragma once

#include <functional>
#include <unordered_map>
#include <vector>

#include "ricochet/base/expression.hpp"
#include "ricochet/base/types.hpp"

/// @file External loads and prescribed displacements as functions of time.
namespace ricochet {

/// Load L(t) = constant part + varying part. The constant part has the potential −LᵀU; the
/// varying part does external work.
class Loads {
 public:
  explicit Loads(Index dofs = 0) : constant_(Vector::Zero(dofs)) {}

  [[nodiscard]] const Vector& constant() const { return constant_; }
  void add_constant(const Vector& load) { constant_ += load; }
  /// Adds amplitude(t) · pattern.
  void add_separable(Vector pattern, Expression amplitude);
  /// Adds a load that is integrated anew at every instant: `add` adds it to its argument.
  void add_general(std::function<void(double time, Vector& load)> add);

  [[nodiscard]] bool varies() const { return !separable_.empty() || !general_.empty(); }
  /// Computes the varying part at an instant (zero if there is none).
  void varying(double time, Vector& load) const;
  /// Computes the sum of the constant and the varying part.
  void total(double time, Vector& load) const;

 private:
  struct Separable {
    Vector pattern;
    Expression amplitude;
  };
  Vector constant_;
  std::vector<Separable> separable_;
  std::vector<std::function<void(double, Vector&)>> general_;
};

/// Dofs whose displacement is prescribed.
class Supports {
 public:
  /// Prescribes one dof. Returns false and changes nothing if it is already prescribed.
  bool add(Index dof, const Expression& value);
  /// Sorts the dofs; must be called once after the last add().
  void finish();

  [[nodiscard]] Index size() const { return Index(dofs_.size()); }
  [[nodiscard]] const std::vector<Index>& dofs() const { return dofs_; }
  [[nodiscard]] bool contains(Index dof) const;
  /// Expression of a prescribed dof.
  [[nodiscard]] const Expression& expression(Index dof) const;
  /// Computes the prescribed displacements at an instant, in the order of dofs().
  void values(double time, Vector& values) const;
  /// Computes velocity and acceleration at an instant t ≥ 0 by second-order one-sided differences with spacing h
  /// (evaluated only at times ≥ t, so that formulas may start at t = 0).
  void derivatives(double time, double spacing, Vector& velocity, Vector& acceleration) const;
  /// Work Σ of the reactions, in the order of dofs(), on an increment of all dofs.
  [[nodiscard]] double work(const Vector& reaction, const Vector& increment) const;

 private:
  std::vector<Index> dofs_;
  std::vector<std::size_t> expression_;  ///< index, per dof
  std::unordered_map<Index, std::size_t> expression_of_dof_;
  std::vector<Expression> expressions_;
};

}  // namespace ricochet
