#include "ricochet/problem/loads.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace ricochet {

void Loads::add_separable(Vector pattern, Expression amplitude) {
  separable_.push_back({std::move(pattern), std::move(amplitude)});
}

void Loads::add_general(std::function<void(double, Vector&)> add) { general_.push_back(std::move(add)); }

void Loads::varying(double time, Vector& load) const {
  load.setZero(constant_.size());
  for (const Separable& part : separable_) load += part.amplitude(0.0, 0.0, 0.0, time) * part.pattern;
  for (const auto& add : general_) add(time, load);
}

void Loads::total(double time, Vector& load) const {
  varying(time, load);
  load += constant_;
}

bool Supports::add(Index dof, const Expression& value) {
  if (contains(dof)) return false;
  dofs_.push_back(dof);
  // Consecutive dofs of one support share their expression.
  if (expressions_.empty() || !(expressions_.back() == value)) expressions_.push_back(value);
  expression_.push_back(expressions_.size() - 1);
  expression_of_dof_[dof] = expressions_.size() - 1;
  return true;
}

void Supports::finish() {
  std::vector<std::size_t> order(dofs_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, [this](std::size_t a, std::size_t b) { return dofs_[a] < dofs_[b]; });
  std::vector<Index> dofs;
  std::vector<std::size_t> expression;
  for (const std::size_t i : order) {
    dofs.push_back(dofs_[i]);
    expression.push_back(expression_[i]);
  }
  dofs_ = std::move(dofs);
  expression_ = std::move(expression);
}

bool Supports::contains(Index dof) const { return expression_of_dof_.contains(dof); }

const Expression& Supports::expression(Index dof) const { return expressions_[expression_of_dof_.at(dof)]; }

void Supports::values(double time, Vector& values) const {
  values.resize(size());
  // One evaluation per run of dofs with the same expression.
  std::size_t evaluated = expressions_.size();
  double value = 0.0;
  for (std::size_t i = 0; i < dofs_.size(); ++i) {
    if (expression_[i] != evaluated) {
      evaluated = expression_[i];
      value = expressions_[evaluated](0.0, 0.0, 0.0, time);
    }
    values[Index(i)] = value;
  }
}

void Supports::derivatives(double time, double spacing, Vector& velocity, Vector& acceleration) const {
  Vector at[4];
  for (int k = 0; k < 4; ++k) values(time + k * spacing, at[k]);
  velocity = (-3.0 * at[0] + 4.0 * at[1] - at[2]) / (2.0 * spacing);
  acceleration = (2.0 * at[0] - 5.0 * at[1] + 4.0 * at[2] - at[3]) / (spacing * spacing);
}

double Supports::work(const Vector& reaction, const Vector& increment) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < dofs_.size(); ++i) sum += reaction[Index(i)] * increment[dofs_[i]];
  return sum;
}

}  // namespace ricochet
