#pragma once

#include <string>

/// @file Figures, drawn by Python.
namespace ricochet::program {

/// Draws the result of describe_figure or describe_study_figure as "svg", "pdf" or "png" into a file. Throws
/// Error(file_access) if Python or its matplotlib is missing, or if the file cannot be written.
void draw_figure(const std::string& description, const std::string& format, const std::string& output);
/// Draws it, prints the name of the file and returns the exit status.
int write_figure(const std::string& description, const std::string& format, const std::string& output);

}  // namespace ricochet::program
