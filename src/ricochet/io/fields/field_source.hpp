#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ricochet/fem/assembly.hpp"
#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/scheme/state.hpp"

/// @file Fields of a frame. A new field needs a class in a file, and a line with its names in registry.cpp.
namespace ricochet {

enum class FieldLocation { nodes, cells };

/// Field at nodes, in the order of the mesh file, or on cells, through all blocks.
struct Field {
  std::string name;
  FieldLocation location = FieldLocation::nodes;
  int components = 1;            ///< 1: scalar; 3: vector; 6: symmetric tensor, see fem/stress.hpp
  bool is_integer = false;       ///< integers of 32 bits (int), otherwise reals (double)
  Index rows = 0;                ///< nodes or cells
  const void* values = nullptr;  ///< row by row; the address does not change
};

class FieldSource {
 public:
  virtual ~FieldSource() = default;
  [[nodiscard]] virtual std::vector<Field> fields() const = 0;
  /// Computes the values of the fields in a state.
  virtual void evaluate(const State& state) = 0;
};

/// Data from which fields are computed; outlives their sources.
struct FieldContext {
  const Body& body;
  const SemidiscreteProblem& problem;
  std::vector<std::string> requested;  ///< names

  [[nodiscard]] bool is_requested(const std::string& name) const;
  [[nodiscard]] bool any_is_requested(const std::vector<std::string>& names) const;
};

/// Sources of the requested fields, in the order of the registry; names that do not apply (fields of friction in a case
/// without friction) are ignored.
[[nodiscard]] std::vector<std::unique_ptr<FieldSource>> make_field_sources(const FieldContext& context);
/// Names of all fields.
[[nodiscard]] std::vector<std::string> field_names();
/// Expands names: "all" stands for all fields, an empty list for the default ones, which are cheap.
[[nodiscard]] std::vector<std::string> expand_field_names(const std::vector<std::string>& names);

/// Copies a vector of dofs to three components per node, also in the plane, in the order of the mesh file.
void copy_vector(const DisplacementSpace& space, const Vector& values, std::vector<double>& field);

}  // namespace ricochet
