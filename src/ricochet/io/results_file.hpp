#pragma once

#include <memory>
#include <string>

#include "ricochet/fem/displacement_space.hpp"
#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/scheme/state.hpp"

/// @file Fields over time: results.h5 and its XDMF 3.0 side-file results.xdmf, one dataset per frame and field.
///
/// results.h5:  /mesh/nodes (nodes × 3), /mesh/cells_K (one per cell shape, nodes in VTK's order),
///   /frames/NNNNNN/{displacement, velocity (nodes × 3), contact_pressure, gap, contact_status (nodes)} and,
///   with friction, friction_traction (nodes × 3): the traction on the body, in stress units like the pressure.
/// Off the contact boundary contact_pressure is 0, gap is NaN and contact_status −1; on it 0 is open, 1 is closed
/// without friction, 2 sticks and 3 slips. Where two obstacles meet at a node, the larger pressure, the smaller gap and
/// the larger status are given.
namespace ricochet {

class ResultsWriter {
 public:
  /// Opens DIRECTORY/results.h5 and results.xdmf. Throws Error(file_access).
  ResultsWriter(const std::string& directory, const DisplacementSpace& space, const SemidiscreteProblem& problem);
  /// Goes on after the frames that were there when save() was called; the files will have the bytes of a run that was
  /// never interrupted. Throws Error(file_access) where they are not those files.
  ResultsWriter(const std::string& directory, const DisplacementSpace& space, const SemidiscreteProblem& problem,
                const Snapshot& snapshot, const std::string& name);
  ~ResultsWriter();
  ResultsWriter(const ResultsWriter&) = delete;
  ResultsWriter& operator=(const ResultsWriter&) = delete;

  /// Both files are complete afterwards.
  void write(const State& state);
  [[nodiscard]] long frames() const;
  void save(Snapshot& snapshot, const std::string& name) const;
  /// Waits until both files are on the disk.
  void sync() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace ricochet
