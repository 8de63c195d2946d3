#pragma once

#include "ricochet/io/summary.hpp"

/// @file What the program prints of contacts and friction.
namespace ricochet::program {

/// One line per [[contact]]: groups, law of friction, multipliers, motion of the obstacle.
void print_contacts(const std::vector<ContactDescription>& contacts);
/// "\"two.left\" carries the multipliers: its mesh is finer (0.02 against 0.03); 4 contact points, …".
[[nodiscard]] std::string facing_text(const FacingDescription& facing);

/// Works of friction and of moving obstacles, and how many points stuck and slipped at most; nothing where there was
/// neither friction nor motion.
void print_friction(const RunSummary& summary);

}  // namespace ricochet::program
