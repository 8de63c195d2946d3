#pragma once

/// @file OpenBLAS: kernels, threads and memory.
namespace ricochet {

/// Selects OpenBLAS kernels that suit the processor (blas_kernels.hpp) and restricts OpenBLAS to one thread: two
/// threads change the bits of its results and gain nothing. Must run before anything calls OpenBLAS, third-party
/// libraries (CHOLMOD, Basix) included, since results computed earlier come from other kernels. The library calls it on
/// its own; a program that has threads or uses OpenBLAS itself calls it before them, because kernels are replaced only
/// while no other thread can be using them. Has an effect once, and is cheap to call again. Throws Error(usage) as
/// `instruction_set()` does.
void prepare_blas();

/// Reserves the memory that OpenBLAS needs for so many of our threads, if the process has a limit (ulimit -v). OpenBLAS
/// allocates a buffer per calling thread and repeats a refused request forever, so the program would hang. Throws
/// Error(not_converged) if the limit is too low.
void reserve_blas_memory(int threads);

/// Returns whether the memory of this process is limited.
[[nodiscard]] bool memory_is_limited();

}  // namespace ricochet
