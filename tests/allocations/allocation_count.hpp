#pragma once

/// @file Counts allocations. A program linked with this has its own malloc, which counts the calls and forwards them.
namespace ricochet::test_support {

/// Number of calls of malloc and its relatives, operator new included, by all threads so far.
[[nodiscard]] long allocation_count();

}  // namespace ricochet::test_support
