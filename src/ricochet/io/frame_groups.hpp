#pragma once

#include "ricochet/io/frame_arrangement.hpp"

/// @file Each frame in a group of its own, /frames/NNNNNN, with a data set for each of its fields (results.h5).
namespace ricochet {

/// "/frames/000012".
[[nodiscard]] std::string frame_group_name(long frame);

[[nodiscard]] std::unique_ptr<const FrameArrangement> make_frame_groups(const std::vector<DatasetLayout>& layout,
                                                                        const FrameFileOptions& options);

}  // namespace ricochet
