#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ricochet/base/registry.hpp"
#include "ricochet/linear_algebra/conjugate_gradients.hpp"

/// @file Preconditioners by name (`solver.preconditioner`), and the interface to those of PETSc, for code that does not
/// depend on it.
namespace ricochet {

/// Kind of preconditioner. Exactly one of the first three members is set.
struct PreconditionerType {
  /// The diagonal blocks of the nodes (block_jacobi.hpp), with which iterations also run in single precision.
  bool is_block_diagonal = false;
  /// Makes it as PreconditionerFactory::make does.
  std::unique_ptr<Preconditioner> (*make)(const SparseMatrix& part, const std::vector<char>& solved,
                                          const Points& nodes, const Ranks& ranks) = nullptr;
  /// Options with which PETSc makes it, in programs that have PETSc: "-pc_type gamg".
  std::string petsc_options = {};
  /// "auto" changes to it as soon as diagonal blocks need many iterations, in programs that have it.
  bool suits_long_steps = false;
};
/// Types by name, first the diagonal blocks.
Registry<PreconditionerType>& preconditioner_registry();
/// Name of the first type that suits long steps.
[[nodiscard]] const std::string& preconditioner_of_long_steps();

class PreconditionerFactory {
 public:
  virtual ~PreconditionerFactory() = default;
  /// Makes a preconditioner for a symmetric positive definite matrix with d dofs per node, of which each rank has a
  /// part (parts add up); collective. Vectors are consistent. `name`: a type with options of PETSc. `solved` per dof:
  /// rows and columns of other dofs are left out (z = r there). `nodes`: positions, d × count. Throws
  /// Error(invalid_input) with the library's message if it cannot be made.
  [[nodiscard]] virtual std::unique_ptr<Preconditioner> make(const std::string& name, const SparseMatrix& part,
                                                             const std::vector<char>& solved, const Points& nodes,
                                                             const Ranks& ranks) const = 0;
};

/// Makes a preconditioner that is not block diagonal, by its type or by PETSc. Arguments and errors are as above.
[[nodiscard]] std::unique_ptr<Preconditioner> make_named_preconditioner(const std::string& name,
                                                                        const SparseMatrix& part,
                                                                        const std::vector<char>& solved,
                                                                        const Points& nodes, const Ranks& ranks,
                                                                        const PreconditionerFactory* petsc);

}  // namespace ricochet
