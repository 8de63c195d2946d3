#pragma once

/// @file Counting what is allocated. The program that this is linked into has its own malloc, which counts and hands
/// on.
namespace ricochet::test_support {

/// Calls of malloc and its relatives, operator new included, by all threads since the start.
[[nodiscard]] long allocation_count();

}  // namespace ricochet::test_support
