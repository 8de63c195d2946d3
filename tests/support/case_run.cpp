#include "support/case_run.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <stdexcept>

#include "ricochet/base/log.hpp"
#include "ricochet/base/temporary_folder.hpp"
#include "support/paths.hpp"

namespace ricochet::test_support {

std::string write_temporary(const std::string& name, const std::string& text) {
  // Belongs to this process alone: other tests run simultaneously, and so may the same one, of another build or under
  // another name of CTest.
  static const TemporaryFolder own(::testing::TempDir(), "ricochet-test");
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  std::string folder = "outside_of_tests";
  if (test != nullptr) folder = std::string(test->test_suite_name()) + "_" + test->name();
  for (char& c : folder) c = c == '/' ? '_' : c;
  const std::filesystem::path directory = own.path() / folder;
  std::filesystem::create_directories(directory);
  std::ofstream file(directory / name, std::ios::binary);
  if (!(file << text).flush()) throw std::runtime_error("cannot write " + (directory / name).string());
  return (directory / name).string();
}

std::string mesh_geometry(const std::string& name, const std::string& geometry, double size, int order) {
  const std::string text = "SetFactory(\"OpenCASCADE\");\nMesh.MeshSizeMin = " + std::to_string(size) +
                           ";\nMesh.MeshSizeMax = " + std::to_string(size) + ";\n" + geometry + "\n";
  // Simultaneous tests request the same meshes: each is made once, and appears complete.
  const std::string key = text + "order " + std::to_string(order);
  const std::filesystem::path directory = meshes_directory();
  const std::filesystem::path made = directory / (name + "_" + std::to_string(std::hash<std::string>()(key)) + ".msh");
  if (std::filesystem::exists(made)) return made.string();
  const std::string source = write_temporary(name + ".geo", text);
  const std::string result = std::filesystem::path(source).replace_extension(".msh").string();
  const std::string command =
      "gmsh '" + source + "' -3 -nt 1 -v 1 -format msh41 -order " + std::to_string(order) + " -o '" + result + "'";
  if (std::system(command.c_str()) != 0) throw std::runtime_error("gmsh failed: " + command);
  std::filesystem::create_directories(directory);
  const std::filesystem::path copy = made.string() + "." + std::to_string(::getpid());
  std::filesystem::copy_file(result, copy, std::filesystem::copy_options::overwrite_existing);
  std::filesystem::rename(copy, made);
  return made.string();
}

CaseRun::CaseRun(const std::string& toml, const std::vector<std::string>& overrides) {
  log::set_level(log::Level::error);
  session_ = std::make_unique<Session>(write_temporary("case.toml", toml), overrides);
  session_->start();
}

void CaseRun::run(const std::function<void()>& each, bool with_start) {
  if (with_start) each();
  session_->run(each);
}

double total_energy(const SemidiscreteProblem& problem, const Vector& displacement, const Vector& velocity) {
  Vector internal;
  problem.internal_force->evaluate(displacement, internal);
  return 0.5 * problem.mass.quadratic_form(velocity) + 0.5 * displacement.dot(internal) -
         problem.loads.constant().dot(displacement);
}

double size_of_energy_terms(const SemidiscreteProblem& problem, const Vector& displacement, const Vector& velocity) {
  const Vector u = displacement.cwiseAbs();
  const Vector v = velocity.cwiseAbs();
  return u.dot(problem.internal_force->tangent().cwiseAbs() * u) + v.dot(problem.mass.to_sparse().cwiseAbs() * v) +
         u.dot(problem.loads.constant().cwiseAbs());
}

StepEnd::StepEnd(const CaseRun& run)
    : displacement(run.state().displacement),
      velocity(run.state().velocity),
      acceleration(run.state().acceleration),
      normal(run.state().forces.normal_reaction),
      tangential(run.state().forces.tangential_reaction),
      energy(total_energy(run.problem(), displacement, velocity)),
      size_of_energy_terms(test_support::size_of_energy_terms(run.problem(), displacement, velocity)) {
  run.problem().gaps(displacement, run.state().time, gap);
}

}  // namespace ricochet::test_support
