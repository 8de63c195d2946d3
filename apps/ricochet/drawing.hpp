#pragma once

#include <string>

/// @file Figures, drawn by Python.
namespace ricochet::program {

/// Draws what describe_figure or describe_study_figure has described, as "svg", "pdf" or "png", into a file. Throws
/// Error(file_access) where Python or its matplotlib is missing, or the file cannot be written.
void draw_figure(const std::string& description, const std::string& format, const std::string& output);

}  // namespace ricochet::program
