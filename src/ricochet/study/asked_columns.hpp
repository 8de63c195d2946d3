#pragma once

#include "ricochet/study/study_files.hpp"

/// @file What a study asks of its runs, before there are any.
namespace ricochet {

/// Throws Error(usage) where --quantity, --exact or --compare name a column of history.csv, or an entry of
/// summary.json, that no run of the study will have, with the one that was probably meant. Columns of probes are known
/// only with the mesh: one run's model is made for them, unless meshes or probes vary. What cannot be told before, the
/// table tells.
void check_asked_columns(const Study& study);

}  // namespace ricochet
