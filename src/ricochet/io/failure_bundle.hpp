#pragma once

#include <string>
#include <vector>

#include "ricochet/base/snapshot.hpp"
#include "ricochet/io/contact_export.hpp"

/// @file What is left of a step that failed, so that it can be looked at: failure-SSSSSSSSS.ckpt, the last state with
/// the message (a file like a checkpoint), and failure-SSSSSSSSS.hdf5, the contact problem that was not solved (an
/// FCLib file), if it was that.
namespace ricochet {

class FailureBundle {
 public:
  FailureBundle(std::string directory, ContactProvenance provenance);

  /// Writes the contact problem of a step that was not solved, with the best that was found. FCLib's format may not be
  /// able to state it, and the disk may be full: that is told by write().
  void take_problem(const ContactProblem& problem, const ContactSolution& solution, long step);
  /// Removes what take_problem wrote, after a step that was solved in the end, in another way or with another length.
  void forget_problem();
  /// Adds the message to the snapshot and writes it. Returns where everything is, in a sentence. Throws
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
