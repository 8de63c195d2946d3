#include <fmt/format.h>

#include "commands.hpp"
#include "ricochet/case/model.hpp"
#include "ricochet/case/read_case.hpp"
#include "ricochet/case/run_case.hpp"
#include "ricochet/mesh/read_mesh.hpp"
#include "ricochet/simulation/simulation.hpp"

namespace ricochet::program {

int validate(const std::string& case_file, const std::vector<std::string>& overrides) {
  const Case input = read_case(case_file, overrides);
  if (needs_gmsh_program(input.mesh.file)) {
    require_mesh_file(input);
    // A .geo file can run shell commands: only `run` hands one to gmsh.
    fmt::print("{}: valid, as far as can be told without meshing {}\n", case_file, input.mesh.file);
    return 0;
  }
  const std::unique_ptr<Model> model = build_model(input);
  check_expected_columns(input, *model);
  // The start of a run, thrown away: some things do not go together, and some operators cannot be factorized.
  const std::unique_ptr<Scheme> scheme = make_scheme(input.time);
  const Simulation simulation(model->problem, *scheme, model->initial, step_solver_options(input));
  fmt::print("{}: valid: {} nodes, {} cells, {} contact points, {} supported dofs, {} steps\n", case_file,
             model->space.node_count(), model->mesh.cell_count(), model->problem.contact.size(),
             model->problem.supports.size(), step_count(input.time));
  return 0;
}

}  // namespace ricochet::program
