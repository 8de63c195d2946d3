#pragma once

/// @file Management of the memory of a process, from its start.
namespace ricochet::program {

/// Restarts the program without threads of OpenBLAS if memory is limited. OpenBLAS starts its threads when it is
/// loaded; a thread that gets no memory requests it for ever, takes the memory that others release, and does not end.
void restart_without_blas_threads(char** argv);

/// Keeps released memory in the process. Matrices of contact points are allocated and released in every iteration of a
/// step; returning memory to the system each time, and receiving it as pages of zeros, costs as much as the products.
void keep_memory();

}  // namespace ricochet::program
