#pragma once

#include "ricochet/fem/strip_work.hpp"

/// @file Visits of all strips of a body. Not part of the public interface.
namespace ricochet {

using PartCells = std::array<CellVolume, most_node_parts>;

/// Worst cell of all parts, compared in their order.
inline CellVolume worst_of(const PartCells& parts) {
  CellVolume all;
  for (const CellVolume& each : parts) {
    if (each.cell >= 0) worse(all, each.cell, each.volume_ratio);
  }
  return all;
}

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
  CellVolume& worst;

  [[nodiscard]] double* at(std::vector<double> PackNumbers::*of) const { return (numbers.*of).data() + begin; }
};

/// Calls work(strips, strip, part) for all strips, several parts at once; returns the worst cell. `Strips`: StripWork
/// or derived from it.
template <template <int> class Strips, class Work>
CellVolume ElasticCells::visit_strips(std::initializer_list<PackInput> inputs, std::initializer_list<PackSum> sums,
                                      const Work& work) const {
  return with_dimension(body_.mesh->dimension, [&](auto dimension) {
    constexpr int d = dimension;
    const Blocks<d>& all = blocks<d>();
    PartCells worst;
    for_each_part<d, Strips>([&](Index part, Index begin, Strips<d>& strips) {
      for (const PackInput& input : inputs) all.packs.template read<d>(part, input.values, all.numbers.*input.numbers);
      for (const PackSum& sum : sums) all.packs.template clear<d>(part, all.numbers.*sum.numbers);
      const PackPart own{all.numbers, part, begin, worst[std::size_t(part)]};
      strips.for_each_strip(part, [&](const PackStrip<d>& strip) { work(strips, strip, own); });
    });
    for (const PackSum& sum : sums) all.packs.template add_up<d>(all.numbers.*sum.numbers, sum.result);
    return worst_of(worst);
  });
}

}  // namespace ricochet
