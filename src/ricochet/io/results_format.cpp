#include "ricochet/io/results_format.hpp"

#include <filesystem>

namespace ricochet {

// The formats, each by the registration function of its own file. One line each, in the order of the documentation.
// clang-format off
#define RICOCHET_RESULTS_FORMATS(format) \
  format(xdmf_format)                    \
  format(vtkhdf_format)
// clang-format on

RICOCHET_DEFINE_REGISTRY(results_format_registry, ResultsFormat, "format of fields", RICOCHET_RESULTS_FORMATS)

std::string any_format(std::string (*text)(const ResultsFormat& format), const char* separator) {
  std::vector<std::string> texts;
  for (const Registration<ResultsFormat>& entry : results_format_registry().all()) texts.push_back(text(entry.type));
  return join_names(texts, separator, false);
}

std::vector<std::string> files_of_all_formats() {
  std::vector<std::string> names;
  for (const Registration<ResultsFormat>& entry : results_format_registry().all()) {
    names.insert(names.end(), entry.type.files.begin(), entry.type.files.end());
    names.push_back(entry.type.obstacles);
  }
  return names;
}

const ResultsFormat* find_results_format(const std::string& directory) {
  const ResultsFormat* found = nullptr;
  for (const Registration<ResultsFormat>& entry : results_format_registry().all()) {
    const std::vector<std::string>& files = entry.type.files;
    if (std::ranges::all_of(files,
                            [&](const std::string& file) { return std::filesystem::exists(directory + "/" + file); }))
      found = &entry.type;
  }
  return found;
}

}  // namespace ricochet
