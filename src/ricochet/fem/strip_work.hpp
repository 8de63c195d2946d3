#pragma once

#include <limits>
#include <optional>

#include "ricochet/fem/cell_strips.hpp"

/// @file Strains, stresses and energies of the material laws on strips. Not part of the public interface.
namespace ricochet {

/// Updates the worst cell of a part; parts are compared in their order.
inline void worse(CellVolume& worst, Index cell, double ratio) {
  if (ratio < worst.volume_ratio) worst = {cell, ratio};
}

/// Computations of the material laws on strips.
template <int d>
class ElasticCells::StripWork : public CellStrips<d> {
 public:
  using CellStrips<d>::CellStrips;

  /// Calls work(strip) for all strips of a part.
  template <class Work>
  void for_each_strip(Index part, const Work& work) {
    CellStrips<d>::for_each_strip(
        part, [](const Material&) { return true; },
        [&](const PackStrip<d>& strip) {
          law_.emplace(*material().law, is_plane_stress(this->body()));
          const bool has_mean = material().mean_dilatation && strip.block.dilatation_functions.size() > 0;
          mean_modulus_ = has_mean ? material().law->volumetric_modulus() : 0.0;
          work(strip);
        });
  }

  /// Computes H and E from the numbers of a part. Updates `worst` if a cell is inverted.
  void find_strains(const PackStrip<d>& strip, const double* numbers, CellVolume& worst) {
    find_gradients(strip, numbers, gradients_.data());
    const bool upright =
        ricochet::find_strains<d>(strip.points(), law_->is_linear(), gradients_.data(), nullptr, strains_.data());
    complete(strip, upright, worst);
  }
  /// Updates `smallest` with the volume ratios of all cells.
  void find_smallest(const PackStrip<d>& strip, const double* numbers, CellVolume& smallest) {
    find_gradients(strip, numbers, gradients_.data());
    find_worst(strip, smallest, std::numeric_limits<double>::infinity());
  }
  void add_forces(const PackStrip<d>& strip, double* forces) {
    find_stresses(strip);
    ricochet::add_forces(strip, law_->is_linear(), gradients_.data(), stresses_.data(), forces);
  }
  [[nodiscard]] double energy(const PackStrip<d>& strip) {
    find_energies(strip, stresses_.data());
    return this->integral(strip, stresses_.data());
  }

 protected:
  using CellStrips<d>::material;
  using StrainNumbers = StripNumbers<strain_components<d>>;

  [[nodiscard]] const PointLaw& law() const { return *law_; }
  /// Computes S of the strains.
  void find_stresses(const PackStrip<d>& strip) {
    material().law->stresses(packs(strip), stresses_.data());
    if (mean_modulus_ > 0.0) add_mean_pressures(strip, mean_modulus_, strains_.data(), stresses_.data());
  }
  /// Computes energy densities of the strains, one number per point and lane.
  void find_energies(const PackStrip<d>& strip, double* energies) {
    material().law->energies(packs(strip), energies);
    if (mean_modulus_ > 0.0) add_mean_energies(strip, mean_modulus_, strains_.data(), energies);
  }
  /// Completes strains under plane stress, and updates `worst` unless all cells of the strip are upright.
  void complete(const PackStrip<d>& strip, bool upright, CellVolume& worst) {
    if (law_->is_plane_stress()) solve_plane_stress(strip);
    if (law_->is_linear()) return;
    if (law_->is_plane_stress()) upright = false;  // whether the thickness is defined is not known yet
    if (!upright) find_worst(strip, worst);
  }

  // Overwritten strip by strip.
  alignas(64) StripNumbers<gradient_components<d>> gradients_;
  alignas(64) StrainNumbers strains_, stresses_;

 private:
  [[nodiscard]] StrainPacks packs(const PackStrip<d>& strip) const {
    return {strains_.data(), strip.points(), strip.block.width, d == 2};
  }
  [[nodiscard]] static double& number(StrainNumbers& of, Index point, int component, const PackStrip<d>& strip,
                                      int lane) {
    return of[std::size_t((point * strain_components<d> + component) * strip.block.width + lane)];
  }
  /// Computes the strain normal to the plane, point by point.
  void solve_plane_stress(const PackStrip<d>& strip) {
    this->for_each_lane(strip, [&](Index, int lane, Index first, int) {
      for (Index point = first; point < first + strip.block.points; ++point) {
        Tensor strain = Tensor::Zero();
        strain(0, 0) = number(strains_, point, 0, strip, lane);
        strain(1, 1) = number(strains_, point, 1, strip, lane);
        strain(0, 1) = strain(1, 0) = number(strains_, point, 3, strip, lane);
        law_->complete(strain);
        number(strains_, point, 2, strip, lane) = strain(2, 2);
      }
    });
  }
  /// Updates `worst` with the ratios that are not above a limit.
  void find_worst(const PackStrip<d>& strip, CellVolume& worst, double limit = 0.0) {
    const int width = strip.block.width;
    this->for_each_lane(strip, [&](Index, int lane, Index first, int cell) {
      double least = 1.0;
      for (Index point = first; point < first + strip.block.points; ++point) {
        const double* const at = gradients_.data() + point * gradient_components<d> * width + lane;
        Tensor deformation = Tensor::Identity();
        for (int i = 0; i < d * d; ++i) deformation(i / d, i % d) += at[i * width];
        if (d == 2) deformation(2, 2) += at[4 * width];
        if (law_->is_plane_stress()) deformation(2, 2) = std::sqrt(1.0 + 2.0 * number(strains_, point, 2, strip, lane));
        const double volume = determinant(deformation);
        if (!(volume >= least)) least = std::isnan(volume) ? -std::numeric_limits<double>::infinity() : volume;
      }
      if (!(least > limit)) worse(worst, cell + this->first_cell(), least);
    });
  }

  std::optional<PointLaw> law_;
  double mean_modulus_ = 0.0;
};

}  // namespace ricochet
