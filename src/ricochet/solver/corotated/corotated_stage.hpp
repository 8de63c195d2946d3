#pragma once

#include "ricochet/solver/corotated/corotated_frame.hpp"
#include "ricochet/solver/stage/stage_solver.hpp"

/// @file Stages of one operator in the corotated frame.
namespace ricochet {

/// Solves A₀ (Rᵀδ) = Rᵀb + (H R)ᵀρ in place of A δ = b + Hᵀρ; everything else of the stage is equal in both frames: R
/// leaves the components held by supports unchanged (problem/body_rotations.hpp). The stages of a step share the frame.
[[nodiscard]] std::unique_ptr<StageSolver> make_corotated_stage(std::unique_ptr<StageSolver> solver,
                                                                const CorotatedFrame& frame);

}  // namespace ricochet
