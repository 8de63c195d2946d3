#include "ricochet/fem/path_kernels.hpp"
#include "ricochet/fem/strip_visits.hpp"

/// @file Forces of the mean stress along the path of the strain over a step (strain_path.hpp).
namespace ricochet {

/// Computations of the mean stress on strips.
template <int d>
class ElasticCells::PathWork : public StripWork<d> {
 public:
  using StripWork<d>::StripWork;

  /// Computes Ē and ΔE from the numbers of a part. Updates `worst` if a cell is inverted at the middle.
  void find_path(const PackStrip<d>& strip, const double* middle, const double* increments, CellVolume& worst) {
    const bool is_linear = this->law().is_linear();
    find_gradients(strip, middle, gradients_.data());
    find_gradients(strip, increments, increments_.data());
    const bool upright = ricochet::find_strains<d>(strip.points(), is_linear, gradients_.data(),
                                                   is_linear ? nullptr : increments_.data(), strains_.data());
    this->complete(strip, upright, worst);
    if (is_linear) return;
    find_strain_changes<d>(strip.points(), gradients_.data(), increments_.data(), changes_.data());
    copy(strip, strains_, means_);
  }

  /// Adds the forces of S̄ after find_path(), with the rules of all cells.
  void add_path_forces(const PackStrip<d>& strip, const PathRules& rules, double* forces, CellVolume& worst) {
    if (this->law().is_linear()) return this->add_forces(strip, forces);
    const bool any_exact = read_rules(strip, rules);
    std::fill_n(sums_.data(), numbers(strip), 0.0);
    for (const PathGaussRule& rule : path_gauss_rules()) {
      if (std::ranges::any_of(path_rule_table, [&](const auto& each) { return uses(each, rule); }))
        add_stresses(strip, rule, worst);
    }
    if (any_exact) make_work_exact(strip, worst);
    ricochet::add_forces(strip, false, gradients_.data(), sums_.data(), forces);
  }

  /// Raises the rules of cells with large changes after find_path(). Returns whether any was raised.
  [[nodiscard]] bool raise(const PackStrip<d>& strip, PathRules& rules) {
    if (this->law().is_linear()) return false;
    find_products<d>(strip.points(), changes_.data(), changes_.data(), stresses_.data());
    bool raised = false;
    this->for_each_lane(strip, [&](Index, int lane, Index first, int cell) {
      double largest = 0.0;
      for (Index point = first; point < first + strip.block.points; ++point)
        largest = std::max(largest, stresses_[std::size_t(point * strip.block.width + lane)]);
      PathRule& own = rules[std::size_t(cell + this->first_cell())];
      const PathRule wanted = path_rule(largest);
      raised = raised || wanted > own;
      own = std::max(own, wanted);
    });
    return raised;
  }

 private:
  using typename StripWork<d>::StrainNumbers;
  using StripWork<d>::gradients_;
  using StripWork<d>::strains_;
  using StripWork<d>::stresses_;
  /// Numbers per pack of a strip and lane.
  using LaneNumbers = std::array<double, std::size_t(CellStrips<d>::points_at_once* most_pack_width)>;

  [[nodiscard]] static Index numbers(const PackStrip<d>& strip) {
    return strip.points() * strain_components<d> * strip.block.width;
  }
  static void copy(const PackStrip<d>& strip, const StrainNumbers& from, StrainNumbers& to) {
    std::copy_n(from.data(), numbers(strip), to.data());
  }
  [[nodiscard]] static std::size_t lane_number(const PackStrip<d>& strip, Index pack, int lane) {
    return std::size_t((pack - strip.begin) * strip.block.width + lane);
  }

  bool read_rules(const PackStrip<d>& strip, const PathRules& rules) {
    uses_ = {};
    bool any_exact = false;
    this->for_each_lane(strip, [&](Index pack, int lane, Index, int cell) {
      const PathRule rule = rules[std::size_t(cell + this->first_cell())];
      rules_[lane_number(strip, pack, lane)] = rule;
      uses_[std::size_t(rule)] = true;
      any_exact = any_exact || is_exact(rule);
    });
    return any_exact;
  }
  /// Sets one weight per lane in use, and zero in the others.
  template <class Weight>
  void set_weights(const PackStrip<d>& strip, const Weight& weight) {
    weights_.fill(0.0);
    this->for_each_lane(strip, [&](Index pack, int lane, Index first, int) {
      const std::size_t number = lane_number(strip, pack, lane);
      weights_[number] = weight(rules_[number], pack, lane, first);
    });
  }
  /// Computes the strains at τ. All volumes are positive there, but under plane stress there may be no thickness.
  void go_to(const PackStrip<d>& strip, double tau, CellVolume& worst) {
    move_along<d>(strip.points(), means_.data(), changes_.data(), tau, strains_.data());
    this->complete(strip, true, worst);
  }
  [[nodiscard]] bool uses(const PathRuleProperties& each, const PathGaussRule& gauss) const {
    return uses_[std::size_t(each.rule)] && each.points == gauss.count;
  }
  /// Adds the stresses at the points of a Gauss rule to S̄ of the cells that use it.
  void add_stresses(const PackStrip<d>& strip, const PathGaussRule& gauss, CellVolume& worst) {
    for (std::size_t q = 0; q < std::size_t(gauss.count); ++q) {
      go_to(strip, gauss.points[q], worst);
      this->find_stresses(strip);
      set_weights(strip, [&](PathRule own, Index, int, Index) {
        return properties_of(own).points == gauss.count ? gauss.weights[q] : 0.0;
      });
      add_weighted(strip, weights_.data(), stresses_.data(), sums_.data());
    }
  }
  /// Adds c ΔE to S̄ of the cells whose work is made exact.
  void make_work_exact(const PackStrip<d>& strip, CellVolume& worst) {
    go_to(strip, 0.5, worst);
    this->find_energies(strip, ends_.data());
    go_to(strip, -0.5, worst);
    this->find_energies(strip, starts_.data());
    find_products<d>(strip.points(), sums_.data(), changes_.data(), works_.data());
    find_products<d>(strip.points(), changes_.data(), changes_.data(), stresses_.data());
    const KernelBlock<d>& block = strip.block;
    set_weights(strip, [&](PathRule own, Index pack, int lane, Index first) {
      if (!is_exact(own)) return 0.0;
      double lacking = 0.0, square = 0.0;
      for (int q = 0; q < block.points; ++q) {
        const double weight = block.weight[std::size_t(block.index(pack, q) + lane)];
        const auto at = std::size_t((first + q) * block.width + lane);
        lacking += weight * (ends_[at] - starts_[at] - works_[at]);
        square += weight * stresses_[at];
      }
      return square > 0.0 ? lacking / square : 0.0;
    });
    add_weighted(strip, weights_.data(), changes_.data(), sums_.data());
  }

  // Overwritten strip by strip.
  alignas(64) StripNumbers<gradient_components<d>> increments_;
  alignas(64) StrainNumbers means_, changes_, sums_;  ///< Ē, ΔE, S̄
  alignas(64) LaneNumbers weights_;
  alignas(64) StripNumbers<1> ends_, starts_, works_;  ///< energies at both ends; S̄ : ΔE
  std::array<PathRule, std::size_t(CellStrips<d>::points_at_once* most_pack_width)> rules_;
  std::array<bool, path_rule_table.size()> uses_{};  ///< whether a rule occurs in the strip
};

CellVolume ElasticCells::path_force(const Vector& middle, const Vector& increment, const PathRules& rules,
                                    Vector& result) const {
  return visit_strips<PathWork>(
      {{middle, &PackNumbers::displacement}, {increment, &PackNumbers::increment}}, {{&PackNumbers::force, result}},
      [&](auto& strips, const auto& strip, const PackPart& part) {
        strips.find_path(strip, part.at(&PackNumbers::displacement), part.at(&PackNumbers::increment), part.worst);
        strips.add_path_forces(strip, rules, part.at(&PackNumbers::force), part.worst);
      });
}

bool ElasticCells::raise_path_rules(const Vector& middle, const Vector& increment, PathRules& rules) const {
  std::array<bool, most_node_parts> raised{};
  visit_strips<PathWork>({{middle, &PackNumbers::displacement}, {increment, &PackNumbers::increment}}, {},
                         [&](auto& strips, const auto& strip, const PackPart& part) {
                           strips.find_path(strip, part.at(&PackNumbers::displacement),
                                            part.at(&PackNumbers::increment), part.worst);
                           if (strips.raise(strip, rules)) raised[std::size_t(part.part)] = true;
                         });
  return std::ranges::any_of(raised, [](bool each) { return each; });
}

}  // namespace ricochet
