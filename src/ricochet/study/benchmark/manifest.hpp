#pragma once

#include <string>
#include <vector>

/// @file benchmarks.toml: the list of benchmarks, each a case file whose [[expect]] entries are reference values.
namespace ricochet {

struct Benchmark {
  std::string name;
  std::string case_path;    ///< absolute
  std::string group;        ///< part of the tables to which it belongs; may be empty
  std::string description;  ///< one line
};

/// Reads the manifest, which names case files relative to itself. Throws Error(file_access) if it cannot be read, and
/// Error(invalid_input) with all of its errors: keys that are missing, unknown or not texts, names that occur twice,
/// case files that do not exist.
[[nodiscard]] std::vector<Benchmark> read_benchmarks(const std::string& path);

/// Returns the benchmarks with these names, each once and in the order of the manifest; all if no names are given.
/// Throws Error(usage) that lists the available names.
[[nodiscard]] std::vector<Benchmark> choose_benchmarks(const std::vector<Benchmark>& all,
                                                       const std::vector<std::string>& names);

}  // namespace ricochet
