#pragma once

#include <string_view>

#include "ricochet/base/instruction_sets.hpp"

/// @file Selection of OpenBLAS kernels. OpenBLAS has a set for each kind of processor, named after its core.
namespace ricochet {

/// Returns the core whose kernels OpenBLAS should use instead of those of `chosen`, or "" to keep them. `given`: the
/// user has asked for this instruction set; the core is then always the same one, so that bits depend on the set and
/// not on the machine.
[[nodiscard]] std::string_view better_blas_core(std::string_view chosen, InstructionSet set, bool given);

/// Selects better OpenBLAS kernels if there are any.
///
/// OpenBLAS goes by a table of processors and may choose kernels of 2004 for a processor newer than itself: 0.3.21
/// chooses Prescott's for family 6, model 207, at a fifth of the speed. Its own selection is then run again with
/// OPENBLAS_CORETYPE set meanwhile. This is skipped if the user has set that variable. It is skipped with a warning if
/// OpenBLAS lacks these (undocumented) functions, or if other threads run, one of which might be inside OpenBLAS. The
/// new kernels must have the name that was asked for and compute correctly; otherwise OpenBLAS chooses by itself again.
/// Memory that OpenBLAS has allocated before stays in use: its size does not depend on the core.
void choose_blas_kernels();

}  // namespace ricochet
