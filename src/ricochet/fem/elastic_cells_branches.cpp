#include "ricochet/fem/cell_strips.hpp"

/// @file Viscoelastic branches of the materials in the cells of a body.
namespace ricochet {

void ElasticCells::find_internal_offsets() {
  Index sum = 0;
  std::vector<Index> begin;
  begin.reserve(body_.cell_material.size() + 1);
  CellWalk walk(body_.space->cells);
  for (Index cell = 0; cell < body_.mesh->cell_count(); ++cell) {
    walk.go_to(cell);
    begin.push_back(sum);
    const auto branches = Index(material_of(body_, cell).relaxation.size());
    sum += branches * internal_components * with_dimension(body_.mesh->dimension, [&](auto dimension) -> Index {
             constexpr int d = dimension;
             return blocks<d>().all[walk.block()].points;
           });
  }
  begin.push_back(sum);
  if (sum > 0) internal_begin_ = std::move(begin);
}

/// Vectors from which the strains of branches are computed.
struct ElasticCells::BranchDisplacements {
  const BranchStep* step = nullptr;      ///< null for an instant instead of a step
  const Vector* displacement = nullptr;  ///< null if only displacements of the step are needed
  const Vector& internal;
};

/// Computations of viscoelastic branches on strips.
template <int d>
class ElasticCells::BranchStrips : public CellStrips<d> {
 public:
  BranchStrips(const Body& body, const Blocks<d>& blocks) : CellStrips<d>(body, blocks), blocks_(blocks) {}

  /// Calls work(strip) for the strips of a part whose cells have branches, after computing their strains.
  template <class Work>
  void for_each_strip(Index part, Index begin, const BranchDisplacements& displacements,
                      const std::vector<Index>& internal_begin, const Work& work) {
    read(part, displacements);
    const auto has_branches = [](const Material& material) { return !material.relaxation.empty(); };
    CellStrips<d>::for_each_strip(part, has_branches, [&](const PackStrip<d>& strip) {
      internal_.fill(displacements.internal.data());
      this->for_each_lane(strip, [&](Index pack, int lane, Index, int cell) {
        internal_[lane_number(strip, pack, lane)] =
            displacements.internal.data() + internal_begin[std::size_t(cell + this->first_cell())];
      });
      find_all_strains(strip, begin, displacements);
      work(strip);
    });
  }

  void add_forces(BranchStress of, const PackStrip<d>& strip, double* forces) {
    find_branch_stresses(of, points(strip), result_.data());
    const auto& gradients = of == BranchStress::mean ? gradients_ : ends_;
    ricochet::add_forces(strip, false, gradients.data(), result_.data(), forces);
  }
  [[nodiscard]] double work(BranchWork of, const PackStrip<d>& strip) {
    find_branch_works(of, points(strip), nullptr, result_.data());
    return this->integral(strip, result_.data());
  }
  /// Writes A₁ to a vector in the order of A; returns the dissipation.
  [[nodiscard]] double advance(const PackStrip<d>& strip, const BranchDisplacements& displacements, Vector& next) {
    find_next(strip, displacements, next);
    find_branch_works(BranchWork::dissipation, points(strip), next_.data(), result_.data());
    return this->integral(strip, result_.data());
  }
  void relax(const PackStrip<d>& strip, const BranchDisplacements& displacements, Vector& next) {
    find_next(strip, displacements, next);
    relax_branches(points(strip), next_.data());
  }

 private:
  static constexpr auto most_lanes = std::size_t(CellStrips<d>::points_at_once * most_pack_width);
  static std::size_t lane_number(const PackStrip<d>& strip, Index pack, int lane) {
    return std::size_t((pack - strip.begin) * strip.block.width + lane);
  }
  void find_next(const PackStrip<d>& strip, const BranchDisplacements& displacements, Vector& next) {
    next_.fill(nullptr);
    this->for_each_lane(strip, [&](Index pack, int lane, Index, int) {
      const std::size_t number = lane_number(strip, pack, lane);
      next_[number] = next.data() + (internal_[number] - displacements.internal.data());
    });
  }
  void read(Index part, const BranchDisplacements& displacements) {
    if (displacements.step != nullptr) {
      blocks_.packs.template read<d>(part, displacements.step->middle, blocks_.numbers.displacement);
      blocks_.packs.template read<d>(part, displacements.step->increment, blocks_.numbers.increment);
      blocks_.packs.template read<d>(part, displacements.step->end, blocks_.numbers.end);
    }
    const Vector* const other =
        displacements.displacement != nullptr ? displacements.displacement : &displacements.step->start;
    blocks_.packs.template read<d>(part, *other, blocks_.numbers.at);
  }
  /// Computes the strains of a step, and E₀ or E at the displacement.
  void find_all_strains(const PackStrip<d>& strip, Index begin, const BranchDisplacements& displacements) {
    const Index count = strip.points();
    has_step_ = displacements.step != nullptr;
    has_displacement_ = displacements.displacement != nullptr;
    if (has_step_) {
      find_gradients(strip, blocks_.numbers.displacement.data() + begin, gradients_.data());
      find_gradients(strip, blocks_.numbers.increment.data() + begin, others_.data());
      static_cast<void>(find_strains<d>(count, false, gradients_.data(), others_.data(), middle_.data()));
      find_gradients(strip, blocks_.numbers.end.data() + begin, ends_.data());
      static_cast<void>(find_strains<d>(count, false, ends_.data(), nullptr, end_.data()));
    }
    find_gradients(strip, blocks_.numbers.at.data() + begin, others_.data());
    static_cast<void>(find_strains<d>(count, false, others_.data(), nullptr, other_.data()));
  }
  [[nodiscard]] BranchPoints<d> points(const PackStrip<d>& strip) const {
    return {strip.end - strip.begin,
            strip.block.points,
            blocks_.branches[this->material_number()],
            internal_.data(),
            has_step_ ? middle_.data() : nullptr,
            has_displacement_ ? nullptr : other_.data(),
            has_step_ ? end_.data() : nullptr,
            has_displacement_ ? other_.data() : nullptr};
  }

  const Blocks<d>& blocks_;
  bool has_step_ = false, has_displacement_ = false;
  std::array<const double*, most_lanes> internal_;
  std::array<double*, most_lanes> next_;
  // At the middle and the end of a step, and at its start or at a displacement.
  alignas(64) StripNumbers<gradient_components<d>> gradients_, ends_, others_;
  alignas(64) StripNumbers<strain_components<d>> middle_, end_, other_, result_;
};

/// Calls find(strips, strip, part, forces of the part, null if there are no `forces`) for all strips with branches,
/// several parts at once, and sums the forces.
template <class Find>
void ElasticCells::visit_branches(const BranchDisplacements& displacements, const Find& find, Vector* forces) const {
  with_dimension(body_.mesh->dimension, [&](auto dimension) {
    constexpr int d = dimension;
    const Blocks<d>& all = blocks<d>();
    all.set_branches(displacements.step != nullptr ? displacements.step->step : 0.0);
    for_each_part<d, BranchStrips>([&](Index part, Index begin, BranchStrips<d>& strips) {
      if (forces != nullptr) all.packs.template clear<d>(part, all.numbers.force);
      double* const own = forces != nullptr ? all.numbers.force.data() + begin : nullptr;
      strips.for_each_strip(part, begin, displacements, internal_begin_,
                            [&](const PackStrip<d>& strip) { find(strips, strip, part, own); });
    });
    if (forces != nullptr) all.packs.template add_up<d>(all.numbers.force, *forces);
  });
}

void ElasticCells::add_up_branches(BranchStress of, const BranchDisplacements& displacements, Vector& result) const {
  visit_branches(
      displacements,
      [of](auto& strips, const auto& strip, Index, double* forces) { strips.add_forces(of, strip, forces); }, &result);
}

/// Sums find(strips, strip), the contribution of a strip.
template <class Find>
double ElasticCells::sum_branches(const BranchDisplacements& displacements, const Find& find) const {
  std::array<double, most_node_parts> sums{};
  visit_branches(
      displacements,
      [&](auto& strips, const auto& strip, Index part, double*) { sums[std::size_t(part)] += find(strips, strip); },
      nullptr);
  double total = 0.0;
  for (const double sum : sums) total += sum;
  return total;
}

void ElasticCells::relax(const Vector& displacement, Vector& internal) const {
  internal.setZero(internal_size());
  const BranchDisplacements displacements{nullptr, &displacement, internal};
  sum_branches(displacements, [&](auto& strips, const auto& strip) {
    strips.relax(strip, displacements, internal);
    return 0.0;
  });
}

double ElasticCells::branch_energy(const Vector& displacement, const Vector& internal) const {
  return sum_branches({nullptr, &displacement, internal},
                      [](auto& strips, const auto& strip) { return strips.work(BranchWork::energy, strip); });
}

void ElasticCells::mean_branch_force(const BranchStep& step, Vector& result) const {
  add_up_branches(BranchStress::mean, {&step, nullptr, step.internal}, result);
}

void ElasticCells::end_branch_force(const BranchStep& step, Vector& result) const {
  add_up_branches(BranchStress::end, {&step, nullptr, step.internal}, result);
}

double ElasticCells::start_branch_energy(const BranchStep& step, const Vector& displacement) const {
  return sum_branches({&step, &displacement, step.internal},
                      [](auto& strips, const auto& strip) { return strips.work(BranchWork::start_energy, strip); });
}

double ElasticCells::advance_internal(const BranchStep& step, Vector& internal) const {
  internal.resize(internal_size());
  const BranchDisplacements displacements{&step, nullptr, step.internal};
  return sum_branches(displacements,
                      [&](auto& strips, const auto& strip) { return strips.advance(strip, displacements, internal); });
}

}  // namespace ricochet
