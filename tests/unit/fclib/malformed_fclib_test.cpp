#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "support/fclib_support.hpp"

namespace ricochet::test {
namespace {

const std::string w = "/fclib_local/W/";
const std::string vectors = "/fclib_local/vectors/";
constexpr double infinity = std::numeric_limits<double>::infinity();

struct Malformed {
  const char* name;
  std::function<void(Raw&)> damage;
  const char* expected;  ///< part of the message
};

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

const Malformed cases[] = {
    {"no group of FCLib",
     [](Raw& r) {
       r = Raw{{}, {}, {}, {"/mesh"}};
     },
     "/fclib_local: there is no such group"},
    {"global",
     [](Raw& r) {
       r = Raw{{}, {}, {}, {"/fclib_global"}};
     },
     "/fclib_global: is a global problem"},
    {"empty",
     [](Raw& r) {
       r = Raw{{}, {}, {}, {"/fclib_local"}};
     },
     "/fclib_local/spacedim: there is no such dataset"},
    {"spacedim", [](Raw& r) { r.integers["/fclib_local/spacedim"] = {4}; }, "/fclib_local/spacedim: is 4; 2 or 3"},
    {"two spacedims",
     [](Raw& r) {
       r.integers["/fclib_local/spacedim"] = {2, 2};
     },
     "has 2 entries where one number"},
    {"no spacedims", [](Raw& r) { r.integers["/fclib_local/spacedim"] = {}; }, "has 0 entries where one number"},
    {"spacedim of text",
     [](Raw& r) { r.integers.erase("/fclib_local/spacedim"), r.texts["/fclib_local/spacedim"] = "2"; },
     "/fclib_local/spacedim: holds text where numbers are expected"},
    {"spacedim 2.5",
     [](Raw& r) { r.integers.erase("/fclib_local/spacedim"), r.reals["/fclib_local/spacedim"] = {2.5}; },
     "/fclib_local/spacedim: entry 0 is 2.5, which is not a whole number"},
    {"a group in the place of a data set",
     [](Raw& r) { r.integers.erase("/fclib_local/spacedim"), r.groups = {"/fclib_local/spacedim"}; },
     "/fclib_local/spacedim: there is no such dataset"},
    // sizes of W
    {"no W",
     [](Raw& r) {
       for (const char* n : {"nzmax", "m", "n", "nz", "p", "i"}) r.integers.erase(w + n);
       r.reals.erase(w + "x");
     },
     "/fclib_local/W: there is no such group"},
    {"no m", [](Raw& r) { r.integers.erase(w + "m"); }, "W/m: there is no such dataset"},
    {"negative m", [](Raw& r) { r.integers[w + "m"] = {-2}; }, "W/m: is -2, but a count cannot be negative"},
    {"m too small", [](Raw& r) { r.integers[w + "m"] = {1}; }, "W/p: entry 2 is 1, outside the range 0 to 0"},
    {"m != n", [](Raw& r) { r.integers[w + "m"] = {4}; }, "/fclib_local/W: has 4 rows and 2 columns"},
    {"m not d points", [](Raw& r) { r.integers[w + "m"] = r.integers[w + "n"] = {3}; },
     "/fclib_local/W: has 3 rows, which is not a multiple of 2 (spacedim)"},
    {"m huge", [](Raw& r) { r.integers[w + "m"] = {2147483647}; }, "W/m: is 2147483647, which is too large"},
    {"n huge", [](Raw& r) { compress(r, -1), r.integers[w + "n"] = {2147483646}; },
     "W/p: has 3 entries where 2147483647 are expected"},
    // triplets
    {"nz", [](Raw& r) { r.integers[w + "nz"] = {-3}; }, "W/nz: is -3; a number of triplets, -1"},
    {"nz above nzmax", [](Raw& r) { r.integers[w + "nz"] = {6}; }, "W/nz: is 6, more than nzmax = 5"},
    {"nz below the entries", [](Raw& r) { r.integers[w + "nz"] = {4}, r.integers[w + "nzmax"] = {6}; },
     "W/p: has 5 entries where 4, or nzmax = 6, are expected"},
    {"nzmax negative", [](Raw& r) { r.integers[w + "nzmax"] = {-1}; },
     "W/nzmax: is -1, but a count cannot be negative"},
    {"negative row", [](Raw& r) { r.integers[w + "p"][3] = -1; }, "W/p: entry 3 is -1, outside the range 0 to 1"},
    {"large column", [](Raw& r) { r.integers[w + "i"][1] = 2; }, "W/i: entry 1 is 2, outside the range 0 to 1"},
    {"few columns", [](Raw& r) { r.integers[w + "i"].pop_back(); }, "W/i: has 4 entries where 5 are expected"},
    {"few values", [](Raw& r) { r.reals[w + "x"].pop_back(); }, "W/x: has 4 entries where 5 are expected"},
    {"no values", [](Raw& r) { r.reals.erase(w + "x"); }, "W/x: there is no such dataset"},
    {"nan in W", [](Raw& r) { r.reals[w + "x"][2] = std::nan(""); }, "W/x: entry 2 is nan, which is not finite"},
    {"infinite sum", [](Raw& r) { r.reals[w + "x"][3] = r.reals[w + "x"][4] = 1e308; },
     "W/x: has entries whose sum is not finite"},
    {"row 0.5",
     [](Raw& r) {
       r.integers.erase(w + "p"), r.reals[w + "p"] = {0.0, 0.5, 1.0, 1.0, 1.0};
     },
     "W/p: entry 1 is 0.5, which is not a whole number"},
    // compressed
    {"start", [](Raw& r) { compress(r, -1), r.integers[w + "p"][0] = 1; }, "W/p: starts with 1 where 0 is expected"},
    {"falls",
     [](Raw& r) {
       compress(r, -2), r.integers[w + "p"] = {0, 2, 1};
     },
     "W/p: decreases from 2 to 1 at entry 2"},
    {"negative start", [](Raw& r) { compress(r, -2), r.integers[w + "p"][1] = -1; },
     "W/p: decreases from 0 to -1 at entry 1"},
    {"beyond", [](Raw& r) { compress(r, -1), r.integers[w + "p"][2] = 5; }, "W/p: entry 2 is 5, more than nzmax = 4"},
    {"few starts", [](Raw& r) { compress(r, -1), r.integers[w + "p"].pop_back(); },
     "W/p: has 2 entries where 3 are expected"},
    {"index", [](Raw& r) { compress(r, -1), r.integers[w + "i"][3] = 7; },
     "W/i: entry 3 is 7, outside the range 0 to 1"},
    {"few indices", [](Raw& r) { compress(r, -2), r.integers[w + "i"].pop_back(); },
     "W/i: has 3 entries where 4 are expected"},
    {"indices between",
     [](Raw& r) { compress(r, -2), r.integers[w + "nzmax"] = {6}, r.integers[w + "i"].push_back(0); },
     "W/i: has 5 entries where 4, or nzmax = 6, are expected"},
    {"many values", [](Raw& r) { compress(r, -2), r.reals[w + "x"].push_back(1.0); },
     "W/x: has 5 entries where 4 are expected"},
    // symmetry
    {"not symmetric", [](Raw& r) { r.reals[w + "x"][1] = 1.25; },
     "/fclib_local/W: is not symmetric: the entry in row 0 and column 1 (counted from 0) is 1.25, that in row 1 and "
     "column 0 is 1"},
    {"triangle", [](Raw& r) { r.reals[w + "x"][1] = 0.0; }, "/fclib_local/W: is not symmetric"},
    {"negative diagonal", [](Raw& r) { r.reals[w + "x"][3] = -3.0; },
     "/fclib_local/W: is not positive semi-definite: the entry in row and column 1 (counted from 0) is -3"},
    {"no diagonal",
     [](Raw& r) {
       r.reals[w + "x"] = {0.0, 1.0, 1.0 + 1e-15, 0.0, 0.0};
     },
     "/fclib_local/W: is not symmetric"},
    // vectors
    {"no q", [](Raw& r) { r.reals.erase(vectors + "q"); }, "vectors/q: there is no such dataset"},
    {"no vectors", [](Raw& r) { r.reals.erase(vectors + "q"), r.reals.erase(vectors + "mu"); },
     "vectors/q: there is no such dataset"},
    {"short q", [](Raw& r) { r.reals[vectors + "q"] = {1.0}; }, "vectors/q: has 1 entries where 2 are expected"},
    {"infinite q", [](Raw& r) { r.reals[vectors + "q"][1] = -infinity; },
     "vectors/q: entry 1 is -inf, which is not finite"},
    {"long mu",
     [](Raw& r) {
       r.reals[vectors + "mu"] = {0.3, 0.3};
     },
     "vectors/mu: has 2 entries where 1 are expected"},
    {"negative mu", [](Raw& r) { r.reals[vectors + "mu"] = {-0.3}; }, "vectors/mu: entry 0 is -0.3: a coefficient"},
    {"nan mu", [](Raw& r) { r.reals[vectors + "mu"] = {std::nan("")}; }, "vectors/mu: entry 0 is nan"},
    {"mu of text", [](Raw& r) { r.reals.erase(vectors + "mu"), r.texts[vectors + "mu"] = "0.3"; },
     "vectors/mu: holds text where numbers are expected"},
    // equality constraints
    {"no R",
     [](Raw& r) {
       constrain(r);
       std::erase_if(r.integers, [](const auto& e) { return e.first.starts_with("/fclib_local/R"); });
       r.reals.erase("/fclib_local/R/x");
     },
     "/fclib_local/R: there is no such group; V and R must both be present"},
    {"no V",
     [](Raw& r) {
       constrain(r);
       std::erase_if(r.integers, [](const auto& e) { return e.first.starts_with("/fclib_local/V"); });
       r.reals.erase("/fclib_local/V/x");
     },
     "/fclib_local/V: there is no such group; V and R must both be present"},
    {"no s", [](Raw& r) { constrain(r), r.reals.erase(vectors + "s"); }, "vectors/s: there is no such dataset"},
    {"long s",
     [](Raw& r) {
       constrain(r), r.reals[vectors + "s"] = {1.0, 2.0};
     },
     "vectors/s: has 2 entries where 1"},
    {"R not square", [](Raw& r) { constrain(r), r.integers["/fclib_local/R/n"] = {2}; },
     "/fclib_local/R: has 1 rows and 2 columns"},
    {"V of other rows", [](Raw& r) { constrain(r), r.integers["/fclib_local/V/m"] = {3}; },
     "/fclib_local/V: has 3 rows and 1 columns where 2 (rows of W) and 1 (rows of R) are expected"},
    {"V of other columns", [](Raw& r) { constrain(r), r.integers["/fclib_local/V/n"] = {3}; },
     "/fclib_local/V: has 2 rows and 3 columns"},
    {"R zero", [](Raw& r) { constrain(r), r.reals["/fclib_local/R/x"] = {0.0}; },
     "/fclib_local/R: is singular, of rank 0"},
    // info, solution and guesses
    {"title of numbers", [](Raw& r) { r.integers["/fclib_local/info/title"] = {1}; },
     "info/title: holds whole numbers where text is expected"},
    {"points",
     [](Raw& r) {
       r.integers["/fclib_local/info/points"] = {1, 2};
     },
     "info/points: has 2 entries where 1"},
    {"short rounding", [](Raw& r) { r.reals["/fclib_local/info/q_rounding"] = {1e-16}; },
     "info/q_rounding: has 1 entries where 2"},
    {"negative rounding",
     [](Raw& r) {
       r.reals["/fclib_local/info/q_rounding"] = {1e-16, -1e-16};
     },
     "info/q_rounding: entry 1 is -1e-16: the size of an error cannot be negative"},
    {"no u",
     [](Raw& r) {
       r.reals["/solution/r"] = {1.0, 0.0};
     },
     "/solution/u: there is no such dataset"},
    {"short r",
     [](Raw& r) {
       r.reals["/solution/r"] = {1.0}, r.reals["/solution/u"] = {0.0, 0.0};
     },
     "/solution/r: has 1 entries where 2 are expected"},
    {"no l",
     [](Raw& r) {
       constrain(r), r.reals["/solution/r"] = r.reals["/solution/u"] = {0.0, 0.0};
     },
     "/solution/l: there is no such dataset"},
    {"no number of guesses", [](Raw& r) { r.groups = {"/guesses"}; }, "/guesses/number_of_guesses: there is no such"},
    {"guesses", [](Raw& r) { r.integers["/guesses/number_of_guesses"] = {1}; },
     "/guesses/1: there is no such group, but number_of_guesses is 1"},
    {"negative guesses", [](Raw& r) { r.integers["/guesses/number_of_guesses"] = {-1}; }, "number_of_guesses: is -1"},
};

TEST(MalformedFclib, EveryMessageNamesFileDatasetAndValue) {
  const TemporaryFile file;
  raw_example().write(file.path);
  ASSERT_NO_THROW((void)read_fclib(file.path));
  for (const Malformed& entry : cases) {
    SCOPED_TRACE(entry.name);
    Raw raw = raw_example();
    entry.damage(raw);
    raw.write(file.path);
    expect_error([&] { (void)reduce(read_fclib(file.path)); }, entry.expected);
    expect_error([&] { (void)reduce(read_fclib(file.path)); }, file.path + ": /");
  }
}

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
  expect_error([&] { (void)read_fclib(file.path); }, file.path + ": no such file", ErrorKind::file_access);
  expect_error([&] { (void)read_fclib("/tmp"); }, "/tmp: is a directory", ErrorKind::file_access);
  std::ofstream(file.path) << "not HDF5\n";
  expect_error([&] { (void)read_fclib(file.path); }, file.path + ": is not an HDF5 file");
}

// --- damage
// -----------------------------------------------------------------------------------------------------------

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
    damaged[bit / 8] = static_cast<char>(static_cast<unsigned char>(damaged[bit / 8]) ^ (1U << (bit % 8)));
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
}  // namespace ricochet::test
