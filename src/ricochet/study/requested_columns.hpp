#pragma once

#include "ricochet/study/study_files.hpp"

/// @file Check of the columns requested by a study, before its runs.
namespace ricochet {

/// Throws Error(usage) if --quantity, --exact or --compare name a column of history.csv or an entry of summary.json
/// that no run of the study will have, and suggests the one that was probably meant. Columns of probes are known only
/// with the mesh: the model of one run is built for them, unless meshes or probes vary. Errors that cannot be detected
/// in advance appear in the table.
void check_requested_columns(const Study& study);

}  // namespace ricochet
