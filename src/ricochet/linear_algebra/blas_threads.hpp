#pragma once

/// @file OpenBLAS on one thread.
namespace ricochet {

/// With two threads its bits change and nothing is gained. Takes effect once; cheap to call again.
void use_one_blas_thread();

}  // namespace ricochet
