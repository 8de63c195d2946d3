#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "ricochet/base/error.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/case/keys_table.hpp"
#include "ricochet/case/read_case.hpp"
#include "ricochet/scheme/scheme.hpp"
#include "support/errors.hpp"

/// @file Case files made for one test.
namespace ricochet::case_test {

using namespace test_support;

/// The shortest valid case. Tests of malformed files replace one of its 11 lines or append to it.
inline const std::vector<std::string> shortest_case{
    "[mesh]",   "file = \"a.msh\"", "[[material]]",          "group = \"body\"", "density = 1.0", "lambda = 1.0",
    "mu = 1.0", "[time]",           "scheme = \"midpoint\"", "step = 0.1",       "end = 1.0"};

/// The shortest case with line `line` replaced by `text`, or with `text` appended for line 0.
inline std::string edited_case(std::size_t line, const std::string& text) {
  std::vector<std::string> lines = shortest_case;
  if (line == 0) {
    lines.push_back(text);
  } else {
    lines.at(line - 1) = text;
  }
  std::string document;
  for (const std::string& each : lines) document += each + "\n";
  return document;
}

/// A file that is removed with the object.
class CaseFile {
 public:
  explicit CaseFile(const std::string& document) {
    static int count = 0;
    const std::string name = "ricochet_case_" + std::to_string(::getpid()) + "_" + std::to_string(++count) + ".toml";
    path_ = (std::filesystem::temp_directory_path() / name).string();
    std::ofstream(path_, std::ios::binary) << document;
  }
  ~CaseFile() { std::filesystem::remove(path_); }
  CaseFile(const CaseFile&) = delete;
  CaseFile& operator=(const CaseFile&) = delete;
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
};

inline Case read_text(const std::string& document, const std::vector<std::string>& overrides = {}) {
  return read_case(CaseFile(document).path(), overrides);
}

/// Message of the Error(invalid_input) that reading throws, without the file name; "" if it throws none.
inline std::string problems_of(const std::string& document, const std::vector<std::string>& overrides = {}) {
  const CaseFile file(document);
  try {
    static_cast<void>(read_case(file.path(), overrides));
  } catch (const Error& problem) {
    EXPECT_EQ(problem.kind(), ErrorKind::invalid_input);
    std::string message = problem.what();
    const std::string name = file.path() + ":";
    for (std::size_t at = message.find(name); at != std::string::npos; at = message.find(name))
      message.erase(at, name.size());
    return message;
  }
  return "";
}

/// The list of schemes and of the keys of [time], as in messages.
inline std::string all_schemes() { return join_names(scheme_names(), " or "); }
inline std::string keys_of_time() {
  for (const Section& section : case_sections()) {
    if (section.name == "time") return join_names(names_of(section.keys));
  }
  return "";
}

}  // namespace ricochet::case_test
