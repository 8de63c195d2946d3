#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "ricochet/base/error.hpp"

/// @file Errors that a test expects.
namespace ricochet::test_support {

/// Returns the message of the error of this kind that the call throws, or "" if it throws none.
std::string message_of(const std::function<void()>& call, ErrorKind kind = ErrorKind::invalid_input);

/// Expects an error of this kind whose message has all parts. Returns the message.
std::string expect_error(ErrorKind kind, const std::vector<std::string>& parts, const std::function<void()>& call);
/// Expects invalid input.
std::string expect_error(const std::vector<std::string>& parts, const std::function<void()>& call);

/// Compares parts of texts; a failure prints both.
testing::AssertionResult has(const std::string& text, const std::string& part);

}  // namespace ricochet::test_support
