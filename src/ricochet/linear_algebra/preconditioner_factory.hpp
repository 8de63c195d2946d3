#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ricochet/linear_algebra/conjugate_gradients.hpp"

/// @file Interface to preconditioners of other libraries, for code that does not depend on these.
namespace ricochet {

class PreconditionerFactory {
 public:
  virtual ~PreconditionerFactory() = default;
  /// Makes a preconditioner for a symmetric positive definite matrix with d dofs per node, of which each rank has a
  /// part (parts add up); collective. Vectors are consistent. `kind`: a name that the implementation supports. `solved`
  /// per dof: rows and columns of other dofs are left out (z = r there). `nodes`: positions, d × count. Throws
  /// Error(invalid_input) with the library's message if it cannot be made.
  [[nodiscard]] virtual std::unique_ptr<Preconditioner> make(const std::string& kind, const SparseMatrix& part,
                                                             const std::vector<char>& solved, const Points& nodes,
                                                             const Ranks& ranks) const = 0;
};

}  // namespace ricochet
