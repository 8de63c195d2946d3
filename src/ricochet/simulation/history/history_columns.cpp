#include "ricochet/simulation/history/history_columns.hpp"

namespace ricochet {

namespace {

using RowCondition = Condition<HistoryRow>;
constexpr RowCondition finite_strain{"laws of [finite strain](finite-strain.md#time)",
                                     [](const HistoryRow& row) { return !row.problem->internal_force->is_linear(); }};
constexpr RowCondition branches{
    "[`relaxation`](finite-strain.md#viscoelastic-branches) of a material",
    [](const HistoryRow& row) { return row.problem->internal_force->viscous() != nullptr; }};
constexpr RowCondition large_sliding{"[large sliding](sliding.md) between bodies",
                                     [](const HistoryRow& row) { return row.problem->contact.has_sliding_pairs(); }};
constexpr RowCondition self_contact{"[surfaces that touch themselves](sliding.md#a-surface-that-touches-itself)",
                                    [](const HistoryRow& row) { return row.problem->contact.touches_itself; }};

constexpr const char* one = "1";

ValuedQuantity<HistoryRow> energy(const char* name, double Energies::*member, const char* text) {
  return {{.name = name, .unit = "energy", .text = text, .group = ColumnGroup::energy},
          [member](const HistoryRow& row, Index) { return row.energies.*member; }};
}
ValuedQuantity<HistoryRow> work(const char* name, double Works::*member, const char* text,
                                ColumnGroup group = ColumnGroup::work, RowCondition condition = {}) {
  return {{.name = name, .unit = "energy", .text = text, .group = group},
          [member](const HistoryRow& row, Index) { return row.works->*member; },
          condition};
}

}  // namespace

const std::vector<ValuedQuantity<HistoryRow>>& history_quantities() {
  using Row = const HistoryRow&;
  static const std::vector<ValuedQuantity<HistoryRow>> all{
      {{"step", "steps", "number of the step; 0 for the initial state", ColumnComponents::one, Reduction::same},
       [](Row row, Index) { return double(row.state->step); }},
      {{"time", "time", "time of the state", ColumnComponents::one, Reduction::same},
       [](Row row, Index) { return row.state->time; }},
      energy("kinetic_energy", &Energies::kinetic, "$`\\tfrac12 V^TMV`$"),
      energy("elastic_energy", &Energies::elastic,
             "$`\\tfrac12 U^TKU`$; at finite strain the integral of the strain energy density. The energy that "
             "viscoelastic branches store is part of it"),
      energy("load_potential", &Energies::load_potential, "$`-L^TU`$ of the constant loads"),
      energy("algorithmic_energy", &Energies::algorithmic,
             "a further term, which Newmark's scheme conserves together with the energy"),
      {{"total_energy", "energy",
        "sum of the kinetic energy, the elastic energy and the potential of the constant loads", ColumnComponents::one,
        Reduction::sum, ColumnGroup::energy},
       [](Row row, Index) { return row.energies.total(); }},
      work("load_work", &Works::load,
           "work done on the body since the start by loads that vary in time or [follow "
           "the surface](finite-strain.md#pressure)"),
      work("contact_work", &Works::contact,
           "work of normal contact forces on the motion relative to the obstacle; this and all other works and "
           "dissipations are "
           "sums since the start"),
      work("friction_work", &Works::friction,
           "work of tangential contact forces on the motion relative to the obstacle"),
      work("support_work", &Works::support, "work of supports"),
      work("obstacle_work", &Works::obstacle, "work of all contact forces on the motion of the obstacles"),
      work("damping_work", &Works::damping, "work of damping"),
      work("numerical_dissipation", &Works::numerical_dissipation, "energy that the scheme itself has dissipated",
           ColumnGroup::balance),
      {{"energy_residual", "energy",
        "residual of the account: `total_energy` + `algorithmic_energy` + `numerical_dissipation` + "
        "`viscous_dissipation` − `integration_error`, less the six works above and the value of all this at the start; "
        "zero to rounding",
        ColumnComponents::one, Reduction::sum, ColumnGroup::balance},
       [](Row row, Index) { return row.energy_residual; }},
      {{"contact_force", "force",
        "resultant of the contact forces that obstacles exert; forces between bodies cancel in it",
        ColumnComponents::vector},
       [](Row row, Index k) { return row.contact_force[k]; }},
      {{"momentum", "mass·length/time",
        "linear momentum; of [axisymmetric bodies](axisymmetric.md#what-it-is) only that along y, all other momenta "
        "are 0",
        ColumnComponents::vector},
       [](Row row, Index k) { return row.momentum[k]; }},
      {{"angular_momentum", "mass·length²/time",
        "angular momentum about the origin with reference positions, at [finite strain](finite-strain.md) with current "
        "ones",
        ColumnComponents::axial},
       [](Row row, Index k) { return row.angular_momentum[k]; }},
      {{"max_rotation", "angle",
        "largest rotation of a cell, in rad. With the law `linear` the run warns above 0.1 that small strain no longer "
        "holds: it takes a rotation θ for a strain of 1 − cos θ",
        ColumnComponents::one, Reduction::maximum},
       [](Row row, Index) { return row.rotation; }},
      {{"active_contacts", one, "number of contact points that carry a force"},
       [](Row row, Index) { return row.active; }},
      {{"sticking", one, "number of contact points with friction that [stick](#stick-and-slip)"},
       [](Row row, Index) { return row.sticking; }},
      {{"slipping", one, "number of contact points with friction that [slip](#stick-and-slip)"},
       [](Row row, Index) { return row.slipping; }},
      {{"max_penetration", "length",
        "deepest penetration of contact nodes at this instant ([elsewhere on the boundary](#unwatched-penetration)): "
        "zero with nodal multipliers; with `p1`, `dual` and `p0` the mean gap over facets vanishes, and nodes may "
        "penetrate by a part of the deformation of a facet",
        ColumnComponents::one, Reduction::maximum},
       [](Row row, Index) { return row.penetration; }},
      {{"iterations", one, "iterations of the contact solver in this step", ColumnComponents::one, Reduction::same},
       [](Row row, Index) { return double(row.state->iterations); }},
      {{"momentum.BODY", "mass·length/time",
        "momentum of each body: BODY is the name in [`bodies`](impacts.md#bodies) without \"body\" and quotes if that "
        "is one plain name, otherwise the number",
        ColumnComponents::bodies},
       [](Row row, Index k) { return row.body_momenta[std::size_t(k)]; },
       {"meshes of 2 to 20 bodies"}},
      work("integration_error", &Works::integration_error,
           "difference between the work of the internal forces and the change of the elastic energy",
           ColumnGroup::balance, finite_strain),
      {{"newton_rounds", one, "Newton iterations of the step, all its attempts included", ColumnComponents::one,
        Reduction::same},
       [](Row row, Index) { return double(row.state->newton_iterations); },
       finite_strain},
      work("velocity_correction", &Works::velocity_correction,
           "kinetic energy that [corrections of the velocities](#what-the-method-did) have added to close the balance "
           "of steps, less what they have removed; no term of the balance. 0 for schemes without corrections",
           ColumnGroup::none, finite_strain),
      work("viscous_dissipation", &Works::viscous_dissipation,
           "energy that the viscoelastic branches have turned into heat", ColumnGroup::balance, branches),
      work("re_pairing_work", &Works::re_pairing,
           "the part of `contact_work` that stems from changes of the paired facets. Under `reduced-kane` and "
           "`kane` it and `unsettled_gap` are zero to rounding, except in steps in which the pairing was held",
           ColumnGroup::none, large_sliding),
      {{"unsettled_gap", "length", "the largest gap or overlap at which a point carries a force at the end of a step",
        ColumnComponents::one, Reduction::maximum},
       [](Row row, Index) { return row.unsettled_gap; },
       large_sliding},
      {{"left_out_points", one, "number of points whose contact condition another point enforces"},
       [](Row row, Index) { return row.left_out; },
       self_contact},
  };
  return all;
}

void HistoryRow::set_state(const State& now, EnergyAccount& account) {
  state = &now;
  energies = account.energies(now);
  works = &account.works();
  energy_residual = account.residual(energies);
  unsettled_gap = account.unsettled_gap();
}

std::vector<std::string> standard_column_names(int dimension) {
  Columns columns;
  for (const ValuedQuantity<HistoryRow>& quantity : history_quantities()) {
    if (quantity.condition.holds == nullptr) add_columns(quantity, "", dimension, columns);
  }
  return names_of(columns);
}

std::vector<std::string> history_column_names() {
  Columns columns;
  for (const int dimension : {2, 3}) {
    for (const RowQuantity& quantity : history_quantities()) add_columns(quantity, "", dimension, columns);
  }
  return names_of(columns);
}

std::vector<std::string> column_names_of(ColumnGroup group) {
  std::vector<std::string> names;
  for (const RowQuantity& quantity : history_quantities()) {
    if (quantity.group == group) names.push_back(quantity.name);
  }
  return names;
}

std::vector<std::pair<std::string, double>> balance_of(const State& state, EnergyAccount& account) {
  HistoryRow row;
  row.set_state(state, account);
  std::vector<std::pair<std::string, double>> result;
  for (const ValuedQuantity<HistoryRow>& quantity : history_quantities()) {
    if (quantity.group != ColumnGroup::none) result.emplace_back(quantity.name, quantity.value(row, 0));
  }
  return result;
}

}  // namespace ricochet
