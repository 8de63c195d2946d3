#pragma once

#include <string>
#include <vector>

/// @file benchmarks.toml: the benchmarks that there are, each a case file whose [[expect]] entries are reference
/// values.
namespace ricochet {

struct Benchmark {
  std::string name;
  std::string case_path;    ///< absolute
  std::string group;        ///< which part of the tables it belongs to; may be empty
  std::string description;  ///< one line
};

/// Case files are named relative to the manifest. Throws Error(file_access) where it cannot be read, and
/// Error(invalid_input) with all that is wrong in it: keys that are missing, unknown or no text, names that are there
/// twice, case files that are not there.
[[nodiscard]] std::vector<Benchmark> read_benchmarks(const std::string& path);

/// Those of these names, each once and in the order of the manifest; all without names. Throws Error(usage) that lists
/// the names there are.
[[nodiscard]] std::vector<Benchmark> choose_benchmarks(const std::vector<Benchmark>& all,
                                                       const std::vector<std::string>& names);

}  // namespace ricochet
