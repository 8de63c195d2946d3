#include <fmt/format.h>

#include <algorithm>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/fem/wave_speed.hpp"
#include "ricochet/model/model_parts.hpp"

namespace ricochet {

namespace {

PlaneState plane_state(const Case& input) {
  if (is_axisymmetric(input)) return PlaneState::axisymmetric;
  return input.mesh.plane == "stress" ? PlaneState::stress : PlaneState::strain;
}

/// Poisson's ratio from which the mean dilatation is used, and the one from which cells without it lock. (The ratio is
/// recomputed from λ and μ, so that 0.45 itself may come out slightly smaller or larger.)
constexpr double mean_from = 0.4, locks_from = 0.45 * (1.0 - 1e-9);

/// Returns true if some cells have a mean dilatation that differs from its point values, which cells with one
/// quadrature point do not.
bool has_cells_with_mean(const Case& input, const Mesh& mesh) {
  const auto is_of_simplices = [](const CellBlock& block) { return is_simplex(block.shape); };
  return input.mesh.degree > 1 || !std::ranges::all_of(mesh.cells, is_of_simplices);
}

void choose_dilatation(const Case& input, std::size_t i, Model& model) {
  const MaterialSection& section = input.materials[i];
  Material& material = model.body.materials[i];
  const bool has_mean = material.law->volumetric_modulus() > 0.0 && has_cells_with_mean(input, model.mesh) &&
                        !is_plane_stress(model.body);
  if (section.dilatation == "mean" && !has_mean) {
    std::vector<std::string> laws;
    for (const MaterialLawRegistration& law : material_law_registry().all()) {
      if (law.type.has_volumetric_energy) laws.push_back(law.name);
    }
    refuse(input, fmt::format("material.{}.dilatation", i),
           fmt::format("\"mean\" requires a law with a separate volumetric energy ({}), cells other than triangles or "
                       "tetrahedra of degree 1, and no plane stress",
                       fmt::join(laws, ", ")));
  }
  const double poisson = material.poisson();
  material.mean_dilatation =
      has_mean && (section.dilatation == "mean" || (section.dilatation == "automatic" && poisson >= mean_from));
  const bool locks = input.mesh.degree == 1 && !is_plane_stress(model.body) && !material.mean_dilatation;
  if (!locks || poisson < locks_from) return;
  log::warning(fmt::format(
      "material \"{}\" is nearly incompressible (Poisson's ratio {:.4g}): elements of degree 1 lock and "
      "are far too stiff; use mesh.degree = 2{}",
      section.group, poisson,
      material.law->is_linear() ? ""
                                : ", or " + names_of_cells(false) + ", which do not lock with the mean dilatation"));
}

/// Adds the viscoelastic branches.
void add_relaxation(const Case& input, std::size_t i, Model& model) {
  const RelaxationSection& section = input.materials[i].relaxation;
  if (section.time.empty()) return;
  Material& material = model.body.materials[i];
  const std::string key = fmt::format("material.{}.relaxation", i);
  if (material.law->is_linear()) {
    refuse(input, key,
           "the law \"linear\" does not support viscoelastic branches: use \"saint-venant-kirchhoff\", which is the "
           "same for small strains, or another law of finite strain");
  }
  if (is_plane_stress(model.body))
    refuse(input, key,
           "viscoelastic branches are supported in plane strain, axisymmetric bodies and solids, not with mesh.plane = "
           "\"stress\"");
  for (std::size_t k = 0; k < section.time.size(); ++k) {
    material.relaxation.push_back({section.modulus[k], section.time[k]});
    if (input.time.adaptive || !(input.time.step > section.time[k])) continue;
    log::info(
        fmt::format("{}: time.step is {:.3g} times the relaxation time {:.3g}: steps do not resolve the relaxation of "
                    "that branch, which is relaxed at the end of each step",
                    input.where(key).text(), input.time.step / section.time[k], section.time[k]));
  }
}

/// Returns the key of the first of these parameters that the case gives.
std::string key_of(const MaterialSection& section, std::size_t i, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (section.parameters.has(name)) return fmt::format("material.{}.{}", i, name);
  }
  return fmt::format("material.{}.law", i);
}

/// Refuses moduli of one material that differ too much: they are summed in one operator, so that of the 16 digits of
/// the softest only those remain that the stiffest leaves. (Different materials may differ arbitrarily.)
void require_digits(const Case& input, std::size_t i, const Model& model) {
  constexpr double most = 1e13;  // three digits
  const MaterialSection& section = input.materials[i];
  const Material& material = model.body.materials[i];
  const double shear = material.law->mu(), bulk = material.law->lambda() + 2.0 / 3.0 * shear;
  double at_once = 0.0;
  for (const RelaxationBranch& branch : material.relaxation) at_once += branch.modulus;
  if (!(at_once <= most)) {
    refuse(
        input, fmt::format("material.{}.relaxation", i),
        fmt::format("the entries of \"modulus\" sum to {:.3g}: they are relative to the shear modulus of the law, the "
                    "long-term modulus, of which hardly a digit remains beside a sum of {:.0e} or more; the constants "
                    "of the law are the long-term ones, so use larger constants there and smaller entries here",
                    at_once, most));
  }
  if (bulk > most * shear || shear > most * bulk) {
    const bool is_stiff_in_volume = bulk > shear;
    refuse(
        input, key_of(section, i, {"poisson", "bulk_modulus", "lambda"}),
        fmt::format("material \"{}\" has the shear modulus {:.3g} and the bulk modulus {:.3g}: beside the larger one "
                    "hardly a digit of the other remains (their ratio must not exceed {:.0e}); {}",
                    section.group, shear, bulk, most,
                    is_stiff_in_volume ? "use a Poisson's ratio of at most 0.49999, which is nearly incompressible, too"
                                       : "use a Poisson's ratio of at least -0.9999, which is practically -1"));
  }
}

/// Refuses a step so long that a body without supports keeps no digit of its inertia. Only inertia resists its rigid
/// motion, and it is added to a stiffness (h ω)² times as large, where ω, the highest frequency of the mesh, exceeds
/// that of a wave that crosses the whole mesh.
void require_inertia(const Case& input, std::size_t i, const Model& model) {
  constexpr double most = 1e15;
  if (!input.supports.empty()) return;
  const Material& material = model.body.materials[i];
  const double speed = compression_wave_speed(material, is_plane_stress(model.body));
  const double crossings = input.time.step * speed / extent(model.mesh.nodes);
  if (crossings * crossings <= most) return;
  refuse(input, key_of(input.materials[i], i, {"young", "mu", "c10"}),
         fmt::format("material \"{}\" has compression waves of speed {:.3g}, which cross the whole mesh {:.3g} times "
                     "in time.step = {:.3g}: beside such a stiffness no digit remains of the inertia of bodies without "
                     "supports; check the units of stiffness ({:.3g}, Young's modulus) and density ({:.3g})",
                     input.materials[i].group, speed, crossings, input.time.step, material.young(), material.density));
}

/// Warns if λ is thousands of times μ: its changes during the iterations then hide those of μ.
void warn_of_iterations(const Case& input, std::size_t i, const Model& model) {
  constexpr double many = 5000.0;
  const Material& material = model.body.materials[i];
  const double ratio = material.law->lambda() / material.law->mu();
  if (material.law->is_linear() || ratio <= many) return;
  log::warning(
      fmt::format("{}: material \"{}\" is incompressible to one part in {:.3g} (lambda / mu, Poisson's ratio "
                  "{:.8g}): Newton's method takes many iterations, or fails; a ratio of 1000 (Poisson's ratio "
                  "0.4995) is nearly incompressible, too",
                  input.where(key_of(input.materials[i], i, {"poisson", "bulk_modulus", "lambda"})).text(),
                  input.materials[i].group, ratio, material.poisson()));
}

/// Refuses a linear law beside laws of finite strain: a body with a linear law does not recognize its rotation, and the
/// watch of rotations would have to distinguish the bodies.
void require_one_kind_of_law(const Case& input, const Model& model) {
  if (!has_finite_strain(model.body)) return;
  for (std::size_t i = 0; i < model.body.materials.size(); ++i) {
    if (!model.body.materials[i].law->is_linear()) continue;
    refuse(input, fmt::format("material.{}.law", i),
           "another material has a law of finite strain, and \"linear\" is valid for small rotations only: use "
           "\"saint-venant-kirchhoff\", which is the same for small strains and valid for any rotation");
  }
}

void refuse_fields_of_finite_strain(const Case& input, const Model& model) {
  if (has_finite_strain(model.body)) return;
  for (const std::string& name : input.output.fields) {
    if (name.starts_with("nominal_")) {
      refuse(input, "output.fields",
             fmt::format("\"{}\" requires a law of finite strain; with the linear law of this case it is the same as "
                         "\"{}\": use that field, or set material.law",
                         name, name.substr(std::string_view("nominal_").size())));
    }
    if (!name.starts_with("principal_stretch")) continue;
    refuse(input, "output.fields",
           fmt::format("\"{}\" requires a law of finite strain, but this case has the linear law, whose stretches are "
                       "1 + principal strain: leave it out, or set material.law",
                       name));
  }
}

}  // namespace

void assign_materials(const Case& input, Model& model) {
  const Mesh& mesh = model.mesh;
  model.body = Body{&mesh, &model.space, plane_state(input), {}, {}};
  model.problem.axisymmetric = is_axisymmetric(model.body);
  model.body.cell_material.assign(std::size_t(mesh.cell_count()), -1);
  for (std::size_t i = 0; i < input.materials.size(); ++i) {
    const MaterialSection& section = input.materials[i];
    const std::string key = fmt::format("material.{}.group", i);
    for (const Index cell : group_at(input, key, mesh, section.group, mesh.dimension).members) {
      int& assigned = model.body.cell_material[std::size_t(cell)];
      if (assigned >= 0) {
        refuse(input, key,
               fmt::format("groups \"{}\" and \"{}\" overlap: they share cells, which would have two materials",
                           input.materials[std::size_t(assigned)].group, section.group));
      }
      assigned = int(i);
    }
    model.body.materials.push_back({section.group, section.density, make_material_law(section.law, section.parameters),
                                    section.damping.mass, section.damping.stiffness});
    add_relaxation(input, i, model);
    require_digits(input, i, model);
    require_inertia(input, i, model);
    choose_dilatation(input, i, model);
    warn_of_iterations(input, i, model);
  }
  require_one_kind_of_law(input, model);
  refuse_fields_of_finite_strain(input, model);
  Index without = 0;
  for (const int material : model.body.cell_material) without += material < 0 ? 1 : 0;
  if (without > 0) {
    std::vector<std::string> names;
    for (const Group& group : mesh.groups) {
      if (group.dimension == mesh.dimension) names.push_back(group.name);
    }
    refuse(input, "material",
           fmt::format("{} of {} of {} {} no material: add a [[material]] for every group of cells (the mesh has {}), "
                       "and put every cell into a group",
                       without, counted(mesh.cell_count(), "cell"), mesh.source, without == 1 ? "has" : "have",
                       names.empty() ? "none" : join_names(names)));
  }
}

}  // namespace ricochet
