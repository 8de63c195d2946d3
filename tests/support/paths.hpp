#pragma once

#include <string>

/// @file Positions of test files. Compiled once: with these paths in every file of the tests, compiled code and
/// warnings would depend on the length of the checkout's path.
namespace ricochet::test_support {

/// Returns a file of the checkout, such as "cases/disc/disc.toml".
std::string source_path(const std::string& relative);

/// Returns a file of tests/data, such as "meshes/triangle_o1_msh41_ascii.msh".
std::string data_path(const std::string& relative);

/// Returns the directory of the meshes that tests make.
std::string meshes_directory();

}  // namespace ricochet::test_support
