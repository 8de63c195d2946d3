#pragma once

/// @file OpenBLAS: its kernels, its threads and its memory.
namespace ricochet {

/// Has OpenBLAS take kernels that suit the processor (blas_kernels.hpp), on one thread: with two its bits change and
/// nothing is gained. To be called before anything that calls OpenBLAS, libraries of others (CHOLMOD, Basix) included:
/// the first bits count. Everything here calls it by itself, but a program that has threads of its own, or uses
/// OpenBLAS itself, calls it before: kernels are changed only where no other thread may be using them. Takes effect
/// once; cheap to call again. Throws Error(usage) as `instruction_set()` does.
void prepare_blas();

/// OpenBLAS asks for some memory per thread that calls it, and asks for ever where it is refused: a limit (ulimit -v)
/// would let the program hang. Under a limit this takes the memory for so many threads of ours. Throws
/// Error(not_converged) where it is not to be had.
void reserve_blas_memory(int threads);

/// Is there a limit on the memory of this process?
[[nodiscard]] bool memory_is_limited();

}  // namespace ricochet
