#include "ricochet/fem/cell_dilatation.hpp"
#include "ricochet/fem/pack_kernels.hpp"
#include "ricochet/fem/packed_law.hpp"

/// @file Mean dilatation of packs of cells.
namespace ricochet {

namespace {

template <int d, int W>
using StrainPack = std::conditional_t<d == 2, PlaneTensor<Pack<W>>, SpaceTensor<Pack<W>>>;

/// J − 1 as a function of s = J² − 1.
template <class Number>
RICOCHET_PART_OF_CALLER Number volume_change_of(const Number& s) {
  return s / (1.0 + square_root(1.0 + s));
}

template <int d>
struct MeanDilatation {
  const PackStrip<d>& strip;
  double modulus;
  const double* strains;
  double* result;
  bool is_energy;

  template <int W>
  RICOCHET_PART_OF_CALLER void run() const {
    using Number = Pack<W>;
    const KernelBlock<d>& block = strip.block;
    CellDilatation<Number> dilatation;
    std::array<Number, most_cell_points> weights, values, mean, pressure;
    Index point = 0;
    for (Index pack = strip.begin; pack < strip.end; ++pack, point += block.points) {
      for (int q = 0; q < block.points; ++q) {
        const auto at = std::size_t(q);
        weights[at] = load<W>(block.weight.data() + block.index(pack, q));
        values[at] = volume_change_of(measures_of(strain<W>(point + q)).volume_change);
      }
      dilatation.start(block.dilatation_functions, weights.data(), block.points);
      dilatation.project(values.data(), mean.data());
      if (is_energy) {
        add_energies<W>(point, mean.data());
        continue;
      }
      for (int q = 0; q < block.points; ++q) {
        const Number& theta = mean[std::size_t(q)];  // Θ − 1
        values[std::size_t(q)] = 0.5 * modulus * theta * (2.0 + theta) / (1.0 + theta);
      }
      dilatation.project(values.data(), pressure.data());
      add_pressures<W>(point, pressure.data());
    }
  }
  template <int W>
  RICOCHET_PART_OF_CALLER StrainPack<d, W> strain(Index point) const {
    return load_tensor<StrainPack<d, W>>(strains + point * strain_components<d> * W);
  }
  template <int W>
  RICOCHET_PART_OF_CALLER void add_energies(Index first, const Pack<W>* mean) const {
    for (int q = 0; q < strip.block.points; ++q) {
      double* const to = result + (first + q) * W;
      const Pack<W> theta = mean[q], s = measures_of(strain<W>(first + q)).volume_change;
      const Pack<W> change = logarithm_rest<Pack<W>>(theta * (2.0 + theta)) - logarithm_rest<Pack<W>>(s);
      store<W>(to, load<W>(to) + 0.25 * modulus * change);
    }
  }
  template <int W>
  RICOCHET_PART_OF_CALLER void add_pressures(Index first, const Pack<W>* pressure) const {
    for (int q = 0; q < strip.block.points; ++q) {
      double* const to = result + (first + q) * strain_components<d> * W;
      const auto of = measures_of(strain<W>(first + q));
      const Pack<W> factor = pressure[q] * square_root(1.0 + of.volume_change) - 0.5 * modulus * of.volume_change;
      const Pack<W> one = Pack<W>{} + 1.0;
      store_tensor(to, combination(one, load_tensor<StrainPack<d, W>>(to), one, of.inverse(factor), Pack<W>{}));
    }
  }
};

}  // namespace

template <int d>
void add_mean_pressures(const PackStrip<d>& strip, double modulus, const double* strains, double* stresses) {
  run_in_packs(MeanDilatation<d>{strip, modulus, strains, stresses, false});
}
template <int d>
void add_mean_energies(const PackStrip<d>& strip, double modulus, const double* strains, double* energies) {
  run_in_packs(MeanDilatation<d>{strip, modulus, strains, energies, true});
}

template void add_mean_pressures<2>(const PackStrip<2>&, double, const double*, double*);
template void add_mean_pressures<3>(const PackStrip<3>&, double, const double*, double*);
template void add_mean_energies<2>(const PackStrip<2>&, double, const double*, double*);
template void add_mean_energies<3>(const PackStrip<3>&, double, const double*, double*);

}  // namespace ricochet
