#pragma once

#include "ricochet/io/summary.hpp"

/// @file What the program prints of contacts and friction.
namespace ricochet::program {

/// One line per [[contact]]: groups, law of friction, multipliers, motion of the obstacle.
void print_contacts(const std::vector<ContactDescription>& contacts);

/// Works of friction and of moving obstacles, and how many points stuck and slipped at most; nothing where there was
/// neither friction nor motion.
void print_friction(const RunSummary& summary);

}  // namespace ricochet::program
