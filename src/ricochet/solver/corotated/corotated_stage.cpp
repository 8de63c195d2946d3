#include "ricochet/solver/corotated/corotated_stage.hpp"

namespace ricochet {

namespace {

class CorotatedStage final : public StageSolver {
 public:
  CorotatedStage(std::unique_ptr<StageSolver> solver, const CorotatedFrame& frame)
      : solver_(std::move(solver)), frame_(frame) {}

  void solve(const LinearStage& stage, StageSolution& solution) override {
    update_rows(stage.rows);
    frame_.rotate_back(stage.right_hand_side.force, right_hand_side_.force);
    right_hand_side_.prescribed = stage.right_hand_side.prescribed;
    solver_->solve({*rows_, right_hand_side_, stage.conditions, stage.start}, solution);
    frame_.rotate(solution.increment);
    frame_.rotate(solution.contact_increment);
  }
  void show_contact() const override { solver_->show_contact(); }
  void refactorize(const Vector& displacement) override { solver_->refactorize(displacement); }
  void persist(const SnapshotVisitor& visit) override { solver_->persist(visit); }
  [[nodiscard]] IterationCounts iteration_counts() const override { return solver_->iteration_counts(); }
  [[nodiscard]] FactoredStage* factored() override { return solver_->factored(); }

 private:
  /// Renews the rows if the frame has rotated or the rows of the stage have another revision: all of them, with a new
  /// revision for those that changed.
  void update_rows(const ContactRows& rows) {
    const auto points = std::size_t(rows.size());
    const bool follows = !rows.revision.empty();
    const bool same_frame = rows_ != nullptr && frame_number_ == frame_.number();
    if (same_frame && (follows ? source_revision_ == rows.revision : source_ == &rows)) return;
    if (rows_ == nullptr) {
      rows_ = std::make_shared<ContactRows>();
      rows_->revision.assign(points, 0);
      source_revision_.assign(points, -1);
    }
    static_cast<ContactFrames&>(*rows_) = rows;
    ++revision_;
    for (std::size_t i = 0; i < points; ++i) {
      const long now = follows ? rows.revision[i] : 0;
      if (same_frame && now == source_revision_[i]) continue;
      source_revision_[i] = now;
      rows_->revision[i] = revision_;
    }
    frame_.rotate_back(rows.gap_operator, rows_->gap_operator);
    frame_.rotate_back(rows.tangential_trace, rows_->tangential_trace);
    frame_number_ = frame_.number();
    source_ = &rows;
  }

  std::unique_ptr<StageSolver> solver_;
  const CorotatedFrame& frame_;
  RightHandSide right_hand_side_;
  std::shared_ptr<ContactRows> rows_;
  const ContactRows* source_ = nullptr;
  std::vector<long> source_revision_;
  long frame_number_ = -1, revision_ = 0;
};

}  // namespace

std::unique_ptr<StageSolver> make_corotated_stage(std::unique_ptr<StageSolver> solver, const CorotatedFrame& frame) {
  return std::make_unique<CorotatedStage>(std::move(solver), frame);
}

}  // namespace ricochet
