#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ricochet/fem/assembly.hpp"
#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/scheme/state.hpp"

/// @file The fields of a frame. To add some: a file with a class and its names, and one line in registry.cpp.
namespace ricochet {

enum class FieldPlace { nodes, cells };

/// Nodes in the numbering of the mesh file, cells through all blocks.
struct Field {
  std::string name;
  FieldPlace place = FieldPlace::nodes;
  int components = 1;            ///< 1: scalar; 3: vector; 6: symmetric tensor, see fem/stress.hpp
  bool whole = false;            ///< whole numbers of 32 bits (int), else reals (double)
  Index rows = 0;                ///< nodes or cells
  const void* values = nullptr;  ///< row by row; where they are stays the same
};

class FieldSource {
 public:
  virtual ~FieldSource() = default;
  [[nodiscard]] virtual std::vector<Field> fields() const = 0;
  /// Computes their values in a state.
  virtual void evaluate(const State& state) = 0;
};

/// What fields are made from; lives longer than their sources.
struct FieldContext {
  const Body& body;
  const SemidiscreteProblem& problem;
  std::vector<std::string> wanted;  ///< names

  [[nodiscard]] bool wants(const std::string& name) const;
  [[nodiscard]] bool wants_any(const std::vector<std::string>& names) const;
};

/// The wanted fields, in the order of the registry; names that do not apply (friction without friction) are left out.
[[nodiscard]] std::vector<std::unique_ptr<FieldSource>> make_field_sources(const FieldContext& context);
/// All names.
[[nodiscard]] std::vector<std::string> field_names();
/// What is meant by these names: "all" by all, none by the usual fields, which cost little.
[[nodiscard]] std::vector<std::string> wanted_fields(const std::vector<std::string>& names);

/// A vector of dofs as three components per node, also in the plane, in the numbering of the mesh file.
void take_vector(const DisplacementSpace& space, const Vector& values, std::vector<double>& field);

}  // namespace ricochet
