#pragma once

#include "ricochet/io/frame_arrangement.hpp"

/// @file Frames in groups of their own, /frames/NNNNNN, with a dataset for each field (results.h5).
namespace ricochet {

/// "/frames/000012".
[[nodiscard]] std::string frame_group_name(long frame);

[[nodiscard]] std::unique_ptr<const FrameArrangement> make_frame_groups(const std::vector<DatasetLayout>& layout,
                                                                        const FrameFileOptions& options);

}  // namespace ricochet
