#include "ricochet/base/input_file.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <sstream>

#include "ricochet/base/error.hpp"

namespace ricochet {

std::string unreadable_reason(const std::string& path, int header) {
  struct stat about {};
  if (stat(path.c_str(), &about) != 0) return "";
  if (S_ISDIR(about.st_mode)) return "it is a directory";
  if (S_ISCHR(about.st_mode) || S_ISBLK(about.st_mode)) return "it is a device, not a file";
  if (S_ISFIFO(about.st_mode)) return "it is a pipe, not a file";
  if (!S_ISREG(about.st_mode)) return "it is a socket, not a file";
  std::array<char, 64> head{};
  std::ifstream file(path, std::ios::binary);
  file.ignore(header);
  if (file.read(head.data(), head.size()) && std::ranges::all_of(head, [](char c) { return c == '\0'; }))
    return "it begins with zeros: it is empty, or damaged";
  return "";
}

std::string read_input(const std::string& path, const std::string& noun, int header) {
  const std::string why_not = unreadable_reason(path, header);
  std::ifstream stream;
  if (why_not.empty()) stream.open(path, std::ios::binary);
  if (!why_not.empty() || !stream.is_open())
    throw Error(ErrorKind::file_access,
                fmt::format("cannot read the {} \"{}\": {}", noun, path, why_not.empty() ? "no such file" : why_not));
  std::ostringstream text;
  text << stream.rdbuf();
  if (stream.bad())
    throw Error(ErrorKind::file_access, fmt::format("cannot read the {} \"{}\" to its end", noun, path));
  return std::move(text).str();
}

}  // namespace ricochet
