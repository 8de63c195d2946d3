#include "ricochet/distributed/petsc_preconditioner.hpp"

#include <fmt/format.h>
#include <petscpc.h>

#include <sstream>

#include "ricochet/base/error.hpp"
#include "ricochet/distributed/petsc_session.hpp"

namespace ricochet {

namespace {

/// Numbering of PETSc: the nodes of a rank follow one another, rank after rank.
struct Numbering {
  std::vector<Index> own;         ///< nodes that this rank owns
  std::vector<PetscInt> of_node;  ///< per node of this rank
};

Numbering number_nodes(Index count, int d, const Ranks& ranks) {
  Numbering result;
  for (Index node = 0; node < count; ++node) {
    if (ranks.is_owned(node)) result.own.push_back(node);
  }
  const auto own = double(result.own.size());
  const Ranks::ForEach<double> counts = ranks.all_gather({own});
  double next = 0.0;
  for (int rank = 0; rank < ranks.rank(); ++rank) next += counts[std::size_t(rank)].front();
  // The owner of a node sends its number to the other ranks.
  Vector numbers = Vector::Zero(count * d);
  for (const Index node : result.own) numbers[node * d] = next++;
  ranks.accumulate(numbers);
  for (Index node = 0; node < count; ++node) result.of_node.push_back(static_cast<PetscInt>(numbers[node * d]));
  return result;
}

/// Entries of this rank's part, for MatSetPreallocationCOO: rows and columns of the dofs that are solved for, and on
/// the diagonals of the others a small fraction of the largest diagonal entry of all. The coarse spaces include these
/// dofs, which should hardly affect them, in any units.
struct Entries {
  std::vector<PetscInt> row, column;
  std::vector<PetscScalar> value;
  void add(PetscInt i, PetscInt j, double v) {
    row.push_back(i);
    column.push_back(j);
    value.push_back(v);
  }
};

class PetscPreconditioner final : public Preconditioner {
 public:
  PetscPreconditioner(const std::string& name, const SparseMatrix& part, const std::vector<char>& solved,
                      const Points& nodes, const Ranks& ranks)
      : ranks_(ranks), d_(int(nodes.rows())), numbering_(number_nodes(nodes.cols(), d_, ranks)) {
    for (Index dof = 0; dof < part.cols(); ++dof) {
      if (solved[std::size_t(dof)] == 0) unsolved_.push_back(dof);
    }
    const std::string& options = preconditioner_registry().find(name).type.petsc_options;
    check(set_up(options, entries_of(part, solved), nodes), name);
  }
  ~PetscPreconditioner() override {
    PCDestroy(&preconditioner_);
    MatDestroy(&matrix_);
    VecDestroy(&residual_);
    VecDestroy(&correction_);
  }
  PetscPreconditioner(const PetscPreconditioner&) = delete;
  PetscPreconditioner& operator=(const PetscPreconditioner&) = delete;

  void apply(const Vector& r, Vector& z) const override {
    z.setZero(r.size());
    check(apply_to_own(r, z), "preconditioner");
    ranks_.accumulate(z);
    // Coarse corrections also change dofs that are not solved for. Overwriting these keeps the operator symmetric.
    for (const Index dof : unsolved_) z[dof] = r[dof];
  }

 private:
  static void check(PetscErrorCode code, const std::string& what) {
    if (code != 0) throw Error(ErrorKind::invalid_input, fmt::format("PETSc, {}: {}", what, petsc_message(code)));
  }

  [[nodiscard]] PetscInt number_of(Index dof) const {
    return numbering_.of_node[std::size_t(dof / d_)] * d_ + static_cast<PetscInt>(dof % d_);
  }

  [[nodiscard]] Entries entries_of(const SparseMatrix& part, const std::vector<char>& solved) const {
    Entries entries;
    constexpr double small = 1e-4;
    const double shift = small * ranks_.maximum(part.cols() > 0 ? part.diagonal().maxCoeff() : 0.0);
    for (Index column = 0; column < part.cols(); ++column) {
      if (solved[std::size_t(column)] == 0) {
        if (ranks_.is_owned(column / d_)) entries.add(number_of(column), number_of(column), shift);
        continue;
      }
      for (SparseMatrix::InnerIterator entry(part, column); entry; ++entry) {
        if (solved[std::size_t(entry.row())] != 0)
          entries.add(number_of(entry.row()), number_of(column), entry.value());
      }
    }
    return entries;
  }

  PetscErrorCode set_up(const std::string& options, Entries entries, const Points& nodes) {
    PetscFunctionBeginUser;
    const auto own = static_cast<PetscInt>(numbering_.own.size()) * d_;
    PetscCall(MatCreate(PETSC_COMM_WORLD, &matrix_));
    PetscCall(MatSetSizes(matrix_, own, own, PETSC_DETERMINE, PETSC_DETERMINE));
    PetscCall(MatSetType(matrix_, MATAIJ));
    PetscCall(MatSetBlockSize(matrix_, d_));
    PetscCall(MatSetPreallocationCOO(matrix_, static_cast<PetscCount>(entries.value.size()), entries.row.data(),
                                     entries.column.data()));
    PetscCall(MatSetValuesCOO(matrix_, entries.value.data(), INSERT_VALUES));
    entries = {};
    PetscCall(MatSetOption(matrix_, MAT_SPD, PETSC_TRUE));
    PetscCall(MatCreateVecs(matrix_, &residual_, &correction_));
    PetscCall(set_rigid_motions(nodes));
    PetscCall(PCCreate(PETSC_COMM_WORLD, &preconditioner_));
    PetscCall(PCSetOptionsPrefix(preconditioner_, "ricochet_"));
    PetscCall(PCSetOperators(preconditioner_, matrix_, matrix_));
    PetscCall(set_from_options(options));
    PetscCall(PCSetUp(preconditioner_));
    PCFailedReason failed = PC_NOERROR;
    PetscCall(PCGetFailedReason(preconditioner_, &failed));
    PetscFunctionReturn(failed == PC_NOERROR ? 0 : PETSC_ERR_MAT_CH_ZRPVT);
  }

  /// Options of the user take precedence over these: names and values in turn, without the prefix.
  PetscErrorCode set_from_options(const std::string& options) {
    PetscFunctionBeginUser;
    std::istringstream words(options);
    // Cleared also after an error: another preconditioner would take them for options of the user.
    struct AddedOptions {
      std::vector<std::string> names;
      ~AddedOptions() {
        for (const std::string& name : names) (void)PetscOptionsClearValue(nullptr, name.c_str());
      }
    } added;
    for (std::string name, value; words >> name >> value;) {
      const std::string option = "-ricochet_" + name.substr(1);
      PetscBool is_set = PETSC_FALSE;
      PetscCall(PetscOptionsHasName(nullptr, nullptr, option.c_str(), &is_set));
      if (is_set == PETSC_TRUE) continue;
      PetscCall(PetscOptionsSetValue(nullptr, option.c_str(), value.c_str()));
      added.names.push_back(option);
    }
    PetscCall(PCSetFromOptions(preconditioner_));
    PetscFunctionReturn(0);
  }

  PetscErrorCode set_rigid_motions(const Points& nodes) {
    PetscFunctionBeginUser;
    Vec coordinates = nullptr;
    PetscCall(VecDuplicate(residual_, &coordinates));
    PetscCall(VecSetBlockSize(coordinates, d_));
    PetscScalar* values = nullptr;
    PetscCall(VecGetArray(coordinates, &values));
    for (const Index node : numbering_.own) {
      for (int k = 0; k < d_; ++k) *values++ = nodes(k, node);
    }
    PetscCall(VecRestoreArray(coordinates, &values));
    MatNullSpace motions = nullptr;
    PetscCall(MatNullSpaceCreateRigidBody(coordinates, &motions));
    PetscCall(MatSetNearNullSpace(matrix_, motions));
    PetscCall(MatNullSpaceDestroy(&motions));
    PetscCall(VecDestroy(&coordinates));
    PetscFunctionReturn(0);
  }

  PetscErrorCode apply_to_own(const Vector& r, Vector& z) const {
    PetscFunctionBeginUser;
    PetscScalar* values = nullptr;
    PetscCall(VecGetArrayWrite(residual_, &values));
    for (const Index node : numbering_.own) {
      for (Index dof = node * d_; dof < (node + 1) * d_; ++dof) *values++ = r[dof];
    }
    PetscCall(VecRestoreArrayWrite(residual_, &values));
    PetscCall(PCApply(preconditioner_, residual_, correction_));
    const PetscScalar* found = nullptr;
    PetscCall(VecGetArrayRead(correction_, &found));
    for (const Index node : numbering_.own) {
      for (Index dof = node * d_; dof < (node + 1) * d_; ++dof) z[dof] = *found++;
    }
    PetscCall(VecRestoreArrayRead(correction_, &found));
    PetscFunctionReturn(0);
  }

  PetscSession petsc_;
  const Ranks& ranks_;
  int d_;
  Numbering numbering_;
  std::vector<Index> unsolved_;  ///< dofs
  Mat matrix_ = nullptr;
  PC preconditioner_ = nullptr;
  Vec residual_ = nullptr, correction_ = nullptr;  ///< on own dofs
};

class PetscPreconditioners final : public PreconditionerFactory {
 public:
  [[nodiscard]] std::unique_ptr<Preconditioner> make(const std::string& name, const SparseMatrix& part,
                                                     const std::vector<char>& solved, const Points& nodes,
                                                     const Ranks& ranks) const override {
    return std::make_unique<PetscPreconditioner>(name, part, solved, nodes, ranks);
  }

 private:
  PetscSession petsc_;
};

}  // namespace

std::shared_ptr<const PreconditionerFactory> make_petsc_preconditioners() {
  return std::make_shared<const PetscPreconditioners>();
}

}  // namespace ricochet
