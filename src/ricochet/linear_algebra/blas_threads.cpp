#include "ricochet/linear_algebra/blas_threads.hpp"

extern "C" void openblas_set_num_threads(int count);

namespace ricochet {

void use_one_blas_thread() {
  static const bool done = [] {
    openblas_set_num_threads(1);
    return true;
  }();
  static_cast<void>(done);
}

}  // namespace ricochet
