#pragma once

/// @file How the memory of a process is managed, from its beginning on.
namespace ricochet::program {

/// Where memory is limited, OpenBLAS must not have threads of its own: it starts them when it is loaded, and one that
/// gets no memory asks for it for ever, takes what others have given back, and does not end. The program is then begun
/// again without them.
void restart_without_blas_threads(char** argv);

/// Matrices of contact points come and go in every round of a step. Memory that is given back to the system each time,
/// and comes back as pages of zeros, costs as much as the products.
void keep_memory();

}  // namespace ricochet::program
