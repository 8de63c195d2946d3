#pragma once

#include "ricochet/io/summary.hpp"

/// @file Output about contacts and friction.
namespace ricochet::program {

/// Prints one line per [[contact]]: groups, law of friction, multipliers, motion of the obstacle.
void print_contacts(const std::vector<ContactDescription>& contacts);
/// Returns a text such as "\"two.left\" carries the multipliers: its mesh is finer (0.02 against 0.03); 4 contact
/// points, …".
[[nodiscard]] std::string facing_text(const PairingDescription& facing);

/// Prints the works of friction and of moving obstacles, and the largest numbers of sticking and slipping points;
/// nothing if there was neither friction nor motion.
void print_friction(const RunSummary& summary);

}  // namespace ricochet::program
