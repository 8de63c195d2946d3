#include "support/paths.hpp"

namespace ricochet::test_support {

std::string source_path(const std::string& relative) { return RICOCHET_SOURCE_DIR "/" + relative; }

std::string data_path(const std::string& relative) { return RICOCHET_SOURCE_DIR "/tests/data/" + relative; }

std::string meshes_directory() { return RICOCHET_MESHES_DIR; }

}  // namespace ricochet::test_support
