#include "ricochet/step/newton_progress.hpp"

#include <fmt/format.h>

namespace ricochet {

Error NewtonProgress::failure(double correction) const {
  return {ErrorKind::not_converged,
          fmt::format("Newton's method did not converge in {} iterations (the last correction moves a node by {:.3g})",
                      total_iterations_, correction)};
}

}  // namespace ricochet
