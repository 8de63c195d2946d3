#pragma once

#include <string>
#include <vector>

#include "ricochet/solver/contact/contact_solver.hpp"

/// @file Export of the contact problems of chosen steps of a run to FCLib files (fclib_file.hpp).
namespace ricochet {

struct StepRange {
  long first = 0, last = 0;  ///< both inclusive
};

/// Parses steps such as "10,20,50:60", numbered as in history.csv, in any order. Throws Error(usage), which names the
/// invalid part of the text.
[[nodiscard]] std::vector<StepRange> parse_steps(const std::string& text);

/// Files in a directory with the names of contact problems, step-000010.hdf5 and step-000010-stage-2.hdf5.
[[nodiscard]] std::vector<std::string> exported_contact_problems(const std::string& directory);

/// Origin of a contact problem, as stated in its file.
struct ContactProvenance {
  std::string title;   ///< of the case
  std::string origin;  ///< program, case file, scheme, …: lines of the description
  Index dimension = 3;
  double step_size = 0.0;  ///< a step ends at its number times this size
};

/// Writes a contact problem of a step and its approximate solution, reactions and W in the units of the case (r and W
/// of `problem` without their scale). `remark`: an additional line of the description. Throws Error(file_access), and
/// Error(invalid_input) for problems that FCLib's format cannot represent.
void write_contact_problem(const std::string& path, const ContactProblem& problem, const ContactSolution& solution,
                           const ContactProvenance& provenance, long step, const std::string& remark = "",
                           int stage = 1);

class ContactExport {
 public:
  /// Creates the directory. Throws Error(file_access).
  ContactExport(std::vector<StepRange> steps, std::string directory, ContactProvenance provenance);

  /// Sets the step to which the following problems belong.
  void begin_step(long step);
  /// Writes the problem and its solution if the step is one of the requested ones, see above.
  void write(const ContactProblem& problem, const ContactSolution& solution);
  /// One line on the files that were written, and on the requested steps that had no problem or were not reached.
  [[nodiscard]] std::string report() const;

 private:
  [[nodiscard]] bool is_requested(long step) const;

  std::vector<StepRange> steps_;
  std::string directory_;
  ContactProvenance provenance_;
  long step_ = 0;
  bool is_requested_ = false;
  int written_in_step_ = 0;
  long files_ = 0, steps_requested_ = 0, steps_written_ = 0;
};

}  // namespace ricochet
