#include <limits>
#include <optional>

#include "ricochet/fem/cell_strips.hpp"

/// @file Forces and energies of all cells, pack by pack.
namespace ricochet {

namespace {

/// Updates the worst cell of a part; parts are compared in their order.
void worse(InvertedCell& worst, Index cell, double ratio) {
  if (ratio < worst.volume_ratio) worst = {cell, ratio};
}

using PartCells = std::array<InvertedCell, most_node_parts>;

/// Worst cell of all parts, compared in their order.
InvertedCell worst_of(const PartCells& parts) {
  InvertedCell all;
  for (const InvertedCell& each : parts) {
    if (each.cell >= 0) worse(all, each.cell, each.volume_ratio);
  }
  return all;
}

}  // namespace

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

  /// Computes H, E and S from the numbers of a part; with those of an increment (or null) E is the mean over both ends.
  /// Updates `worst` if a cell is inverted.
  void find_strains(const PackStrip<d>& strip, const double* numbers, const double* increments, InvertedCell& worst) {
    find_gradients(strip, numbers, gradients_.data());
    if (increments != nullptr) find_gradients(strip, increments, increments_.data());
    bool upright = ricochet::find_strains<d>(strip.points(), law_->is_linear(), gradients_.data(),
                                             increments != nullptr ? increments_.data() : nullptr, strains_.data());
    if (law_->is_plane_stress()) complete(strip);
    if (law_->is_linear()) return;
    if (law_->is_plane_stress()) upright = false;  // whether the thickness is defined is not known yet
    if (!upright) find_worst(strip, worst);
  }
  void add_forces(const PackStrip<d>& strip, double* forces) {
    material().law->stresses(packs(strip), stresses_.data());
    if (mean_modulus_ > 0.0) add_mean_pressures(strip, mean_modulus_, strains_.data(), stresses_.data());
    ricochet::add_forces(strip, law_->is_linear(), gradients_.data(), stresses_.data(), forces);
  }
  /// Adds the forces of 𝔻₀ : (the derivative of E along the increment).
  void add_rate_forces(const PackStrip<d>& strip, double* forces) {
    if (law_->is_linear()) return;
    const auto law = IsotropicElasticity::of(material().lambda(), material().mu(), law_->is_plane_stress());
    find_rate_stresses<d>(strip.points(), law, gradients_.data(), increments_.data(), stresses_.data());
    ricochet::add_forces(strip, false, gradients_.data(), stresses_.data(), forces);
  }
  /// Computes the gradients as well, if no other forces are needed at these numbers.
  void add_rate_forces(const PackStrip<d>& strip, const double* numbers, const double* increments, double* forces) {
    find_gradients(strip, numbers, gradients_.data());
    find_gradients(strip, increments, increments_.data());
    add_rate_forces(strip, forces);
  }
  [[nodiscard]] double energy(const PackStrip<d>& strip) {
    material().law->energies(packs(strip), stresses_.data());
    if (mean_modulus_ > 0.0) add_mean_energies(strip, mean_modulus_, strains_.data(), stresses_.data());
    return this->integral(strip, stresses_.data());
  }

 private:
  using CellStrips<d>::material;

  [[nodiscard]] StrainPacks packs(const PackStrip<d>& strip) const {
    return {strains_.data(), strip.points(), strip.block.width, d == 2};
  }
  [[nodiscard]] static double& number(StripNumbers<strain_components<d>>& of, Index point, int component,
                                      const PackStrip<d>& strip, int lane) {
    return of[std::size_t((point * strain_components<d> + component) * strip.block.width + lane)];
  }
  /// Plane stress: computes the strain normal to the plane, point by point.
  void complete(const PackStrip<d>& strip) {
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
  void find_worst(const PackStrip<d>& strip, InvertedCell& worst) {
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
      if (!(least > 0.0)) worse(worst, cell + this->first_cell(), least);
    });
  }
  std::optional<PointLaw> law_;
  double mean_modulus_ = 0.0;
  // Overwritten strip by strip.
  alignas(64) StripNumbers<gradient_components<d>> gradients_, increments_;
  alignas(64) StripNumbers<strain_components<d>> strains_, stresses_;
};

/// Input vector per dof, and the numbers of all parts to which it is copied.
struct ElasticCells::PackInput {
  const Vector& values;
  std::vector<double> PackNumbers::*numbers;
};

/// Numbers of all parts to be summed, and the vector per dof of the sums.
struct ElasticCells::PackSum {
  std::vector<double> PackNumbers::*numbers;
  Vector& result;
};

/// A part with its numbers and its worst cell.
struct ElasticCells::PackPart {
  PackNumbers& numbers;
  Index part, begin;
  InvertedCell& worst;

  [[nodiscard]] double* at(std::vector<double> PackNumbers::*of) const { return (numbers.*of).data() + begin; }
};

/// Calls work(strips, strip, part) for all strips, several parts at once; returns the worst cell.
template <class Work>
InvertedCell ElasticCells::visit_strips(std::initializer_list<PackInput> inputs, std::initializer_list<PackSum> sums,
                                        const Work& work) const {
  return with_dimension(body_.mesh->dimension, [&](auto dimension) {
    constexpr int d = dimension;
    const Blocks<d>& all = blocks<d>();
    PartCells worst;
    for_each_part<d, StripWork>([&](Index part, Index begin, StripWork<d>& strips) {
      for (const PackInput& input : inputs) all.packs.template read<d>(part, input.values, all.numbers.*input.numbers);
      for (const PackSum& sum : sums) all.packs.template clear<d>(part, all.numbers.*sum.numbers);
      const PackPart own{all.numbers, part, begin, worst[std::size_t(part)]};
      strips.for_each_strip(part, [&](const PackStrip<d>& strip) { work(strips, strip, own); });
    });
    for (const PackSum& sum : sums) all.packs.template add_up<d>(all.numbers.*sum.numbers, sum.result);
    return worst_of(worst);
  });
}

InvertedCell ElasticCells::force(const Vector& displacement, Vector& result) const {
  return visit_strips({{displacement, &PackNumbers::displacement}}, {{&PackNumbers::force, result}},
                      [](auto& strips, const auto& strip, const PackPart& part) {
                        strips.find_strains(strip, part.at(&PackNumbers::displacement), nullptr, part.worst);
                        strips.add_forces(strip, part.at(&PackNumbers::force));
                      });
}

InvertedCell ElasticCells::mean_force(const Vector& middle, const Vector& increment, Vector& result) const {
  return visit_strips({{middle, &PackNumbers::displacement}, {increment, &PackNumbers::increment}},
                      {{&PackNumbers::force, result}}, [](auto& strips, const auto& strip, const PackPart& part) {
                        strips.find_strains(strip, part.at(&PackNumbers::displacement),
                                            part.at(&PackNumbers::increment), part.worst);
                        strips.add_forces(strip, part.at(&PackNumbers::force));
                      });
}

InvertedCell ElasticCells::mean_forces(const Vector& middle, const Vector& increment, Vector& result,
                                       Vector& strain_result) const {
  return visit_strips({{middle, &PackNumbers::displacement}, {increment, &PackNumbers::increment}},
                      {{&PackNumbers::force, result}, {&PackNumbers::strain_force, strain_result}},
                      [](auto& strips, const auto& strip, const PackPart& part) {
                        strips.find_strains(strip, part.at(&PackNumbers::displacement),
                                            part.at(&PackNumbers::increment), part.worst);
                        strips.add_forces(strip, part.at(&PackNumbers::force));
                        strips.add_rate_forces(strip, part.at(&PackNumbers::strain_force));
                      });
}

void ElasticCells::strain_force(const Vector& displacement, const Vector& increment, Vector& result) const {
  visit_strips({{displacement, &PackNumbers::displacement}, {increment, &PackNumbers::increment}},
               {{&PackNumbers::strain_force, result}}, [](auto& strips, const auto& strip, const PackPart& part) {
                 strips.add_rate_forces(strip, part.at(&PackNumbers::displacement), part.at(&PackNumbers::increment),
                                        part.at(&PackNumbers::strain_force));
               });
}

/// Infinite if a cell is inverted, which cannot be recognized from its strain.
double ElasticCells::energy(const Vector& displacement) const {
  std::array<double, most_node_parts> sums{};
  visit_strips({{displacement, &PackNumbers::displacement}}, {},
               [&](auto& strips, const auto& strip, const PackPart& part) {
                 InvertedCell inverted;
                 strips.find_strains(strip, part.at(&PackNumbers::displacement), nullptr, inverted);
                 sums[std::size_t(part.part)] +=
                     inverted.cell >= 0 ? std::numeric_limits<double>::infinity() : strips.energy(strip);
               });
  double total = 0.0;
  for (const double sum : sums) total += sum;
  return total;
}

}  // namespace ricochet
