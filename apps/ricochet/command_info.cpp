#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "commands.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/case/read_case.hpp"
#include "ricochet/hdf5/hdf5_file.hpp"
#include "ricochet/io/checkpoint.hpp"
#include "ricochet/io/progress.hpp"
#include "ricochet/io/rank_checkpoints.hpp"
#include "ricochet/mesh/read_mesh.hpp"
#include "ricochet/model/model.hpp"
#include "ricochet/run/field_schedule.hpp"
#include "ricochet/run/run_case.hpp"
#include "ricochet/run/run_description.hpp"
#include "ricochet/study/benchmark/benchmark_files.hpp"
#include "ricochet/study/study_files.hpp"
#include "texts.hpp"

namespace ricochet::program {

namespace {

namespace fs = std::filesystem;

std::string shape_text(const CellBlock& block) {
  return block.size() == 1 ? name(block.shape) : plural_name(block.shape);
}

/// Returns true for a file for which gmsh may run shell commands; only `run` and `validate --mesh` pass it to gmsh.
bool must_be_meshed_first(const MeshFile& file) { return may_run_commands(file.path) && !is_mesh_cached(file); }

void describe_mesh(const std::string& path) {
  MeshFile file;
  file.path = path;
  file.bodies_may_touch = true;  // a case states which bodies touch
  if (must_be_meshed_first(file)) {
    fmt::print(
        "{}: a geometry that has not been meshed yet: its groups and sizes are unknown. The gmsh program meshes it "
        "when a case that uses it is run, or with `ricochet validate CASE.toml --mesh`; `ricochet info CASE.toml` then "
        "describes the mesh\n",
        path);
    return;
  }
  const Mesh mesh = read_mesh(file);
  fmt::print("{}: mesh of dimension {}, degree {}, {}\n", path, mesh.dimension, mesh.degree,
             counted(mesh.node_count(), "node"));
  for (const CellBlock& block : mesh.cells) fmt::print("  cells   {:>9} {}\n", block.size(), shape_text(block));
  for (const CellBlock& block : mesh.facets) fmt::print("  facets  {:>9} {}\n", block.size(), shape_text(block));
  print_groups(mesh);
  print_cell_sizes(mesh);
  for (int k = 0; k < mesh.dimension; ++k) {
    fmt::print("  {} from {:.6g} to {:.6g}\n", "xyz"[k], mesh.nodes.row(k).minCoeff(), mesh.nodes.row(k).maxCoeff());
  }
}

void print_critical_step(double step, double critical) {
  fmt::print("  critical step {:.6g}; the step is {:.3g} of it\n", critical, step / critical);
}

std::string refinement_text(int refinements) {
  if (refinements == 0) return "";
  return fmt::format(", its cells refined {}", refinements == 1 ? "once" : fmt::format("{} times", refinements));
}

void print_files(const Case& input) {
  const char* const axisymmetric = input.mesh.plane == "axisymmetric" ? ", axisymmetric" : "";
  if (input.parts.empty()) {
    fmt::print("  mesh    {}{} (displacement of degree {}{})\n", input.mesh.file,
               refinement_text(input.mesh.refinements), input.mesh.degree, axisymmetric);
    return;
  }
  fmt::print("  mesh    of {} (displacement of degree {}{})\n", counted(input.parts.size(), "part"), input.mesh.degree,
             axisymmetric);
  for (const PartSection& part : input.parts)
    fmt::print("  part \"{}\": {}{}{}\n", part.name, part.file, refinement_text(part.refinements),
               placement_text(part));
}

/// Returns the files that are not meshed yet and must not be meshed without a request.
std::string unmeshed_files(const Case& input) {
  std::vector<std::string> paths;
  for (const CaseMeshFile& file : mesh_files(input)) {
    if (must_be_meshed_first(file.file)) paths.push_back(file.file.path);
  }
  return join_names(paths, " and ", false);
}

void describe_case(const std::string& path, const std::vector<std::string>& overrides) {
  const Case input = read_case(path, overrides);
  fmt::print("{}: {}\n", path, input.title.empty() ? "a case" : input.title);
  print_files(input);
  for (const MaterialSection& m : input.materials) {
    const std::unique_ptr<MaterialLaw> law = make_material_law(m.law, m.parameters);
    std::string more;
    if (!law->is_linear()) {
      more = "; law " + m.law;
      for (const auto& [name, value] : m.parameters.values()) more += fmt::format(", {} {}", name, as_text(value));
    }
    for (std::size_t k = 0; k < m.relaxation.time.size(); ++k)
      more += fmt::format("{} {:g} of mu in {:g}", k == 0 ? "; relaxes by" : ",", m.relaxation.modulus[k],
                          m.relaxation.time[k]);
    fmt::print("  material \"{}\": density {:g}, lambda {:g}, mu {:g}{}\n", m.group, m.density, law->lambda(),
               law->mu(), more);
  }
  print_contacts(describe_contacts(input));
  fmt::print("  scheme {}, mass {}, {} to {:g}\n", input.time.scheme, input.mass.type, steps_text(input.time),
             input.time.end);
  require_mesh_files(input);
  if (const std::string unmeshed = unmeshed_files(input); !unmeshed.empty()) {
    fmt::print(
        "  groups, sizes and a suggested step are known only after {} has been meshed: use `ricochet validate {} "
        "--mesh`\n",
        unmeshed, path);
    return;
  }
  const std::unique_ptr<Model> model = build_model(input);
  print_advice(input, *model);
  fmt::print("  a run writes {}\n", output_text(estimate_output(input, *model)));
}

/// Indents the lines of a message after its first.
std::string indented(std::string text) {
  for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 1))
    text.insert(at + 1, "  ");
  return text;
}

/// Returns the checkpoints of a run; with several processes, those of the first.
std::vector<CheckpointFile> checkpoints_of(const std::string& directory) {
  std::vector<CheckpointFile> files = checkpoint_files(directory);
  return files.empty() ? checkpoint_files(checkpoint_folder_of_first_rank(directory)) : files;
}

/// Returns the summary; none if the directory has checkpoints but no readable summary.
std::optional<RunSummary> summary_of(const std::string& directory) {
  if (!checkpoints_of(directory).empty()) return find_intact_summary(directory);
  return read_summary_of_run(directory);
}

void describe_result(const std::string& directory) {
  const std::optional<RunSummary> found = summary_of(directory);
  if (!found) {
    const std::string newest = checkpoints_of(directory).back().path;
    // Throws if it is of another version, which cannot be continued.
    static_cast<void>(newest_checkpoint(fs::path(newest).parent_path().string()));
    fmt::print(
        "{}: an interrupted run whose summary.json is missing or damaged; `ricochet run` with --resume continues it if "
        "its other files are intact\n",
        directory);
    return describe_checkpoint(newest);
  }
  const RunSummary& s = *found;
  fmt::print("{}: {}{}\n", directory, s.title.empty() ? s.case_file : s.title, status_text(directory, s));
  if (!s.message.empty()) fmt::print("  {}\n", indented(s.message));
  print_progress(directory, s);
  fmt::print("  scheme {}, mass {}, dimension {}, degree {}\n", s.scheme, s.mass_text(), s.dimension, s.degree);
  fmt::print("  {}, {}, {}, {}, {}\n", counted(s.nodes, "node"), counted(s.cells, "cell"),
             counted(s.contact_points, "contact point"), steps_text(s), counted(s.frames, "frame"));
  if (s.history_every > 1) fmt::print("  a row of the history every {} steps\n", s.history_every);
  print_contacts(s.contacts);
  if (std::isfinite(s.critical_step)) print_critical_step(s.step, s.critical_step);
  fmt::print("  {}\n", energies_text(s));
  fmt::print("  {}\n", energy_account_text(s));
  print_method(s);
  for (const CheckResult& check : s.checks) {
    if (check.limit > 0.0 && check.largest > check.limit)
      fmt::print("  CHECK FAILED: {} reaches {:.2g}, above its limit {:g}\n", check.name, check.largest, check.limit);
  }
  print_friction(s);
  print_impacts(s, 0);
  print_peak_stress(s);
  fmt::print("{}\n", deformation_text(s));
  print_probes(s);
  print_solver(s);
  print_cost(s);
  print_expectations(s.expectations);
  for (const std::string& warning : s.warnings) fmt::print("  warning: {}\n", warning);
}

bool is_case(const std::string& path) { return !fs::is_directory(path) && fs::path(path).extension() == ".toml"; }

bool is_result(const std::string& path) { return fs::is_directory(path); }

}  // namespace

int info(const InfoArguments& arguments) {
  const std::vector<std::string>& paths = arguments.paths;
  for (const std::string& path : paths) {
    if (!arguments.overrides.empty() && !is_case(path))
      throw Error(ErrorKind::usage, fmt::format("info: --set changes a case file, and {} is not one", path));
  }
  const bool any_study = std::ranges::any_of(paths, holds_study) || std::ranges::any_of(paths, holds_benchmarks);
  if (paths.size() > 1 && !any_study && std::ranges::all_of(paths, is_result)) {
    print_comparison(paths);
    return 0;
  }
  for (const std::string& path : paths) {
    if (!fs::exists(path)) throw Error(ErrorKind::file_access, fmt::format("{}: no such file or directory", path));
    if (holds_study(path)) {
      describe_study(path);
    } else if (holds_benchmarks(path)) {
      describe_benchmarks(path);
    } else if (is_result(path)) {
      describe_result(path);
    } else if (is_case(path)) {
      describe_case(path, arguments.overrides);
    } else if (fs::path(path).extension() == ".ckpt") {
      describe_checkpoint(path);
    } else if (is_foreign_mesh(path)) {  // some of which are HDF5 files as well
      describe_mesh(path);
    } else if (is_hdf5_file(path) || fs::path(path).extension() == ".hdf5") {
      describe_contact_problem(path);
    } else {
      describe_mesh(path);
    }
  }
  return 0;
}

}  // namespace ricochet::program
