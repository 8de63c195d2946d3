#include "support/errors.hpp"

namespace ricochet::test_support {

std::string message_of(const std::function<void()>& call, ErrorKind kind) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind) << error.what();
    return error.what();
  }
  return "";
}

std::string expect_error(ErrorKind kind, const std::vector<std::string>& parts, const std::function<void()>& call) {
  const std::string message = message_of(call, kind);
  EXPECT_NE(message, "") << "no error";
  for (const std::string& part : parts) EXPECT_TRUE(has(message, part));
  return message;
}

std::string expect_error(const std::vector<std::string>& parts, const std::function<void()>& call) {
  return expect_error(ErrorKind::invalid_input, parts, call);
}

testing::AssertionResult has(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "\"" << part << "\" is not in\n" << text;
}

}  // namespace ricochet::test_support
