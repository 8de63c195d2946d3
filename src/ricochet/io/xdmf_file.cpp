#include "ricochet/io/xdmf_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <filesystem>

#include "ricochet/base/file_version.hpp"
#include "ricochet/io/durable_file.hpp"
#include "ricochet/version.hpp"

namespace ricochet {

namespace {

const std::string tail = "    </Grid>\n  </Domain>\n</Xdmf>\n";

}  // namespace

XdmfFile::XdmfFile(std::string path, const std::string& collection, const std::string& included)
    : path_(std::move(path)), file_(path_, std::ios::in | std::ios::out | std::ios::trunc | std::ios::binary) {
  if (!file_) throw_file_error(path_, "write", errno);
  change_detector_.emplace(path_);
  std::string head =
      "<?xml version=\"1.0\"?>\n<Xdmf xmlns:xi=\"http://www.w3.org/2001/XInclude\" Version=\"3.0\">\n  <Domain>\n";
  head += fmt::format("    <Information Name=\"{}\" Value=\"{}\"/>\n", version_attribute, version);
  // The include comes first: readers that support only one collection use the last.
  if (!included.empty())
    head += fmt::format("    <xi:include href=\"{}\" xpointer=\"xpointer(/Xdmf/Domain/Grid)\"/>\n", included);
  head += fmt::format("    <Grid Name=\"{}\" GridType=\"Collection\" CollectionType=\"Temporal\">\n", collection);
  append(head);
}

XdmfFile::XdmfFile(std::string path, const SnapshotVisitor& saved) : path_(std::move(path)), checksums_(saved) {
  truncate_file(path_, checksums_.length());
  file_.open(path_, std::ios::in | std::ios::out | std::ios::binary);
  if (!file_) throw_file_error(path_, "write", errno);
  change_detector_.emplace(path_);
  append("");
}

void XdmfFile::save(const SnapshotVisitor& visit) {
  checksums_.persist(visit, std::filesystem::path(path_).filename().string());
}

/// Overwrites the closing tags by the grid and new closing tags in one write, once there is space for both.
void XdmfFile::append(const std::string& grid) {
  change_detector_->require_unchanged();
  const std::string text = grid + tail;
  reserve_space(path_, static_cast<std::int64_t>(text.size()));
  errno = 0;
  file_.seekp(checksums_.length());
  file_ << text << std::flush;
  if (!file_) throw_file_error(path_, "write", errno);
  if (!grid.empty()) checksums_.add(grid);
  change_detector_->expect_size(checksums_.length() + static_cast<std::int64_t>(tail.size()));
}

}  // namespace ricochet
