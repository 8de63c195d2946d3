#include "ricochet/mesh/mesh_cache.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cctype>
#include <cstdlib>
#include <functional>
#include <set>
#include <sstream>
#include <string_view>
#include <vector>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/base/temporary_folder.hpp"
#include "ricochet/mesh/convert_process.hpp"
#include "ricochet/mesh/gmsh_process.hpp"

namespace ricochet::gmsh {

namespace fs = std::filesystem;

namespace {

__extension__ using Unsigned128 = unsigned __int128;  // not ISO C++, but GCC and Clang have it on 64-bit machines

/// Returns the files to which a mesh of another program's format refers: those that an .inp file includes, the .h5 file
/// of an .xdmf, the other half of TetGen's pair.
std::vector<fs::path> companions(const fs::path& path, const std::string& content) {
  std::vector<fs::path> found;
  const std::string extension = extension_of(path.string());
  if (extension == ".ele" || extension == ".node") {
    for (const char* other : {".ele", ".node"}) found.push_back(fs::path(path).replace_extension(other));
  }
  // Everything that looks like a file name: those that are none do not exist, and cost nothing.
  const bool is_inp = extension == ".inp";
  if (!is_inp && extension != ".xdmf" && extension != ".xmf") return found;
  std::istringstream lines(content);
  for (std::string line; std::getline(lines, line);) {
    if (is_inp && line.find('=') == std::string::npos) continue;
    std::size_t start = 0;
    for (std::size_t i = 0; i <= line.size(); ++i) {
      const bool ends = i == line.size() ||
                        std::string_view(is_inp ? "=,\r\"" : " \t\r<>\":").find(line[i]) != std::string_view::npos;
      if (!ends) continue;
      const std::size_t first = line.find_first_not_of(' ', start);
      if (first < i)
        found.push_back(path.parent_path() / line.substr(first, line.find_last_not_of(' ', i - 1) + 1 - first));
      start = i + 1;
    }
  }
  return found;
}

void append_companions(const fs::path& path, std::set<fs::path>& visited, std::string& key) {
  std::error_code error;
  const fs::path canonical = fs::weakly_canonical(path, error);
  if (error || !fs::is_regular_file(canonical, error) || !visited.insert(canonical).second) return;
  const std::string content = read_whole_file(canonical);
  key += fmt::format("{} {}\n", path.filename().string(), content.size()) + content;
  for (const fs::path& companion : companions(path, content)) append_companions(companion, visited, key);
}

bool is_script(const std::string& path) { return extension_of(path) == ".geo"; }

/// Options file that gmsh reads along with a file.
fs::path options_file(const fs::path& path) { return path.string() + ".opt"; }

/// Appends the contents on which the mesh depends: the file, the options that Gmsh reads beside it, and every file that
/// a .geo file names in quotes, such as those it merges. Names that a .geo file computes and effects of its SystemCall
/// are not covered.
void append_sources(const fs::path& path, std::set<fs::path>& visited, std::string& key) {
  std::error_code error;
  const fs::path canonical = fs::weakly_canonical(path, error);
  if (error || !fs::is_regular_file(canonical, error) || !visited.insert(canonical).second) return;
  const std::string content = read_whole_file(canonical);
  key += fmt::format("{} {}\n", path.filename().string(), content.size()) + content;
  append_sources(options_file(path), visited, key);
  if (!is_script(path.string())) return;
  constexpr const char* quotes = "\"'";
  std::size_t quote = content.find_first_of(quotes);
  while (quote != std::string::npos) {
    const std::size_t next = content.find_first_of(quotes, quote + 1);
    if (next == std::string::npos) break;
    const std::string name = content.substr(quote + 1, next - quote - 1);
    if (!name.empty() && name.find('\n') == std::string::npos) {
      append_sources(path.parent_path() / name, visited, key);
    }
    quote = next;  // also the text between two strings is tried, so that a stray quote in a comment does no harm
  }
}

/// Returns the cache directory, created if missing; the first of the candidates that is writable.
fs::path cache_directory() {
  std::vector<fs::path> candidates;
  const auto variable = [](const char* name) {
    const char* value = std::getenv(name);
    return value == nullptr ? std::string() : std::string(value);
  };
  if (const std::string own = variable("RICOCHET_CACHE"); !own.empty()) {
    candidates.emplace_back(own);
  } else if (const std::string xdg = variable("XDG_CACHE_HOME"); !xdg.empty()) {
    candidates.emplace_back(fs::path(xdg) / "ricochet");
  } else if (const std::string home = variable("HOME"); !home.empty()) {
    candidates.emplace_back(fs::path(home) / ".cache" / "ricochet");
  }
  candidates.emplace_back(fs::temp_directory_path() / fmt::format("ricochet-cache-{}", getuid()));
  for (const fs::path& candidate : candidates) {
    std::error_code error;
    fs::create_directories(candidate, error);
    if (!error && access(candidate.c_str(), W_OK | X_OK) == 0) return candidate;
  }
  throw Error(ErrorKind::file_access, fmt::format("no directory to cache generated or converted meshes in: cannot "
                                                  "write to {}; set RICOCHET_CACHE to a writable directory",
                                                  candidates.front().string()));
}

std::string gmsh_options(const MeshFile& file) {
  std::string options = fmt::format(
      "Mesh.MshFileVersion = 4.1;\nMesh.Binary = 1;\nMesh.ElementOrder = {};\nMesh.SecondOrderIncomplete = 0;\n"
      "Mesh.SaveParametric = 0;\nMesh.SaveTopology = 0;\nMesh.ScalingFactor = 1;\n",
      file.geometry_degree);
  // Both bounds: sizes given in the file are clamped to the requested one.
  if (file.size) {
    options += fmt::format("Mesh.MeshSizeFactor = 1;\nMesh.MeshSizeMin = {0:.17g};\nMesh.MeshSizeMax = {0:.17g};\n",
                           *file.size);
  }
  return options;
}

/// Path in the cache of a file that is made from a source with this key.
fs::path cache_path(const std::string& source, const std::string& key) {
  return cache_directory() / fmt::format("{}-{}.msh", fs::path(source).stem().string(), fnv1a_128(key));
}

/// Returns the file that `make` writes, or wrote earlier with the same key.
fs::path cached_mesh(const std::string& source, const std::string& key, const char* doing,
                     const std::function<void(const fs::path& workspace, const fs::path& output)>& make) {
  const fs::path result = cache_path(source, key);
  if (fs::exists(result)) {
    log::debug(fmt::format("{}: using the cached mesh {}", source, result.string()));
    return result;
  }
  log::info(fmt::format("{}: {}", source, doing));
  const TemporaryFolder workspace(result.parent_path(), "meshing");
  const fs::path output = workspace.path() / "mesh.msh";
  make(workspace.path(), output);
  std::error_code error;
  fs::rename(output, result, error);  // in one step, so that a cached mesh is always a complete one
  if (error) throw Error(ErrorKind::file_access, fmt::format("cannot write {}: {}", result.string(), error.message()));
  return result;
}

/// Returns the key of a mesh: everything that determines it.
std::string key_of(const MeshFile& file, const std::string& options) {
  std::string key =
      fmt::format("gmsh {} {}\n{}", program_version(file.path), fmt::join(gmsh::command_options, " "), options);
  std::set<fs::path> visited;
  append_sources(file.path, visited, key);
  return key;
}

}  // namespace

std::string fnv1a_128(std::string_view content) {
  const Unsigned128 prime = (static_cast<Unsigned128>(1) << 88) + 0x13b;
  Unsigned128 hash = (static_cast<Unsigned128>(0x6c62272e07bb0142u) << 64) + 0x62b821756295c58du;
  for (const char c : content) hash = (hash ^ static_cast<unsigned char>(c)) * prime;
  return fmt::format("{:016x}{:016x}", std::uint64_t(hash >> 64), std::uint64_t(hash));
}

bool is_cad_file(const std::string& path) {
  static const std::set<std::string> extensions{".step", ".stp", ".iges", ".igs", ".brep"};
  return extensions.contains(extension_of(path));
}

std::string extension_of(const std::string& path) {
  std::string text = fs::path(path).extension().string();
  for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

fs::path meshed_file(const MeshFile& file) {
  const std::string options = gmsh_options(file);
  return cached_mesh(
      file.path, key_of(file, options), "meshing with the gmsh program",
      [&](const fs::path& workspace, const fs::path& output) { run_program(file.path, options, workspace, output); });
}

std::optional<fs::path> meshed_before(const MeshFile& file) {
  fs::path path = cache_path(file.path, key_of(file, gmsh_options(file)));
  return fs::exists(path) ? std::optional(std::move(path)) : std::nullopt;
}

fs::path converted_file(const std::string& path) {
  std::string key = "converter " + converter_version(path) + "\n";
  std::set<fs::path> visited;
  append_companions(path, visited, key);
  return cached_mesh(path, key, "converting to .msh",
                     [&](const fs::path& workspace, const fs::path& output) { convert_mesh(path, workspace, output); });
}

}  // namespace ricochet::gmsh

namespace ricochet {

bool needs_gmsh_program(const std::string& path) { return gmsh::is_cad_file(path) || gmsh::is_script(path); }

bool may_run_commands(const std::string& path) {
  std::error_code ignored;
  return gmsh::is_script(path) ||
         (gmsh::is_cad_file(path) && std::filesystem::exists(gmsh::options_file(path), ignored));
}

}  // namespace ricochet
