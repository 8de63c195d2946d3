#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ricochet/run/session.hpp"

/// @file The sub-commands, one file each. Each returns the exit status, or throws ricochet::Error, which carries it.
namespace ricochet::program {

struct RunArguments {
  std::string case_file;
  std::string output_directory;  ///< empty: out/NAME of the case file
  std::vector<std::string> overrides;
  bool force = false, resume = false;
  bool quiet = false;
  std::optional<std::string> export_contact;  ///< steps, such as 10,20,50:60
  std::string export_contact_to;              ///< directory; empty: contact/ in the output directory
  // With several processes:
  const Ranks* ranks = &one_rank();
  Session::ModelBuilder builder = {};  ///< null: build_model
};

struct ValidateArguments {
  std::string case_file;
  std::vector<std::string> overrides;
  bool mesh = false;  ///< also mesh files that need the gmsh program and have not been meshed before
};

struct InfoArguments {
  std::vector<std::string> paths, overrides;
};

struct ContactArguments {
  std::string problem;
  std::string solver = "automatic";
  double tolerance = 0.0;
  std::string output;  ///< empty: none
  bool record = false;
  bool list = false;  ///< only list the solvers
};

struct ReportArguments {
  std::vector<std::string> directories;
  std::string output;  ///< empty: report.html in the directory, or in the common folder of all directories
  double most_megabytes = 20.0;
};

struct PlotArguments {
  std::vector<std::string> directories, what, labels;
  std::string output, title;
  std::string time;  ///< "A:B"; empty: all
  std::string size;  ///< "WxH" in cm; empty: chosen to suit the panels
  bool logarithmic = false;
  // For animations:
  std::string field;         ///< empty: the von Mises stress
  std::optional<double> at;  ///< time of a single picture
  bool half = false;         ///< section only, for an axisymmetric body
  bool zoom = false;         ///< on the contact
};

struct StudyArguments {
  std::string case_file, output_directory;
  std::vector<std::string> vary, overrides;
  std::vector<std::string> quantities, exact, compare;
  std::string reference, order;
  int jobs = 0;  ///< 0: as many as the cores support
  int threads = 1;
  bool resume = false, force = false, quiet = false;
};

struct BenchmarkArguments {
  std::vector<std::string> names;
  std::string output_directory = "out/benchmark";
  std::string scheme;  ///< "all" or a list; empty: the scheme of each case
  std::string folder;  ///< folder with benchmarks.toml; empty: that of the program
  int jobs = 0;        ///< 0: as many as there are cores
  bool list = false, resume = false, force = false, quiet = false;
};

/// Choice of what `schema` prints; none: the JSON Schema of the case file.
struct SchemaArguments {
  bool markdown = false, columns = false, summary = false;
};

int run(const RunArguments& arguments);
int validate(const ValidateArguments& arguments);
int info(const InfoArguments& arguments);
int schema(const SchemaArguments& arguments);
int contact(const ContactArguments& arguments);
int report(const ReportArguments& arguments);
int plot(const PlotArguments& arguments);
int study(const StudyArguments& arguments);
int benchmark(const BenchmarkArguments& arguments);
/// Prints the table of existing benchmarks.
void describe_benchmarks(const std::string& directory);
/// Prints the table of a study.
void describe_study(const std::string& directory);
/// Describes a contact problem in a few lines.
void describe_contact_problem(const std::string& path);

}  // namespace ricochet::program
