#pragma once

#include <string>
#include <vector>

/// @file The sub-commands, one file each. Each returns the exit status, or throws ricochet::Error which carries it.
namespace ricochet::program {

struct RunArguments {
  std::string case_file;
  std::string output_directory;  ///< empty: out/NAME of the case file
  std::vector<std::string> overrides;
  bool force = false;
  bool quiet = false;
};

int run(const RunArguments& arguments);
int validate(const std::string& case_file, const std::vector<std::string>& overrides);
int info(const std::vector<std::string>& paths);
int schema(bool markdown);

}  // namespace ricochet::program
