#pragma once

#include <string>
#include <vector>

#include "ricochet/base/snapshot.hpp"
#include "ricochet/io/contact_export.hpp"

/// @file Files for the analysis of a failed step: failure-SSSSSSSSS.ckpt, the last state with the message (a file like
/// a checkpoint), and failure-SSSSSSSSS.hdf5, the unsolved contact problem (an FCLib file), if that is the cause.
namespace ricochet {

class FailureBundle {
 public:
  FailureBundle(std::string directory, ContactProvenance provenance);

  /// Writes the unsolved contact problem of a step with its best approximate solution. If FCLib's format cannot
  /// represent it or the disk is full, write() reports that.
  void write_problem(const ContactProblem& problem, const ContactSolution& solution, long step);
  /// Removes the file of write_problem, after a step that was solved in the end, by another method or with another
  /// length.
  void remove_problem();
  /// Adds the message to the snapshot and writes it. Returns a sentence that names the files. Throws
  /// Error(file_access).
  [[nodiscard]] std::string write(long step, Snapshot& snapshot, const std::string& message) const;

 private:
  std::string directory_;
  ContactProvenance provenance_;
  std::string problem_file_, problem_trouble_;
};

/// Files of failures in a directory.
[[nodiscard]] std::vector<std::string> failure_files(const std::string& directory);

}  // namespace ricochet
