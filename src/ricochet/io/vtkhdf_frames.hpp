#pragma once

#include "ricochet/io/frame_arrangement.hpp"

/// @file Frames in VTKHDF 2.0 (UnstructuredGrid): the rows of each frame follow those of the previous one in growing
/// datasets of the group /VTKHDF, and the tables of /VTKHDF/Steps contain the first row of each step.
///
/// The mesh is the same in all steps, in one part: it already exists as fixed datasets of /VTKHDF. The names of the
/// layout are "PointData/NAME", "CellData/NAME", or "Points" if these move.
namespace ricochet {

[[nodiscard]] std::unique_ptr<const FrameArrangement> make_vtkhdf_frames(const std::vector<FixedDataset>& fixed,
                                                                         const std::vector<DatasetLayout>& layout,
                                                                         const FrameFileOptions& options);

}  // namespace ricochet
