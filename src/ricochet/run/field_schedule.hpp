#pragma once

#include <string>

#include "ricochet/base/snapshot.hpp"
#include "ricochet/io/results_file.hpp"
#include "ricochet/model/model.hpp"

/// @file The steps after which fields are written, and the size of a run's output.
namespace ricochet {

/// Returns a text such as "12 MB" or "1.2 GB".
[[nodiscard]] std::string size_text(double bytes);
[[nodiscard]] ResultsOptions results_options(const OutputSection& output);

class FieldSchedule {
 public:
  /// If the case does not state an interval, the number of steps and the size of a frame determine it. A resumed run
  /// keeps its original interval, even if its end has been moved.
  FieldSchedule(const Case& input, const Model& model, long steps, const Snapshot* snapshot = nullptr);
  void persist(const SnapshotVisitor& visit);
  [[nodiscard]] bool any() const { return every_ > 0 || interval_ > 0.0; }
  /// Returns true if a frame follows a step. Must be called once for every step, in order.
  [[nodiscard]] bool includes(const State& state);
  /// Returns true if this step was the last one included.
  [[nodiscard]] bool is_last(const State& state) const { return last_ == state.step; }
  /// Returns the number of frames of a run of so many steps up to a time, including its start and its end.
  [[nodiscard]] long frames(long steps, double end) const;
  /// Returns true if the size of frames has reduced their number below that of a small body.
  [[nodiscard]] bool is_limited() const { return is_limited_; }

 private:
  [[nodiscard]] double intervals(double time) const;

  long every_ = 0;
  double interval_ = 0.0;  ///< interval of time, used instead of every_ if positive
  double intervals_before_ = 0.0;
  long last_ = -1;  ///< step that was included last
  bool is_limited_ = false;
};

/// Files of a run, in bytes, before it starts and without compression.
struct OutputEstimate {
  long frames = 0, rows = 0;
  double frame_bytes = 0.0, results_bytes = 0.0, history_bytes = 0.0;
  bool is_limited = false;     ///< fewer frames than a small body would have
  bool is_adaptive = false;    ///< rows are those of the longest steps
  bool is_compressed = false;  ///< the files will be smaller than stated
};
[[nodiscard]] OutputEstimate estimate_output(const Case& input, const Model& model);
/// Returns a text such as "101 frames of fields of 1.9 MB, 190 MB in all; history.csv of about 4.2 MB".
[[nodiscard]] std::string output_text(const OutputEstimate& estimate);

}  // namespace ricochet
