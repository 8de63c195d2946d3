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
  /// Makes it without PETSc. Arguments, result and errors are those of PreconditionerFactory::make.
  std::unique_ptr<Preconditioner> (*make)(const SparseMatrix& part, const std::vector<char>& solved,
                                          const Points& nodes, const Ranks& ranks) = nullptr;
  /// Options with which PETSc makes it, in programs that have PETSc: "-pc_type gamg".
  std::string petsc_options = {};
  /// Whether "auto" changes to it as soon as diagonal blocks need many iterations, in programs that have it.
  bool is_fallback = false;
};
/// Types by name, first the diagonal blocks.
Registry<PreconditionerType>& preconditioner_registry();
/// Name of the first fallback. Throws std::logic_error if there is none.
[[nodiscard]] const std::string& fallback_preconditioner();

class PreconditionerFactory {
 public:
  virtual ~PreconditionerFactory() = default;
  /// Makes a preconditioner z = P r for a symmetric positive definite matrix with d dofs per node, whose parts on the
  /// ranks are additive; collective. Residual r and correction z are consistent. `name`: a type with options of PETSc.
  /// `solved`, a flag per dof: rows and columns of other dofs are left out, and z = r there. `nodes`: positions, d ×
  /// count. Throws Error(invalid_input) with the library's message if it cannot be made.
  [[nodiscard]] virtual std::unique_ptr<Preconditioner> make(const std::string& name, const SparseMatrix& part,
                                                             const std::vector<char>& solved, const Points& nodes,
                                                             const Ranks& ranks) const = 0;
};

/// Makes a preconditioner that is not block diagonal, by its type or by PETSc. Arguments and errors are as above;
/// without PETSc (null) a type that needs it is an Error(invalid_input), too.
[[nodiscard]] std::unique_ptr<Preconditioner> make_named_preconditioner(const std::string& name,
                                                                        const SparseMatrix& part,
                                                                        const std::vector<char>& solved,
                                                                        const Points& nodes, const Ranks& ranks,
                                                                        const PreconditionerFactory* petsc);

}  // namespace ricochet
