#include "ricochet/case/keys_table.hpp"
#include "ricochet/case/names.hpp"
#include "ricochet/linear_algebra/preconditioner_factory.hpp"

// Keys on the numerical method: mass matrix, time scheme, solver of a step.
namespace ricochet {

namespace {

std::vector<std::string> preconditioner_choices() {
  std::vector<std::string> names = preconditioner_registry().names();
  names.insert(names.begin(), "auto");
  return names;
}

}  // namespace

Section mass_section() {
  Section section{.name = "mass", .doc = "The mass matrix."};
  section.keys = {
      key("type", &MassSection::type, {.default_value = "equivalent"},
          "The type of mass matrix. The equivalent masses have no inertia on contact nodes, and preserve the total "
          "mass, the centre of gravity and the moments of inertia. \"equivalent-lumped\" is diagonal, for the scheme "
          "\"semi-explicit\". \"equivalent\" is built as \"equivalent-cellwise\" in three dimensions, where its "
          "factors cost the same as those of \"consistent\", and as \"equivalent-nodewise\" (or \"equivalent-compact\" "
          "with more than 2,000 contact nodes) in two dimensions and on coarse bodies; `mass_built` in summary.json "
          "records the choice."),
  };
  return with_types(std::move(section), "type", mass_registry(), &MassSection::parameters);
}

Section time_section() {
  Section section{.name = "time", .required = true, .doc = "The time scheme and its steps."};
  section.keys = {
      key("scheme", &TimeSection::scheme, {.default_value = "reduced-kane"},
          "The time scheme. The default creates no energy on planes with any step length; it requires a mass matrix "
          "without inertia on the contact nodes (mass.type)."),
      key("step", {member(&TimeSection::step), is_choice(&TimeSection::adaptive, adaptive_steps)},
          {.type = KeyType::number, .unit = "time", .required = true, .choices = {adaptive_steps}, .range = positive},
          "Length of a time step; explicit schemes refuse a length above their critical step, which `ricochet info` "
          "shows. \"adaptive\": the length follows the motion, as controlled by `tolerance`, `largest` and "
          "`smallest`."),
      key("tolerance", &TimeSection::tolerance, {.unit = "1", .range = {.above = 0.0, .at_most = 0.1}},
          "For adaptive steps: allowed error of a step, in the norm of the kinetic energy and relative to the square "
          "root of the largest energy so far or, where motion starts from rest, of the energy that a step of the "
          "largest length would add. A step with a larger error is repeated with a shorter length. Default: 1e-3."),
      key("largest", {}, {.type = KeyType::number, .unit = "time", .range = positive},
          "For adaptive steps, and required for them: the largest length. All lengths are this length times a power of "
          "1/2."),
      key("smallest", &TimeSection::smallest, {.unit = "time", .range = positive},
          "For adaptive steps: a step of at most this length is accepted whatever its error; the run counts such "
          "steps. Default: a millionth of `largest`."),
      key("end", &TimeSection::end, {.unit = "time", .required = true, .range = positive},
          "End time of the run, which starts at t = 0; at least one step and at most 1e9 steps."),
  };
  return with_types(std::move(section), "scheme", scheme_registry(), &TimeSection::parameters);
}

Section solver_section() {
  Section section{.name = "solver", .doc = "How a step is solved. Every key has a default."};
  section.keys = {
      key("method", &SolverSection::method, {.default_value = "auto", .choices = {"auto", "direct", "iterative"}},
          "\"direct\": a Cholesky factor, computed once; exact to rounding. \"iterative\": conjugate gradients with a "
          "direct solve near the contact; needs little memory and no time to factorize, but is a few times slower per "
          "step if a wave crosses a few cells in a step, and slower still if it crosses many. \"auto\": iterative if a "
          "factor does not fit into memory, or if computing it and solving with it is estimated to take longer than "
          "the iterations of all steps (a factor that takes at most ten seconds is always computed). A static start is "
          "solved as with \"auto\"; the contact nodes of \"semi-explicit\" are always solved directly. Runs of "
          "`ricochet-mpi` on several processes always iterate."),
      key("tolerance", &SolverSection::tolerance,
          {.unit = "1", .default_value = "1e-10", .range = {.above = 0.0, .at_most = 1e-3}},
          "Allowed residual of the iterative method in a step, relative to the forces of the step, in the energy norm. "
          "The conditions of contact and friction hold to rounding with any method."),
      key("newton_tolerance", &SolverSection::newton_tolerance,
          {.unit = "1", .default_value = "1e-8", .range = {.above = 0.0, .at_most = 1e-3}},
          "Laws of finite strain under reduced-kane, mean-reaction and reduced-midpoint: error that Newton's method "
          "leaves in the increment of a step, relative to the increment. As long as bodies move, momenta, the account "
          "of energy and the rule that no step creates energy hold to rounding with any value. Below 1e-13 rounding "
          "determines the error. Other schemes always iterate to 1e-13."),
      key("memory", &SolverSection::memory, {.unit = "GB", .range = positive},
          "Memory that factors may occupy when \"auto\" selects the method. Default: half of the machine's memory."),
      key("preconditioner", &SolverSection::preconditioner,
          {.default_value = "auto", .choices = preconditioner_choices()},
          "Preconditioner of the iterative method. \"block-jacobi\": the diagonal blocks of the nodes. The others are "
          "available in `ricochet-mpi` only: \"gamg\" and \"boomeramg\", algebraic multigrid of PETSc and hypre, and "
          "\"mumps\", a factor of the whole body that all processes compute together. \"auto\": diagonal blocks; with "
          "`ricochet-mpi` \"gamg\" if a wave crosses many cells in a step and there are enough steps to pay for it."),
      key("contact_points", &SolverSection::contact_points, {.default_value = "near", .choices = {"near", "all"}},
          "\"near\": the points that may touch in a step take part in its contact problem; the others are checked "
          "afterwards, and if one of them has penetrated, the step is solved again with it. \"all\": all points take "
          "part, which changes results by rounding only; useful to export contact problems of the same size."),
  };
  return section;
}

}  // namespace ricochet
