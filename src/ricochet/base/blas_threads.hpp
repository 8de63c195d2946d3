#pragma once

/// @file OpenBLAS: its threads and its memory.
namespace ricochet {

/// With two threads its bits change and nothing is gained. To be called before anything that calls OpenBLAS, libraries
/// of others (CHOLMOD, Basix) included: the first bits count. Takes effect once; cheap to call again.
void use_one_blas_thread();

/// OpenBLAS asks for some memory per thread that calls it, and asks for ever where it is refused: a limit (ulimit -v)
/// would let the program hang. Under a limit this takes the memory for so many threads of ours. Throws
/// Error(not_converged) where it is not to be had.
void reserve_blas_memory(int threads);

/// Is there a limit on the memory of this process?
[[nodiscard]] bool memory_is_limited();

}  // namespace ricochet
