#pragma once

#include "ricochet/solver/corotated/turned_frame.hpp"
#include "ricochet/solver/stage/stage_solver.hpp"

/// @file The stages of one operator in a frame that turns with the bodies.
namespace ricochet {

/// Solves A₀ (Rᵀδ) = Rᵀb + (H R)ᵀρ in place of A δ = b + Hᵀρ; all else of the stage is the same in both frames: R
/// leaves the components that supports hold as they are (problem/body_rotations.hpp). The frame is shared by the stages
/// of a step.
[[nodiscard]] std::unique_ptr<StageSolver> make_turned_stage(std::unique_ptr<StageSolver> solver,
                                                             const TurnedFrame& frame);

}  // namespace ricochet
