#pragma once

#include "ricochet/io/frame_arrangement.hpp"

/// @file Frames as VTKHDF 2.0 (UnstructuredGrid) wants them: the rows of each frame follow those of the one before, in
/// data sets of the group /VTKHDF that grow, and the tables of /VTKHDF/Steps say at which row each step begins.
///
/// The mesh is the same in all steps, in one part: it is in the file before, as fixed data sets of /VTKHDF. The
/// layout's names are "PointData/NAME", "CellData/NAME", or "Points" where they move.
namespace ricochet {

[[nodiscard]] std::unique_ptr<const FrameArrangement> make_vtkhdf_frames(const std::vector<FixedDataset>& fixed,
                                                                         const std::vector<DatasetLayout>& layout,
                                                                         const FrameFileOptions& options);

}  // namespace ricochet
