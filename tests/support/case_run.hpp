#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "ricochet/run/session.hpp"

/// @file Running cases inside a test.
namespace ricochet::test_support {

/// Writes text to a file of this name in a temporary directory of this test and this process, and returns its path.
std::string write_temporary(const std::string& name, const std::string& text);

/// Meshes a Gmsh geometry (OpenCASCADE kernel) and returns the path of the .msh file.
std::string mesh_geometry(const std::string& name, const std::string& geometry, double size, int order);

/// A started session whose case is given as text.
class CaseRun {
 public:
  /// Reads the text of a case file, with overrides.
  explicit CaseRun(const std::string& toml, const std::vector<std::string>& overrides = {});

  [[nodiscard]] Session& session() const { return *session_; }
  [[nodiscard]] const Case& input() const { return session_->input(); }
  [[nodiscard]] const Model& model() const { return session_->model(); }
  [[nodiscard]] const SemidiscreteProblem& problem() const { return session_->problem(); }
  [[nodiscard]] Scheme& scheme() { return session_->scheme(); }
  [[nodiscard]] Simulation& simulation() { return session_->simulation(); }
  [[nodiscard]] const State& state() const { return session_->state(); }
  [[nodiscard]] long steps() const { return session_->steps(); }

  /// Runs to the end, calling `each` after every step (and once before the first if `with_start`).
  void run(const std::function<void()>& each, bool with_start = true);

 private:
  std::unique_ptr<Session> session_;
};

/// Returns J(U, V) = ½VᵀMV + ½UᵀKU − LᵀU with the constant loads, computed independently of the energy account.
double total_energy(const SemidiscreteProblem& problem, const Vector& displacement, const Vector& velocity);

/// Returns the size of the terms whose sum is that energy, relative to which it is rounded. A body displaced by u as a
/// whole has only the elastic energy of its strain, but ½uᵀKu sums terms of the size of |u|ᵀ|K||u|.
double size_of_energy_terms(const SemidiscreteProblem& problem, const Vector& displacement, const Vector& velocity);

/// All data that an identity needs at one end of a step.
struct StepEnd {
  Vector displacement, velocity, acceleration, gap, normal, tangential;  ///< gaps and reactions per contact point
  double energy = 0.0;
  double size_of_energy_terms = 0.0;

  explicit StepEnd(const CaseRun& run);
};

}  // namespace ricochet::test_support
