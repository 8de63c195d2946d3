#pragma once

#include <string>
#include <vector>

#include "ricochet/io/summary.hpp"
#include "ricochet/model/model.hpp"

/// @file Texts that the program prints, a section for each NAME_text.cpp.
namespace ricochet::program {

// Numbers as the program prints them.

/// Returns 0 if the value does not exceed the rounding of numbers of that size.
[[nodiscard]] double without_rounding(double value, double size);
/// Returns "1.2 %" for 0.012.
[[nodiscard]] std::string percent(double part);
/// Returns a text such as "(1, 0.5)" with so many digits per component; components below the rounding of the vector, or
/// of a given larger size, are 0.
[[nodiscard]] std::string vector_text(const Vector& values, double size = 0.0, int digits = 4);

// Position of a mesh at the start of a run.

/// Returns "is 0.1 away from", "touches" or "is 0.1 inside", to precede the obstacle's name. Gaps up to the rounding
/// count as zero.
[[nodiscard]] std::string gap_text(double gap, double rounding);
/// Returns how the mesh of a file was placed: ", scaled by 2, rotated by 30°, moved".
[[nodiscard]] std::string placement_text(const BodyFile& mesh);
/// Prints the bounding box of the mesh after scaling, turning and moving, and a line per obstacle with its distance
/// from the nearest node at the start.
void print_position(const Case& input, const Model& model);

// Output about contacts and friction.

/// Prints one line per [[contact]]: groups, law of friction, multipliers, motion of the obstacle.
void print_contacts(const std::vector<ContactDescription>& contacts);
/// Returns a text such as "\"two.left\" carries the multipliers: its mesh is finer (0.02 against 0.03); 4 contact
/// points, …".
[[nodiscard]] std::string facing_text(const PairingDescription& facing);
/// Prints the works of friction and of moving obstacles, and the largest numbers of sticking and slipping points;
/// nothing if there was neither friction nor motion.
void print_friction(const RunSummary& summary);

// Output of `ricochet info` that is not written in meshes and cases: sizes, positions, times.

/// Prints a line per group of cells or facets, including built-in groups: size, position, and the direction of facets.
void print_groups(const Mesh& mesh, bool axisymmetric = false);
/// Prints the smallest heights of all cells.
void print_cell_sizes(const Mesh& mesh);
/// Prints position, masses, wave speeds, travel times of waves, a suggested step, and the times when bodies meet
/// obstacles.
void print_advice(const Case& input, const Model& model);
/// Prints a line for each contact between bodies: the group that carries the multipliers, how much of it faces the
/// other group, and when the bodies would meet.
void print_facings(const Case& input, const Model& model);

// Runs in progress, interrupted or failed, in words.

/// Returns the suffix of the title of an incomplete run: " (running)", " (interrupted)", " (FAILED)".
[[nodiscard]] std::string status_text(const std::string& directory, const RunSummary& summary);
/// Returns the total energy at both ends of a run, which is 0 or negative where loads have a potential, and the energy
/// to which percentages refer.
[[nodiscard]] std::string energies_text(const RunSummary& summary);
/// Returns how well the energy account balances.
[[nodiscard]] std::string energy_account_text(const RunSummary& summary);
/// Prints the progress of a run, its speed, and the ways to continue it.
void print_progress(const std::string& directory, const RunSummary& summary);
/// Describes a checkpoint, or the state left by a failed step.
void describe_checkpoint(const std::string& path);
/// Prints the time of a step and of the run, and its memory.
void print_cost(const RunSummary& s);
/// Prints the iterations of a step and, for several processes, how they divide the body and how much they send.
void print_solver(const RunSummary& s);

// Energy gained or lost by the method in a run, and the reactions that acted.

/// Prints "the method lost 1.2 % of the largest energy (…); reactions: the mean over the step, in which those at its
/// end have the weight 0 to 0.33".
void print_method(const RunSummary& summary);
/// Returns the larger of the losses and gains for a table: "-1.2 %"; "0" if energy is kept up to rounding.
[[nodiscard]] std::string method_energy_mark(const RunSummary& summary);
/// Returns "the mean over the step, in which …" or "those at the end of the step"; empty if the scheme has no choice.
[[nodiscard]] std::string reactions_text(const RunSummary& summary);
/// Returns "150 steps of 0.01" or "71 steps of 0.001 to 0.016 (4 refused)".
[[nodiscard]] std::string steps_text(const RunSummary& summary);

// Interpenetration and rotation of a run, in words.

/// Returns the line(s) of `run` and `info`, each with the program's two leading spaces, without the last line break.
[[nodiscard]] std::string deformation_text(const RunSummary& summary);
/// Returns the entry of the table that compares runs, with ≥ if only contact points were examined.
[[nodiscard]] std::string deepest_penetration_text(const RunSummary& summary);

// Results of a run in words: its impacts, its largest stress, its probes, its expectations.

/// Prints a line for each of the first `most` impacts (0: of all), and one with the number of the others; or a line
/// stating that there was no contact if the case has some.
void print_impacts(const RunSummary& summary, std::size_t most);
/// Prints one line, including how many of the states were examined; nothing if none was.
void print_peak_stress(const RunSummary& summary);
/// Prints a line per probe: the distance of its node for a point, the number of nodes and their range for a segment; on
/// a contact boundary also the largest contact force.
void print_probes(const RunSummary& summary);
/// Returns "found 3.5", or the reason why nothing was found.
std::string found_text(const ExpectationResult& expectation);
/// Prints how many hold, those that do not, and whether some were left out; nothing if there are no entries.
void print_expectations(const std::vector<ExpectationResult>& expectations);

// Several runs side by side.

/// Prints the data that a reader needs to choose between runs, a row for each; then their results, with marks at
/// numbers that cannot be trusted and a line that explains each mark. Throws Error as read_summary.
void print_comparison(const std::vector<std::string>& directories);

}  // namespace ricochet::program
