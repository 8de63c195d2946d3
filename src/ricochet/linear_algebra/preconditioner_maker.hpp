#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ricochet/linear_algebra/conjugate_gradients.hpp"

/// @file Where preconditioners of other libraries come from, for those that do not know these.
namespace ricochet {

class PreconditionerMaker {
 public:
  virtual ~PreconditionerMaker() = default;
  /// Of a symmetric positive definite matrix with d dofs per node, of which each rank has a part (parts add up); all
  /// ranks ask together. Vectors are consistent. `kind`: a name that the maker knows. `solved` per dof: the rows and
  /// columns of the others are left out (z = r there). `nodes`: positions, d × count. Throws Error(invalid_input) that
  /// says what the library says, where it cannot be made.
  [[nodiscard]] virtual std::unique_ptr<Preconditioner> make(const std::string& kind, const SparseMatrix& part,
                                                             const std::vector<char>& solved, const Points& nodes,
                                                             const Ranks& ranks) const = 0;
};

}  // namespace ricochet
