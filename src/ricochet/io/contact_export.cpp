#include "ricochet/io/contact_export.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <utility>

#include "ricochet/base/error.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/fclib/fclib_file.hpp"

namespace ricochet {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& text, const std::string& part, const std::string& why) {
  throw Error(
      ErrorKind::usage,
      fmt::format("--export-contact {}: \"{}\" {}; write steps as in 10,20,50:60, counted from 1", text, part, why));
}

long parse_step(const std::string& text, const std::string& part, const std::string& number) {
  long value = 0;
  if (part.empty()) refuse(text, part, "is empty");
  const auto [end, problem] = std::from_chars(number.data(), number.data() + number.size(), value);
  if (problem == std::errc::result_out_of_range) refuse(text, part, "is too large for a step number");
  if (problem != std::errc() || end != number.data() + number.size())
    refuse(text, part, "is neither a step nor a range of steps");
  if (value == 0) refuse(text, part, "names step 0, the initial state, which has no contact problem");
  if (value < 0) refuse(text, part, "names a negative step");
  return value;
}

/// Converts r and W to the units of the case. The scales are powers of two, so no bits are lost.
void remove_scale(FclibProblem& problem, double scale) {
  problem.w *= scale;
  if (problem.solution) problem.solution->reaction /= scale;
  for (FclibSolution& guess : problem.guesses) guess.reaction /= scale;
}

std::string describe_problem(const ContactProblem& problem, const ContactProvenance& provenance, long step,
                             double time) {
  Index eligible = 0;
  for (Index i = 0; i < problem.points(); ++i) eligible += problem.is_eligible(i) ? 1 : 0;
  return fmt::format(
      "Contact problem of step {} (t = {:.9g}).\n{}\nu: gap and slip as lengths, (y/s, w/sigma) with y = q + s G delta "
      "and w = p + sigma B_T delta of the scheme's stage, delta the displacement increment. r = (r_N, -r_T): contact "
      "forces on the body, r_N >= 0 in compression, r_T opposed to the slip. W = H A^-1 H^T with H = [G; B_T], A the "
      "scheme's operator. Units are those of the case.\nPoints: the {} contact points that may touch in this step; "
      "/fclib_local/info/points has their indices among all contact points, counted from 0. The others stay open.",
      step, time, provenance.origin, eligible);
}

}  // namespace

std::vector<StepRange> parse_steps(const std::string& text) {
  std::vector<StepRange> result;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string part = text.substr(begin, end - begin);
    const std::size_t colon = part.find(':');
    StepRange range;
    range.first = parse_step(text, part, part.substr(0, colon));
    range.last = colon == std::string::npos ? range.first : parse_step(text, part, part.substr(colon + 1));
    if (range.last < range.first) refuse(text, part, "ends before it begins");
    result.push_back(range);
    begin = end + 1;
  }
  return result;
}

std::vector<std::string> exported_contact_problems(const std::string& directory) {
  // step-000012.hdf5, step-000012-stage-2.hdf5
  const auto is_problem = [](const std::string& name) {
    const auto middle = between(name, "step-", ".hdf5");
    if (!middle) return false;
    constexpr std::string_view stage = "-stage-";
    const std::size_t at = middle->find(stage);
    const bool is_one_of_several = at != std::string_view::npos;
    return is_digits(middle->substr(0, at), 6) &&
           (!is_one_of_several || is_digits(middle->substr(at + stage.size()), 1));
  };
  std::vector<std::string> result;
  std::error_code problem;
  for (const fs::directory_entry& entry : fs::directory_iterator(directory, problem)) {
    if (is_problem(entry.path().filename().string())) result.push_back(entry.path().string());
  }
  std::ranges::sort(result);
  return result;
}

void write_contact_problem(const std::string& path, const ContactProblem& problem, const ContactSolution& solution,
                           const ContactProvenance& provenance, long step, const std::string& remark, int stage) {
  const double time = double(step) * provenance.step_size;
  FclibProblem file = make_fclib(problem, provenance.dimension, &solution);
  remove_scale(file, problem.reaction_scale);
  file.title = fmt::format("{}: step {}{}, t = {:.9g}", provenance.title, step,
                           stage > 1 ? fmt::format(", stage {}", stage) : "", time);
  file.description = describe_problem(problem, provenance, step, time) + (remark.empty() ? "" : "\n" + remark) +
                     (file.description.empty() ? "" : "\n" + file.description);
  file.math_info = "W is symmetric and positive semi-definite.\n" + file.math_info;
  write_fclib(path, file);
}

ContactExport::ContactExport(std::vector<StepRange> steps, std::string directory, ContactProvenance provenance)
    : steps_(std::move(steps)), directory_(std::move(directory)), provenance_(std::move(provenance)) {
  std::error_code problem;
  fs::create_directories(directory_, problem);
  if (problem || !fs::is_directory(directory_)) {
    throw Error(ErrorKind::file_access, fmt::format("{}: cannot create this directory: {}", directory_,
                                                    problem ? problem.message() : "a file of that name exists"));
  }
}

bool ContactExport::is_requested(long step) const {
  return std::ranges::any_of(steps_, [&](const StepRange& range) { return range.first <= step && step <= range.last; });
}

void ContactExport::begin_step(long step) {
  step_ = step;
  is_requested_ = is_requested(step);
  written_in_step_ = 0;
  if (is_requested_) ++steps_requested_;
}

void ContactExport::write(const ContactProblem& problem, const ContactSolution& solution) {
  if (!is_requested_) return;
  const int stage = written_in_step_ + 1;
  const std::string suffix = stage > 1 ? fmt::format("-stage-{}", stage) : "";
  write_contact_problem((fs::path(directory_) / fmt::format("step-{:06d}{}.hdf5", step_, suffix)).string(), problem,
                        solution, provenance_, step_, "", stage);
  if (written_in_step_++ == 0) ++steps_written_;
  ++files_;
}

std::string ContactExport::report() const {
  long last = 0;
  for (const StepRange& range : steps_) last = std::max(last, range.last);
  std::string result = fmt::format("contact problems of {} in {}", counted(steps_written_, "step"), directory_);
  if (files_ > steps_written_) result += fmt::format(" ({})", counted(files_, "file"));
  if (steps_requested_ > steps_written_)
    result += fmt::format("; {} had none (no point could touch)", steps_requested_ - steps_written_);
  if (last > step_) result += fmt::format("; steps after {} were not reached", step_);
  return result;
}

}  // namespace ricochet
