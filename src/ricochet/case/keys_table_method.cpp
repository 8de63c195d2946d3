#include "ricochet/case/keys_table.hpp"
#include "ricochet/case/names.hpp"

// Keys on the numerical method: mass matrix, time scheme, solver of a step.
namespace ricochet {

Section mass_section() {
  Section section{
      .name = "mass",
      .doc = "The mass matrix.",
      .keys = {{.name = "type",
                .type = KeyType::choice,
                .default_value = "equivalent",
                .doc = "The equivalent masses have no inertia on contact nodes, and keep total mass, centre of gravity "
                       "and moments of inertia. \"equivalent-lumped\" is diagonal, for the scheme \"semi-explicit\". "
                       "\"equivalent\" is built as \"equivalent-cellwise\" in space, whose factors are those of "
                       "\"consistent\", and as \"equivalent-nodewise\" (or \"equivalent-compact\" with over 2,000 "
                       "contact nodes) "
                       "in the plane and on coarse bodies; `mass_built` in summary.json says so."}}};
  return with_types(std::move(section), "type", mass_registry());
}

Section time_section() {
  Section section{
      .name = "time",
      .required = true,
      .doc = "The time scheme and its steps.",
      .keys = {
          {.name = "scheme",
           .type = KeyType::choice,
           .default_value = "reduced-kane",
           .doc = "The time scheme. The default creates no energy on planes at any step; it needs a mass without "
                  "inertia on the contact nodes (mass.type)."},
          {.name = "step",
           .type = KeyType::number,
           .unit = "time",
           .required = true,
           .choices = {adaptive_steps},
           .range = positive,
           .doc = "Length of a time step; explicit schemes refuse one above their critical step, which `ricochet "
                  "info` shows. \"adaptive\": the length follows the motion, within `tolerance`, `largest` and "
                  "`smallest`."},
          {.name = "tolerance",
           .type = KeyType::number,
           .unit = "1",
           .range = {.above = 0.0, .at_most = 0.1},
           .doc = "Of adaptive steps: allowed error of a step, in the norm of the kinetic energy and relative to the "
                  "root of the largest energy so far, or of what a step of the longest length would bring where motion "
                  "sets off from rest. A step with more is taken again with a shorter one. Default: 1e-3."},
          {.name = "largest",
           .type = KeyType::number,
           .unit = "time",
           .range = positive,
           .doc = "Of adaptive steps, and required there: the longest. All lengths are this times a power of 1/2."},
          {.name = "smallest",
           .type = KeyType::number,
           .unit = "time",
           .range = positive,
           .doc = "Of adaptive steps: at most this long are those that are taken whatever their error; a run counts "
                  "them. Default: a millionth of `largest`."},
          {.name = "end",
           .type = KeyType::number,
           .unit = "time",
           .required = true,
           .range = positive,
           .doc = "The run goes from t = 0 to here; at least one step and at most 1e9."},
      }};
  return with_types(std::move(section), "scheme", scheme_registry());
}

Section solver_section() {
  return {
      .name = "solver",
      .doc = "How a step is solved. Every key has a default.",
      .keys = {
          {.name = "method",
           .type = KeyType::choice,
           .default_value = "auto",
           .choices = {"auto", "direct", "iterative"},
           .doc = "\"direct\": a Cholesky factor, made once; exact to rounding. \"iterative\": conjugate gradients "
                  "with a direct solve near the contact; takes little memory and no time to factorize, and a few "
                  "times as long per step where a wave crosses a few cells in it, more where it crosses many. "
                  "\"auto\": iterative where a factor does not fit into memory, or where making it and solving with it "
                  "takes longer than the iterations of all steps, by estimate (one that is made within ten seconds is "
                  "always made). A "
                  "static start is solved as by \"auto\", the contact nodes of \"semi-explicit\" always directly. "
                  "Several processes "
                  "of `ricochet-mpi` always iterate."},
          {.name = "tolerance",
           .type = KeyType::number,
           .unit = "1",
           .default_value = "1e-10",
           .range = {.above = 0.0, .at_most = 1e-3},
           .doc =
               "Allowed residual of the iterative method in a step, relative to the forces of the step, in the energy "
               "norm. Contact and friction hold to rounding with any method."},
          {.name = "memory",
           .type = KeyType::number,
           .unit = "GB",
           .range = positive,
           .doc = "Memory that factors may take when \"auto\" chooses. Default: half of the machine's memory."},
          {.name = "preconditioner",
           .type = KeyType::choice,
           .default_value = "auto",
           .choices = {"auto", "block-jacobi", "gamg", "boomeramg", "mumps"},
           .doc =
               "Of the iterative method. \"block-jacobi\": the diagonal blocks of the nodes. The others are those of "
               "`ricochet-mpi`: \"gamg\" and \"boomeramg\", algebraic multigrid of PETSc and hypre, and "
               "\"mumps\", a factor of the whole body by all processes. \"auto\": diagonal blocks, and with "
               "`ricochet-mpi` \"gamg\" where a wave crosses many cells in a step and there are steps enough to pay "
               "for it."},
          {.name = "contact_points",
           .type = KeyType::choice,
           .default_value = "near",
           .choices = {"near", "all"},
           .doc = "\"near\": the points that may touch in a step take part in its contact problem; others are looked "
                  "at after it, and where one has penetrated the step is solved again with it. \"all\": all do, which "
                  "changes results by rounding only; for exported contact problems of one size."},
      }};
}

}  // namespace ricochet
