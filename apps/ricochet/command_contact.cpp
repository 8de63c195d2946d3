#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "commands.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/base/timer.hpp"
#include "ricochet/fclib/fclib_file.hpp"

namespace ricochet::program {

namespace {

void list_solvers() {
  for (const auto& solver : contact_solver_registry().all()) fmt::print("{:<27} {}\n", solver.name, solver.type.text);
}

void print_row(const char* name, const std::string& value) { fmt::print("  {:<12} {}\n", name, value); }

std::string friction_text(const Vector& mu) {
  if (mu.size() == 0 || mu.maxCoeff() == 0.0) return "none";
  if (mu.minCoeff() == mu.maxCoeff()) return fmt::format("{:g}", mu.maxCoeff());
  return fmt::format("{:g} to {:g}", mu.minCoeff(), mu.maxCoeff());
}

std::string points_text(const FclibProblem& file) {
  std::string result = fmt::format("{} in {} dimensions", file.point_count(), file.dimension);
  if (file.constraint_count() > 0)
    result += fmt::format(", {}", counted(file.constraint_count(), "equality constraint"));
  return result;
}

std::string matrix_text(const SparseMatrix& w) {
  const double all = double(w.rows()) * double(w.cols());
  return fmt::format("{0} x {0}, {1} entries ({2:.3g} %)", w.rows(), w.nonZeros(),
                     all > 0.0 ? 100.0 * double(w.nonZeros()) / all : 0.0);
}

std::string outcome_text(const ContactSolution& solution) {
  switch (solution.outcome) {
    case ContactOutcome::solved:
      return "solved";
    case ContactOutcome::not_converged:
      return "NOT SOLVED: " + solution.reason;
    case ContactOutcome::not_applicable:
      return "NOT SOLVED, the solver does not support such problems: " + solution.reason;
    case ContactOutcome::invalid_data:
      return "NOT SOLVED, the data do not describe a contact problem: " + solution.reason;
  }
  return "";
}

std::string contact_states_text(const std::vector<ContactStatus>& status) {
  const auto count = [&](ContactStatus which) { return std::ranges::count(status, which); };
  return fmt::format("{} open, {} stick, {} slip, {} closed without friction", count(ContactStatus::open),
                     count(ContactStatus::stick), count(ContactStatus::slip), count(ContactStatus::closed));
}

void print_record(const ContactSolution& solution) {
  fmt::print("  {:>9}  {:<14} {:<9}  {:>6} {:>6} {:>6} {:>7}\n", "iteration", "phase", "residual", "closed", "stick",
             "slip", "changed");
  for (std::size_t k = 0; k < solution.record.size(); ++k) {
    const IterationRecord& line = solution.record[k];
    fmt::print("  {:>9}  {:<14} {:.3e}  {:>6} {:>6} {:>6} {:>7}\n", k + 1, line.phase, line.residual, line.closed,
               line.sticking, line.slipping, line.changed);
  }
}

void print_problem(const FclibProblem& file) {
  fmt::print("{}: {}\n", file.path, file.title.empty() ? "a contact problem" : file.title);
  print_row("points", points_text(file));
  print_row("friction", friction_text(file.mu));
  print_row("W", matrix_text(file.w));
}

void print_solution(const ContactArguments& arguments, const ContactSolution& solution, double seconds) {
  print_row("solver", arguments.solver);
  print_row("outcome", outcome_text(solution));
  print_row("residual",
            fmt::format("{:.3e}, of which {:.3e} may be rounding", solution.residual, solution.rounding_floor));
  print_row("iterations", fmt::format("{}, {} of them with a linear system, {} factorizations", solution.iterations,
                                      solution.newton_steps, solution.factorizations));
  print_row("time", fmt::format("{:.4g} ms", 1e3 * seconds));
  if (!solution.status.empty()) print_row("status", contact_states_text(solution.status));
  if (arguments.record) print_record(solution);
}

}  // namespace

void describe_contact_problem(const std::string& path) {
  const FclibProblem file = read_fclib(path);
  print_problem(file);
  std::string found = file.solution ? "a solution" : "no solution";
  if (!file.guesses.empty()) found += fmt::format(", {}", counted(file.guesses.size(), "guess", "guesses"));
  print_row("holds", found);
  for (const std::string* text : {&file.description, &file.math_info}) {
    for (std::size_t begin = 0; begin < text->size();) {
      const std::size_t end = std::min(text->find('\n', begin), text->size());
      fmt::print("  {}\n", text->substr(begin, end - begin));
      begin = end + 1;
    }
  }
}

namespace {

/// Checks the output before anything is solved.
void check_output(const std::string& output) {
  namespace fs = std::filesystem;
  if (output.empty()) return;
  if (fs::is_directory(output))
    throw Error(ErrorKind::file_access, fmt::format("{}: cannot be written: it is a directory", output));
  const fs::path parent = fs::path(output).parent_path();
  if (!parent.empty() && !fs::is_directory(parent))
    throw Error(ErrorKind::file_access,
                fmt::format("{}: cannot be written: there is no directory {}", output, parent.string()));
}

}  // namespace

int contact(const ContactArguments& arguments) {
  if (arguments.list) {
    list_solvers();
    return 0;
  }
  if (arguments.problem.empty())
    throw Error(ErrorKind::usage, "contact: the file of a problem is required (or --list)");
  if (!(arguments.tolerance >= 0.0 && arguments.tolerance < 1.0)) {
    throw Error(ErrorKind::usage, fmt::format("--tolerance {:g}: a relative residual of at least 0 (down to rounding) "
                                              "and below 1 is expected",
                                              arguments.tolerance));
  }
  const std::vector<std::string> known = contact_solver_registry().names();
  if (std::ranges::find(known, arguments.solver) == known.end()) {
    throw Error(ErrorKind::usage, fmt::format("--solver {}: there is no such solver; available: {}", arguments.solver,
                                              join_names(known, ", ", false)));
  }
  check_output(arguments.output);
  const auto solver = make_contact_solver(arguments.solver);
  FclibProblem file = read_fclib(arguments.problem);
  print_problem(file);
  const FclibReduction reduction = reduce(file);
  ContactSolution solution;
  Timer timer;
  solver->analyse(reduction.problem);
  solver->solve(reduction.problem, {.tolerance = arguments.tolerance, .record = arguments.record}, solution);
  print_solution(arguments, solution, timer.seconds());
  if (!arguments.output.empty()) {
    // A solver that does not support the problem may return no reactions at all.
    if (solution.reaction.size() != reduction.problem.rows() || !solution.reaction.allFinite() ||
        !solution.motion.allFinite()) {
      solution.reaction.setZero(reduction.problem.rows());
      solution.motion = reduction.problem.offset;
    }
    put_solution(file, reduction.solution(solution), solution);
    write_fclib(arguments.output, file);
    print_row("written to", arguments.output);
  }
  if (solution.solved()) return 0;
  throw Error(
      ErrorKind::not_converged,
      fmt::format("{}: the contact problem is not solved: {} (residual {:.3g}); try another solver (--list){}",
                  arguments.problem, solution.reason, solution.residual,
                  arguments.output.empty() ? "" : "; the best solution found is in the output file, as a guess"));
}

}  // namespace ricochet::program
