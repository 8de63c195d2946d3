#pragma once

#include <array>

#include "ricochet/fem/elastic_blocks.hpp"
#include "ricochet/fem/pack_kernels.hpp"

/// @file Strips: a few packs of cells at a time. Not part of the public interface.
namespace ricochet {

/// Numbers at the points of a strip, small enough for the first-level cache if cells have few points.
template <int components>
using StripNumbers = std::array<double, std::size_t(components* most_cell_points* most_pack_width)>;

/// Iterates over the strips of a part, with the data common to their cells.
template <int d>
class ElasticCells::CellStrips {
 public:
  CellStrips(const Body& body, const Blocks<d>& blocks) : body_(body), blocks_(blocks) {}

  /// Calls work(strip) for the strips of all runs with is_selected(material).
  template <class Selected, class Work>
  void for_each_strip(Index part, const Selected& is_selected, const Work& work) {
    for (const PackRun& run : blocks_.packs.runs(part)) {
      const KernelBlock<d>& block = blocks_.all[run.block];
      run_ = &run;
      if (!is_selected(material())) continue;
      const Index size = std::max<Index>(1, points_at_once / block.points);
      for (Index begin = run.begin; begin < run.end; begin += size)
        work(PackStrip<d>{block, blocks_.packs.slots(run.block).data(), begin, std::min(run.end, begin + size)});
    }
  }

 protected:
  /// Least number of points per strip, unless one pack already has more.
  static constexpr int points_at_once = 16;

  [[nodiscard]] const Body& body() const { return body_; }
  /// Material of the current run.
  [[nodiscard]] const Material& material() const { return body_.materials[material_number()]; }
  [[nodiscard]] std::size_t material_number() const { return std::size_t(run_->material); }
  /// Calls work(pack, lane, number of its first point in the strip, cell of the block) for the lanes in use.
  template <class Work>
  void for_each_lane(const PackStrip<d>& strip, const Work& work) const {
    const auto& lanes = blocks_.packs.lanes(run_->block);
    Index first = 0;
    for (Index pack = strip.begin; pack < strip.end; ++pack, first += strip.block.points) {
      for (int lane = 0; lane < strip.block.width; ++lane) {
        const int cell = lanes[std::size_t(pack * strip.block.width + lane)];
        if (cell >= 0) work(pack, lane, first, cell);
      }
    }
  }
  /// Integral over a strip: Σ weight × value, with one value per point and lane.
  [[nodiscard]] double integral(const PackStrip<d>& strip, const double* values) const {
    const KernelBlock<d>& block = strip.block;
    double sum = 0.0;
    for_each_lane(strip, [&](Index pack, int lane, Index first, int) {
      for (int q = 0; q < block.points; ++q)
        sum += block.weight[std::size_t(block.index(pack, q) + lane)] * values[(first + q) * block.width + lane];
    });
    return sum;
  }
  /// Number, through all blocks, of the first cell of the block.
  [[nodiscard]] Index first_cell() const {
    Index sum = 0;
    for (std::size_t block = 0; block < run_->block; ++block) sum += body_.mesh->cells[block].size();
    return sum;
  }

 private:
  const Body& body_;
  const Blocks<d>& blocks_;
  const PackRun* run_ = nullptr;
};

/// Calls work(part, index of its first number, strips) for all parts, several at once; Strips is constructed
/// from the body and its blocks.
template <int d, template <int> class Strips, class Work>
void ElasticCells::for_each_part(const Work& work) const {
  const Blocks<d>& all = blocks<d>();
  parallel_ranges(all.packs.parts(), [&](Index first, Index last) {
    Strips<d> strips(body_, all);
    for (Index part = first; part < last; ++part) work(part, all.packs.template begin<d>(part), strips);
  });
}

}  // namespace ricochet
