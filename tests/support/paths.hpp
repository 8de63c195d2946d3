#pragma once

#include <string>

/// @file Where tests find files. Compiled once: with these paths in every file of the tests, what the compiler makes of
/// them, and its warnings, would depend on how long the checkout's path is.
namespace ricochet::test_support {

/// A file of the checkout, such as "cases/disc/disc.toml".
std::string source_path(const std::string& relative);

/// A file of tests/data, such as "meshes/triangle_o1_msh41_ascii.msh".
std::string data_path(const std::string& relative);

/// Where meshes that tests make are kept.
std::string meshes_directory();

}  // namespace ricochet::test_support
