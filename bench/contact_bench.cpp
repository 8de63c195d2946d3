#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "ricochet/base/timer.hpp"
#include "ricochet/fclib/fclib_file.hpp"
#include "ricochet/solver/contact/contact_solver.hpp"

// Times a contact solver on problems in FCLib's format; prints one line of JSON per problem. Cold: analysis and
// solution from r = 0. With --sequence the files are consecutive steps with the same W: analysed once, each solved from
// the last reactions.

namespace {

using namespace ricochet;

struct Arguments {
  std::vector<std::string> files;
  std::string solver = "automatic";
  std::string reactions;  ///< folder for r of each problem, as text
  double tolerance = 1e-8;
  int repeat = 1;
  bool sequence = false;
  bool record = false;
};

Arguments parse(int count, char** values) {
  Arguments result;
  for (int i = 1; i < count; ++i) {
    const std::string argument = values[i];
    const auto value = [&]() -> std::string {
      if (i + 1 >= count) std::exit((std::fprintf(stderr, "%s requires a value\n", argument.c_str()), 1));
      return values[++i];
    };
    if (argument == "--solver") {
      result.solver = value();
    } else if (argument == "--tolerance") {
      result.tolerance = std::atof(value().c_str());
    } else if (argument == "--repeat") {
      result.repeat = std::max(1, std::atoi(value().c_str()));
    } else if (argument == "--reactions") {
      result.reactions = value();
    } else if (argument == "--sequence") {
      result.sequence = true;
    } else if (argument == "--record") {
      result.record = true;
    } else if (argument != "--json") {
      result.files.push_back(argument);
    }
  }
  return result;
}

const char* outcome_name(ContactOutcome outcome) {
  switch (outcome) {
    case ContactOutcome::solved:
      return "solved";
    case ContactOutcome::not_converged:
      return "not_converged";
    case ContactOutcome::not_applicable:
      return "not_applicable";
    case ContactOutcome::invalid_data:
      break;
  }
  return "invalid_data";
}

void print(const Arguments& arguments, const std::string& file, const ContactSolution& solution, double seconds) {
  long counts[4] = {};
  for (const ContactStatus status : solution.status) ++counts[int(status)];
  std::printf(
      "{\"problem\": \"%s\", \"solver\": \"%s\", \"tolerance\": %g, \"seconds\": %.9g, \"outcome\": \"%s\", "
      "\"residual\": %.6g, \"rounding_floor\": %.6g, \"iterations\": %d, \"newton_steps\": %d, \"factorizations\": %d, "
      "\"open\": %ld, \"closed\": %ld, \"stick\": %ld, \"slip\": %ld}\n",
      file.c_str(), arguments.solver.c_str(), arguments.tolerance, seconds, outcome_name(solution.outcome),
      solution.residual, solution.rounding_floor, solution.iterations, solution.newton_steps, solution.factorizations,
      counts[0], counts[1], counts[2], counts[3]);
  for (const IterationRecord& line : solution.record) std::printf("# %-10s %.3e\n", line.phase, line.residual);
  if (arguments.reactions.empty()) return;
  const std::string name = file.substr(file.find_last_of('/') + 1);
  if (std::FILE* out = std::fopen((arguments.reactions + "/" + name + ".txt").c_str(), "w")) {
    for (const double value : solution.reaction) std::fprintf(out, "%.17g\n", value);
    std::fclose(out);
  }
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2), values.end());
  return values[values.size() / 2];
}

void run_cold(const Arguments& arguments, const ContactOptions& options) {
  for (const std::string& file : arguments.files) {
    const ContactProblem problem = reduce(read_fclib(file)).problem;
    ContactSolution solution;
    std::vector<double> seconds;
    for (int k = 0; k < arguments.repeat; ++k) {
      const auto solver = make_contact_solver(arguments.solver);
      const ProcessorTimer timer;
      solver->analyse(problem);
      solver->solve(problem, options, solution);
      seconds.push_back(timer.seconds());
      if (seconds.back() > 5.0) break;
    }
    print(arguments, file, solution, median(seconds));
    std::fflush(stdout);
  }
}

void run_sequence(const Arguments& arguments, const ContactOptions& options) {
  std::vector<ContactProblem> problems;
  for (const std::string& file : arguments.files) problems.push_back(reduce(read_fclib(file)).problem);
  std::vector<std::vector<double>> seconds(problems.size());
  std::vector<ContactSolution> solutions(problems.size());
  for (int k = 0; k < arguments.repeat; ++k) {
    const auto solver = make_contact_solver(arguments.solver);
    std::shared_ptr<const ContactOperator> analysed;
    for (std::size_t i = 0; i < problems.size(); ++i) {
      const bool same = analysed != nullptr && analysed->rows() == problems[i].rows() &&
                        *analysed->dense() == *problems[i].contact_operator->dense();
      ContactProblem problem = problems[i];
      if (same) problem.contact_operator = analysed;
      const ProcessorTimer timer;
      if (!same) solver->analyse(problem);
      solver->solve(problem, options, solutions[i]);
      seconds[i].push_back(timer.seconds());
      analysed = problem.contact_operator;
    }
  }
  for (std::size_t i = 0; i < problems.size(); ++i)
    print(arguments, arguments.files[i], solutions[i], median(seconds[i]));
}

}  // namespace

int main(int count, char** values) {
  const Arguments arguments = parse(count, values);
  ContactOptions options;
  options.tolerance = arguments.tolerance;
  options.record = arguments.record;
  try {
    arguments.sequence ? run_sequence(arguments, options) : run_cold(arguments, options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "ricochet_contact_bench: %s\n", error.what());
    return 1;
  }
  return 0;
}
