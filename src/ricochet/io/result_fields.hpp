#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ricochet/fem/displacement_space.hpp"
#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/scheme/state.hpp"

/// @file The fields of a frame: their names, shapes and values, in the numbering of the mesh file.
namespace ricochet {

struct FieldLayout {
  std::string name;
  int components = 1;  ///< 1: scalar; 3: vector
  bool whole = false;  ///< whole numbers of 32 bits, else reals
  Index rows = 0;      ///< nodes
};

class ResultFields {
 public:
  /// Keeps references to both.
  ResultFields(const DisplacementSpace& space, const SemidiscreteProblem& problem);

  [[nodiscard]] const std::vector<FieldLayout>& layout() const { return layout_; }
  /// Computes all fields of a state. Per field const double* or (whole) const int*, row by row; valid until the next
  /// call.
  [[nodiscard]] const std::vector<const void*>& evaluate(const State& state);

 private:
  [[nodiscard]] std::size_t number(Index node) const {
    return static_cast<std::size_t>(space_.number[static_cast<std::size_t>(node)]);
  }
  void take_vector(const Vector& values, std::vector<double>& field) const;
  void contact_fields(const State& state);
  void friction_field(const State& state);

  const DisplacementSpace& space_;
  const SemidiscreteProblem& problem_;
  std::vector<FieldLayout> layout_;
  std::vector<const void*> values_;
  std::vector<double> displacement_, velocity_, pressure_, traction_, gap_;
  std::vector<int> status_;
  Vector node_gap_, node_pressure_, node_traction_;
};

}  // namespace ricochet
