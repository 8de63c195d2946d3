#pragma once

#include <string>
#include <string_view>

#include "ricochet/base/instruction_sets.hpp"

/// @file Which kernels OpenBLAS takes: it has some for each kind of processor, under the name of its core.
namespace ricochet {

/// The core that OpenBLAS should take in place of `chosen`, or "" where that should stay. `given`: a user has asked for
/// this set. Then it is always the same core, so that bits are those of the set and not of the machine.
[[nodiscard]] std::string_view better_blas_core(std::string_view chosen, InstructionSet set, bool given);

/// Has OpenBLAS take better kernels where there are any.
///
/// OpenBLAS goes by a table of processors and may take those of 2004 for one that is newer than itself: 0.3.21 takes
/// Prescott's for family 6, model 207, a fifth of the speed. Its own function that chooses is then called again, with
/// OPENBLAS_CORETYPE set meanwhile. Not done where the user has set that variable; not done, and said, where OpenBLAS
/// lacks these functions, which are not documented, and where other threads run, one of which might be in OpenBLAS
/// then. What comes of it must have the name that was asked for and compute rightly, or OpenBLAS chooses by itself
/// again. Memory that OpenBLAS has taken before stays in use: its size does not depend on the core.
void choose_blas_kernels();

}  // namespace ricochet
