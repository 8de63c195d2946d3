#include "ricochet/fem/path_kernels.hpp"

#include "ricochet/fem/symmetric_tensor.hpp"

namespace ricochet {

namespace {

template <int d, int W>
using PathTensor = std::conditional_t<d == 2, PlaneTensor<Pack<W>>, SpaceTensor<Pack<W>>>;

template <int d>
struct Moves {
  Index points;
  const double *means, *changes;
  double tau;
  double* result;

  template <int W>
  RICOCHET_PART_OF_CALLER void run() const {
    const Index count = points * strain_components<d>;
    for (Index k = 0; k < count; ++k) store<W>(result + k * W, load<W>(means + k * W) + tau * load<W>(changes + k * W));
  }
};

template <int d>
struct WeightedSums {
  const PackStrip<d>& strip;
  const double *weights, *tensors;
  double* sums;

  template <int W>
  RICOCHET_PART_OF_CALLER void run() const {
    const Index of_pack = strip.block.points * strain_components<d>;
    Index number = 0;
    for (Index pack = 0; pack < strip.end - strip.begin; ++pack) {
      const Pack<W> weight = load<W>(weights + pack * W);
      for (Index k = 0; k < of_pack; ++k, ++number)
        store<W>(sums + number * W, load<W>(sums + number * W) + weight * load<W>(tensors + number * W));
    }
  }
};

template <int d>
struct Products {
  Index points;
  const double *a, *b;
  double* result;

  template <int W>
  RICOCHET_PART_OF_CALLER void run() const {
    using Tensor = PathTensor<d, W>;
    for (Index p = 0; p < points; ++p) {
      const Index at = p * strain_components<d> * W;
      store<W>(result + p * W, double_dot(load_tensor<Tensor>(a + at), load_tensor<Tensor>(b + at)));
    }
  }
};

}  // namespace

template <int d>
void move_along(Index points, const double* means, const double* changes, double tau, double* strains) {
  run_in_packs(Moves<d>{points, means, changes, tau, strains});
}
template <int d>
void add_weighted(const PackStrip<d>& strip, const double* weights, const double* tensors, double* sums) {
  run_in_packs(WeightedSums<d>{strip, weights, tensors, sums});
}
template <int d>
void find_products(Index points, const double* a, const double* b, double* products) {
  run_in_packs(Products<d>{points, a, b, products});
}

template void move_along<2>(Index, const double*, const double*, double, double*);
template void move_along<3>(Index, const double*, const double*, double, double*);
template void add_weighted<2>(const PackStrip<2>&, const double*, const double*, double*);
template void add_weighted<3>(const PackStrip<3>&, const double*, const double*, double*);
template void find_products<2>(Index, const double*, const double*, double*);
template void find_products<3>(Index, const double*, const double*, double*);

}  // namespace ricochet
