#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <sstream>

#include "support/fclib_support.hpp"
#include "support/message_table.hpp"

namespace ricochet::test_support {
namespace {

const std::string w = "/fclib_local/W/";
const std::string vectors = "/fclib_local/vectors/";

/// Converts W to compressed form.
void compress(Raw& raw, int form) {
  raw.integers[w + "nz"] = {form};
  raw.integers[w + "nzmax"] = {4};
  raw.integers[w + "p"] = {0, 2, 4};
  raw.integers[w + "i"] = {0, 1, 0, 1};
  raw.reals[w + "x"] = {2.0, 1.0, 1.0, 3.0};
}

/// Adds one equality constraint.
void constrain(Raw& raw) {
  for (const std::string name : {"/fclib_local/V/", "/fclib_local/R/"}) {
    const bool v = name == "/fclib_local/V/";
    raw.integers[name + "nzmax"] = {1};
    raw.integers[name + "m"] = {v ? 2 : 1};
    raw.integers[name + "n"] = {1};
    raw.integers[name + "nz"] = {1};
    raw.integers[name + "p"] = {0};
    raw.integers[name + "i"] = {0};
    raw.reals[name + "x"] = {2.0};
  }
  raw.reals[vectors + "s"] = {1.0};
}

/// Makes one of the changes that the head of malformed_fclib.txt describes.
void change(Raw& raw, const std::string& text) {
  std::istringstream words(text);
  std::string name, verb;
  words >> name;
  if (name == "constrained") return constrain(raw);
  if (name == "without" || name == "only" || name == "group" || name == "compressed") verb = name, words >> name;
  if (verb == "compressed") return compress(raw, std::stoi(name));
  if (verb == "only") raw = Raw{{}, {}, {}, {name}};
  if (name[0] != '/') name.insert(0, "/fclib_local/");
  if (verb == "group") raw.groups = {name};
  const std::size_t bracket = name.find('[');
  const std::size_t entry = bracket == std::string::npos ? 0 : std::stoul(name.substr(bracket + 1));
  name.resize(std::min(bracket, name.size()));
  const bool has_reals = raw.reals.count(name) == 1;
  if (verb.empty()) words >> verb;
  std::string values;
  std::getline(words >> std::ws, values);
  const bool are_whole = values.find_first_of(".nf") == std::string::npos && values.find('e') == std::string::npos;
  if (verb == "=" && bracket != std::string::npos) {
    has_reals ? raw.reals[name].at(entry) = std::stod(values) : raw.integers[name].at(entry) = std::stoi(values);
  } else if (verb == "-") {
    has_reals ? raw.reals[name].pop_back() : raw.integers[name].pop_back();
  } else if (verb == "+") {
    has_reals ? raw.reals[name].push_back(0.0) : raw.integers[name].push_back(0);
  } else if (verb == "without" || verb == "=") {
    const bool is_group = name.ends_with('/');
    const auto is_damaged = [&](const auto& each) {
      return is_group ? each.first.starts_with(name) : each.first == name;
    };
    std::erase_if(raw.integers, is_damaged);
    std::erase_if(raw.reals, is_damaged);
    if (verb == "without") return;
    if (values[0] == '"') raw.texts[name] = values.substr(1, values.size() - 2);
    if (values[0] == '"') return;
    if (are_whole) raw.integers[name];
    std::istringstream list(values);
    for (std::string value; std::getline(list, value, ',');) {
      are_whole ? raw.integers[name].push_back(std::stoi(value)) : raw.reals[name].push_back(std::stod(value));
    }
  }
}

class MalformedFclibFile : public testing::TestWithParam<MessageRow> {};

TEST_P(MalformedFclibFile, IsRefusedWithFileDatasetAndValue) {
  const TemporaryFile file;
  Raw raw = raw_example();
  raw.write(file.path);
  ASSERT_NO_THROW((void)read_fclib(file.path));
  const std::string& changes = GetParam().cells.at(1);
  for (std::size_t begin = 0, end = 0; end != std::string::npos; begin = end + 2) {
    end = changes.find("; ", begin);
    change(raw, changes.substr(begin, end == std::string::npos ? end : end - begin));
  }
  raw.write(file.path);
  expect_error({GetParam().cells.at(2), file.path + ": /"}, [&] { (void)reduce(read_fclib(file.path)); });
}

INSTANTIATE_TEST_SUITE_P(All, MalformedFclibFile, testing::ValuesIn(read_messages("malformed_fclib.txt")),
                         [](const auto& row) {
                           std::string name = row.param.cells.front();
                           for (char& each : name) each = std::isalnum(static_cast<unsigned char>(each)) ? each : '_';
                           return name;
                         });

TEST(MalformedFclib, CasesAreSoundButForTheirDamage) {
  const TemporaryFile file;
  for (const int form : {-1, -2}) {
    Raw raw = raw_example();
    compress(raw, form);
    constrain(raw);
    raw.write(file.path);
    EXPECT_NO_THROW((void)reduce(read_fclib(file.path)));
  }
}

TEST(MalformedFclib, WhatIsNoFileOfThisKind) {
  const TemporaryFile file;
  expect_error(ErrorKind::file_access, {file.path + ": no such file"}, [&] { (void)read_fclib(file.path); });
  expect_error(ErrorKind::file_access, {"/tmp: is a directory"}, [] { (void)read_fclib("/tmp"); });
  std::ofstream(file.path) << "not HDF5\n";
  expect_error({file.path + ": is not an HDF5 file"}, [&] { (void)read_fclib(file.path); });
}

/// Expects that reading a possibly damaged file gives an error or exactly the written data.
void expect_error_or_same(const TemporaryFile& file, const std::string& bytes, const FclibProblem& original,
                          const std::string& what, Index& errors) {
  std::ofstream(file.path, std::ios::binary | std::ios::trunc) << bytes;
  try {
    const FclibProblem found = read_fclib(file.path);
    EXPECT_TRUE(same(found, original)) << what << ": read without an error, but something else";
  } catch (const Error&) {
    ++errors;
  }
}

void fuzz(const FclibProblem& problem, std::size_t stride) {
  const TemporaryFile file;
  write_fclib(file.path, problem);
  const std::string whole = contents(file.path);
  Index errors = 0, read = 0;
  for (std::size_t size = 0; size < whole.size(); size += stride, ++read)
    expect_error_or_same(file, whole.substr(0, size), problem, "cut off at " + std::to_string(size), errors);
  EXPECT_EQ(errors, read) << "every file that is cut off is an error";
  errors = 0;
  for (std::size_t bit = 0; bit < 8 * whole.size(); bit += stride) {
    std::string damaged = whole;
    damaged[bit / 8] = char(static_cast<unsigned char>(damaged[bit / 8]) ^ (1U << (bit % 8)));
    expect_error_or_same(file, damaged, problem, "bit " + std::to_string(bit), errors);
  }
  EXPECT_GT(errors, 0);
}

TEST(MalformedFclib, DamagedSmallFile) {
  FclibProblem problem = example(2, 2, 1);
  problem.guesses.clear();
  fuzz(problem, 211);
}

TEST(MalformedFclib, DamagedFileWithChunks) {
  FclibProblem problem = example(3, 22, 0);  // 66² values do not fit into headers
  fuzz(problem, 997);
}

}  // namespace
}  // namespace ricochet::test_support
