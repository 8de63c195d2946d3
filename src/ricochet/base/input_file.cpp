#include "ricochet/base/input_file.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <fstream>

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
  if (file.read(head.data(), head.size()) && std::all_of(head.begin(), head.end(), [](char c) { return c == '\0'; }))
    return "it begins with zeros: it is empty, or damaged";
  return "";
}

}  // namespace ricochet
