#pragma once

/// @file Counting what is allocated. The program that this is linked into has its own malloc, which counts and hands
/// on.
namespace ricochet::test_support {

/// Calls of malloc and its relatives, operator new included, by all threads since the start.
[[nodiscard]] long allocation_count();

/// The next allocation ends the program, so that a debugger shows where it comes from.
void stop_at_next_allocation(bool stop);

}  // namespace ricochet::test_support
