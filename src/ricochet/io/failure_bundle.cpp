#include "ricochet/io/failure_bundle.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "ricochet/base/error.hpp"
#include "ricochet/fclib/fclib_file.hpp"
#include "ricochet/io/checkpoint.hpp"
#include "ricochet/io/durable_file.hpp"

namespace ricochet {

namespace fs = std::filesystem;

FailureBundle::FailureBundle(std::string directory, ContactProvenance provenance)
    : directory_(std::move(directory)), provenance_(std::move(provenance)) {}

void FailureBundle::write_problem(const ContactProblem& problem, const ContactSolution& solution, long step) {
  const std::string path = (fs::path(directory_) / fmt::format("failure-{:09}.hdf5", step)).string();
  try {
    write_contact_problem(
        path, problem, solution, provenance_, step,
        fmt::format("This problem was not solved: {}. The reactions are the best that were found.", solution.reason));
    problem_file_ = path;
  } catch (const Error& trouble) {
    problem_trouble_ = trouble.what();
  }
}

void FailureBundle::remove_problem() {
  problem_trouble_.clear();
  if (problem_file_.empty()) return;
  std::error_code ignored;  // leftover_files finds it
  fs::remove(problem_file_, ignored);
  problem_file_.clear();
}

std::string FailureBundle::write(long step, Snapshot& snapshot, const std::string& message) const {
  snapshot.save("failure.message", message);
  snapshot.save("failure.step", std::int64_t{step});
  const std::string path = (fs::path(directory_) / fmt::format("failure-{:09}.ckpt", step)).string();
  write_durably(path, encode_snapshot(snapshot));
  std::string text = fmt::format("the last state is in {} (`ricochet info` reads it)", path);
  if (!problem_file_.empty())
    text += fmt::format(", the contact problem in {} (`ricochet contact` solves it)", problem_file_);
  if (!problem_trouble_.empty())
    text += fmt::format("; the contact problem could not be written: {}", problem_trouble_);
  return text;
}

std::vector<std::string> failure_files(const std::string& directory) {
  std::vector<std::string> result;
  std::error_code problem;
  for (const fs::directory_entry& entry : fs::directory_iterator(directory, problem)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("failure-") && (name.ends_with(".ckpt") || name.ends_with(".hdf5")))
      result.push_back(entry.path().string());
  }
  std::ranges::sort(result);
  return result;
}

}  // namespace ricochet
