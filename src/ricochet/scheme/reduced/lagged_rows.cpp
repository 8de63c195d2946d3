#include "ricochet/scheme/reduced/lagged_rows.hpp"

#include <algorithm>

#include "ricochet/contact/row_values.hpp"

namespace ricochet {

namespace {

const std::string memory_of_rows = "lagged_rows";

}  // namespace

void LaggedRows::start(const State& state) {
  exact_ = nullptr;
  is_stale_ = state.forces.rows->sliding_state.size() > 0;
  if (is_stale_) return;
  const auto remembered = state.memory.find(memory_of_rows);
  if (remembered == state.memory.end()) {
    lagged_ = nullptr;
    return;
  }
  if (lagged_ == nullptr) {
    lagged_ = std::make_shared<ContactRows>(*state.forces.rows);
    read_only_ = lagged_;
    // Revision numbers from another count.
    std::ranges::fill(lagged_->revision, ++revision_);
  }
  if (remembered->second.size() != row_value_count(*lagged_))
    Snapshot::refuse(memory_of_rows, "has a length that does not fit this problem");
  is_new_ = false;
  if (set_row_values(remembered->second, *lagged_)) std::ranges::fill(lagged_->revision, ++revision_);
}

void LaggedRows::replace_rows(const Vector& motion, Stage& stage) {
  exact_ = stage.rows;
  renew();
  stage.rows = read_only_;
  stage.motion.reset();
  exact_->normal_motion(motion, motion_);
  stage.conditions.gap.offset += stage.conditions.gap.factor * motion_;
  lagged_->normal_motion(motion, motion_);
  stage.conditions.gap.offset -= stage.conditions.gap.factor * motion_;
  if (stage.conditions.slip.offset.size() == 0) return;
  exact_->tangential_motion(motion, motion_);
  stage.conditions.slip.offset += stage.conditions.slip.factor * motion_;
  lagged_->tangential_motion(motion, motion_);
  stage.conditions.slip.offset -= stage.conditions.slip.factor * motion_;
}

/// Replaces Ĥ by H at points where they differ too much.
void LaggedRows::renew() {
  const ContactRows* const exact = exact_.get();
  if (lagged_ == nullptr || is_stale_) {
    if (lagged_ == nullptr) {
      lagged_ = std::make_shared<ContactRows>(*exact);
      read_only_ = lagged_;
    } else {
      *lagged_ = *exact;
    }
    is_stale_ = false;
    std::ranges::fill(lagged_->revision, ++revision_);
    is_new_ = true;
    return;
  }
  ++revision_;
  for (Index i = 0; i < exact->size(); ++i) {
    if (change_of_rows(*lagged_, *exact, i) <= slack) continue;
    copier_.copy(*exact, *lagged_, i);
    lagged_->revision[std::size_t(i)] = revision_;
    is_new_ = true;
  }
  copier_.finish(*lagged_);
}

void LaggedRows::add_difference(const Vector& normal, const Vector& tangential, Vector& force) {
  exact_->add_force(normal, tangential, force);
  motion_ = -normal;
  negative_ = -tangential;
  lagged_->add_force(motion_, negative_, force);
}

void LaggedRows::remember(State& state) const {
  if (!is_new_ || lagged_->sliding_state.size() > 0) return;
  state.memory[memory_of_rows] = row_values(*lagged_);
}

}  // namespace ricochet
