#include "ricochet/fem/pack_kernels.hpp"

#include "ricochet/fem/element_matrices.hpp"
#include "ricochet/fem/node_packs.hpp"
#include "ricochet/fem/path_kernels.hpp"
#include "ricochet/fem/symmetric_tensor.hpp"

namespace ricochet {

namespace {

/// Matrix at a point, row by row.
template <int d, int W>
struct PackMatrix {
  Pack<W> entry[d][d];
};
template <int d, int W>
RICOCHET_PART_OF_CALLER PackMatrix<d, W> load_matrix(const double* from) {
  PackMatrix<d, W> result;
  for (int i = 0; i < d; ++i) {
    for (int j = 0; j < d; ++j) result.entry[i][j] = load<W>(from + (i * d + j) * W);
  }
  return result;
}

/// A B.
template <int d, int W>
RICOCHET_PART_OF_CALLER PackMatrix<d, W> product(const PackMatrix<d, W>& a, const PackMatrix<d, W>& b) {
  PackMatrix<d, W> result;
  for (int i = 0; i < d; ++i) {
    for (int j = 0; j < d; ++j) {
      result.entry[i][j] = a.entry[i][0] * b.entry[0][j];
      for (int k = 1; k < d; ++k) result.entry[i][j] += a.entry[i][k] * b.entry[k][j];
    }
  }
  return result;
}
/// A Bᵀ.
template <int d, int W>
RICOCHET_PART_OF_CALLER PackMatrix<d, W> product_transposed(const PackMatrix<d, W>& a, const PackMatrix<d, W>& b) {
  PackMatrix<d, W> result;
  for (int i = 0; i < d; ++i) {
    for (int j = 0; j < d; ++j) {
      result.entry[i][j] = a.entry[i][0] * b.entry[j][0];
      for (int k = 1; k < d; ++k) result.entry[i][j] += a.entry[i][k] * b.entry[j][k];
    }
  }
  return result;
}

/// Gradient of u in reference coordinates at a point; `reference`: gradients of the shape functions.
template <int d, int W>
RICOCHET_PART_OF_CALLER PackMatrix<d, W> reference_gradient(const Pack<W>* u, int nodes, const double* reference) {
  PackMatrix<d, W> result;
  for (int a = 0; a < d; ++a) {
    for (int k = 0; k < d; ++k) result.entry[a][k] = u[a] * reference[k];
  }
  for (int i = 1; i < nodes; ++i) {
    for (int a = 0; a < d; ++a) {
      for (int k = 0; k < d; ++k) result.entry[a][k] += u[i * d + a] * reference[i * d + k];
    }
  }
  return result;
}
template <int d, int W>
RICOCHET_PART_OF_CALLER PackMatrix<d, W> simplex_gradient(const Pack<W>* u) {
  PackMatrix<d, W> result;
  for (int a = 0; a < d; ++a) {
    for (int k = 0; k < d; ++k) result.entry[a][k] = u[(k + 1) * d + a] - u[a];
  }
  return result;
}

template <int d>
struct Gradients {
  const PackStrip<d>& strip;
  const double* numbers;
  double* result;

  template <int W>
  RICOCHET_PART_OF_CALLER void run() const {
    strip.block.is_linear_simplex() ? of_cells<W, true>() : of_cells<W, false>();
  }
  template <int W, bool linear_simplex>
  RICOCHET_PART_OF_CALLER void of_cells() const {
    const KernelBlock<d>& block = strip.block;
    const int nodes = linear_simplex ? d + 1 : block.nodes;
    double* to = result;
    Pack<W> u[linear_simplex ? (d + 1) * d : most_cell_nodes * d];
    for (Index pack = strip.begin; pack < strip.end; ++pack) {
      read_nodes<d, W>(numbers, strip.slots + pack * nodes * W, nodes, u);
      for (int q = 0; q < block.points; ++q, to += gradient_components<d> * W) {
        const PackMatrix<d, W> reference =
            linear_simplex ? simplex_gradient<d, W>(u)
                           : reference_gradient<d, W>(u, nodes, block.gradients.data() + q * nodes * d);
        const PackMatrix<d, W> own = product(reference, load_matrix<d, W>(block.inverse_of_pack(pack, q)));
        for (int i = 0; i < d * d; ++i) store<W>(to + i * W, own.entry[i / d][i % d]);
        if (d == 2) store<W>(to + 4 * W, block.is_axisymmetric() ? hoop<W>(block, u, pack, q) : Pack<W>{});
      }
    }
  }
  template <int W>
  RICOCHET_PART_OF_CALLER static Pack<W> hoop(const KernelBlock<d>& block, const Pack<W>* u, Index pack, int q) {
    const double* values = block.integration.displacement.values.col(q).data();
    Pack<W> sum{};
    for (int i = 0; i < block.nodes; ++i) sum += u[i * d] * values[i];
    return sum / load<W>(block.radius.data() + block.index(pack, q));
  }
};

/// Displacement gradient at a point of a pack, with its component zz in 2D.
template <int d, int W>
struct PointGradient {
  PackMatrix<d, W> matrix;
  Pack<W> zz;
  RICOCHET_PART_OF_CALLER explicit PointGradient(const double* from)
      : matrix(load_matrix<d, W>(from)), zz(d == 2 ? load<W>(from + 4 * W) : Pack<W>{}) {}
};
template <int d, int W>
using PackTensor = std::conditional_t<d == 2, PlaneTensor<Pack<W>>, SpaceTensor<Pack<W>>>;

/// Builds a symmetric tensor from entry(i, j) for the components within d dimensions.
template <int d, int W, class Entry>
RICOCHET_PART_OF_CALLER PackTensor<d, W> symmetric(const Entry& entry, const Pack<W>& zz) {
  if constexpr (d == 2) {
    return {entry(0, 0), entry(1, 1), zz, entry(0, 1)};
  } else {
    return {entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(1, 2), entry(0, 2)};
  }
}

/// Column i of A times column j of B.
template <int d, int W>
RICOCHET_PART_OF_CALLER Pack<W> column_product(const PackMatrix<d, W>& a, int i, const PackMatrix<d, W>& b, int j) {
  Pack<W> sum = a.entry[0][i] * b.entry[0][j];
  for (int k = 1; k < d; ++k) sum += a.entry[k][i] * b.entry[k][j];
  return sum;
}

/// det(I + H).
template <int d, int W>
RICOCHET_PART_OF_CALLER Pack<W> volume_ratio(const PointGradient<d, W>& of) {
  const auto& h = of.matrix.entry;
  const Pack<W> a = 1.0 + h[0][0], b = 1.0 + h[1][1];
  if constexpr (d == 2) {
    return (a * b - h[0][1] * h[1][0]) * (1.0 + of.zz);
  } else {
    const Pack<W> c = 1.0 + h[2][2];
    return a * (b * c - h[1][2] * h[2][1]) - h[0][1] * (h[1][0] * c - h[1][2] * h[2][0]) +
           h[0][2] * (h[1][0] * h[2][1] - b * h[2][0]);
  }
}

template <int d>
struct Strains {
  Index points;
  bool is_linear;
  const double *gradients, *increments;
  double* result;
  bool* is_upright;

  template <int W>
  RICOCHET_PART_OF_CALLER void run() const {
    auto bad = Pack<W>{} > Pack<W>{};
    for (Index p = 0; p < points; ++p) {
      const PointGradient<d, W> at(gradients + p * gradient_components<d> * W);
      const auto& h = at.matrix;
      PackTensor<d, W> strain;
      if (is_linear) {
        strain = symmetric<d, W>(
            [&](int i, int j) RICOCHET_LAMBDA_OF_CALLER { return 0.5 * (h.entry[i][j] + h.entry[j][i]); }, at.zz);
      } else {
        bad |= !(volume_ratio(at) > 0.0);
        strain = symmetric<d, W>(
            [&](int i, int j) RICOCHET_LAMBDA_OF_CALLER {
              return 0.5 * (h.entry[i][j] + h.entry[j][i] + column_product(h, i, h, j));
            },
            at.zz + 0.5 * at.zz * at.zz);
      }
      if (increments != nullptr) add_change<W>(increments + p * gradient_components<d> * W, strain);
      store_tensor(result + p * strain_components<d> * W, strain);
    }
    *is_upright = !any_of(bad);
  }
  template <int W>
  RICOCHET_PART_OF_CALLER static void add_change(const double* increment, PackTensor<d, W>& strain) {
    const PointGradient<d, W> change(increment);
    const PackTensor<d, W> half = symmetric<d, W>(
        [&](int i, int j) RICOCHET_LAMBDA_OF_CALLER { return column_product(change.matrix, i, change.matrix, j); },
        change.zz * change.zz);
    strain = combination(Pack<W>{} + 1.0, strain, Pack<W>{} + 0.125, half, Pack<W>{});
  }
};

template <int d>
struct StrainChanges {
  Index points;
  const double *gradients, *increments;
  double* result;

  template <int W>
  RICOCHET_PART_OF_CALLER void run() const {
    for (Index p = 0; p < points; ++p) {
      PointGradient<d, W> f(gradients + p * gradient_components<d> * W);
      const PointGradient<d, W> change(increments + p * gradient_components<d> * W);
      for (int i = 0; i < d; ++i) f.matrix.entry[i][i] += 1.0;
      const PackTensor<d, W> of_strain = symmetric<d, W>(
          [&](int i, int j) RICOCHET_LAMBDA_OF_CALLER {
            return i == j ? column_product(f.matrix, i, change.matrix, i)
                          : 0.5 * (column_product(f.matrix, i, change.matrix, j) +
                                   column_product(f.matrix, j, change.matrix, i));
          },
          (1.0 + f.zz) * change.zz);
      store_tensor(result + p * strain_components<d> * W, of_strain);
    }
  }
};

/// Converts S to a matrix.
template <int W>
RICOCHET_PART_OF_CALLER PackMatrix<2, W> matrix_of(const PlaneTensor<Pack<W>>& s) {
  return {{{s.xx, s.xy}, {s.xy, s.yy}}};
}
template <int W>
RICOCHET_PART_OF_CALLER PackMatrix<3, W> matrix_of(const SpaceTensor<Pack<W>>& s) {
  return {{{s.xx, s.xy, s.zx}, {s.xy, s.yy, s.yz}, {s.zx, s.yz, s.zz}}};
}

template <int d>
struct Forces {
  const PackStrip<d>& strip;
  bool is_linear;
  const double *gradients, *stresses;
  double* numbers;

  /// Returns w F S, and its component zz.
  template <int W>
  RICOCHET_PART_OF_CALLER PackMatrix<d, W> first_stress(Index point, const Pack<W>& weight, Pack<W>& zz) const {
    const auto stress = load_tensor<PackTensor<d, W>>(stresses + point * strain_components<d> * W);
    PackMatrix<d, W> s = matrix_of<W>(stress);
    for (auto& row : s.entry) {
      for (auto& each : row) each *= weight;
    }
    if (d == 2) zz = weight * stress.zz;
    if (is_linear) return s;
    PointGradient<d, W> f(gradients + point * gradient_components<d> * W);
    for (int i = 0; i < d; ++i) f.matrix.entry[i][i] += 1.0;
    if (d == 2) zz *= 1.0 + f.zz;
    return product(f.matrix, s);
  }
  template <int W>
  RICOCHET_PART_OF_CALLER void run() const {
    strip.block.is_linear_simplex() ? of_cells<W, true>() : of_cells<W, false>();
  }
  template <int W, bool linear_simplex>
  RICOCHET_PART_OF_CALLER void of_cells() const {
    const KernelBlock<d>& block = strip.block;
    const int nodes = linear_simplex ? d + 1 : block.nodes;
    Pack<W> force[linear_simplex ? (d + 1) * d : most_cell_nodes * d];
    Index point = 0;
    for (Index pack = strip.begin; pack < strip.end; ++pack) {
      for (int i = 0; i < nodes * d; ++i) force[i] = Pack<W>{};
      for (int q = 0; q < block.points; ++q, ++point) {
        Pack<W> zz;
        const PackMatrix<d, W> first = first_stress<W>(point, load<W>(block.weight.data() + block.index(pack, q)), zz);
        const PackMatrix<d, W> reference = product_transposed(first, load_matrix<d, W>(block.inverse_of_pack(pack, q)));
        linear_simplex ? add_of_simplex<W>(reference, force)
                       : add<W>(reference, nodes, block.gradients.data() + q * nodes * d, force);
        if (d == 2 && block.is_axisymmetric()) add_hoop<W>(block, zz, pack, q, force);
      }
      add_nodes<d, W>(force, strip.slots + pack * nodes * W, nodes, numbers);
    }
  }
  template <int W>
  RICOCHET_PART_OF_CALLER static void add(const PackMatrix<d, W>& p, int nodes, const double* reference,
                                          Pack<W>* force) {
    for (int i = 0; i < nodes; ++i) {
      for (int a = 0; a < d; ++a) {
        for (int k = 0; k < d; ++k) force[i * d + a] += p.entry[a][k] * reference[i * d + k];
      }
    }
  }
  template <int W>
  RICOCHET_PART_OF_CALLER static void add_of_simplex(const PackMatrix<d, W>& p, Pack<W>* force) {
    for (int a = 0; a < d; ++a) {
      for (int k = 0; k < d; ++k) {
        force[(k + 1) * d + a] += p.entry[a][k];
        force[a] -= p.entry[a][k];
      }
    }
  }
  template <int W>
  RICOCHET_PART_OF_CALLER static void add_hoop(const KernelBlock<d>& block, const Pack<W>& zz, Index pack, int q,
                                               Pack<W>* force) {
    const double* values = block.integration.displacement.values.col(q).data();
    const Pack<W> per_radius = zz / load<W>(block.radius.data() + block.index(pack, q));
    for (int i = 0; i < block.nodes; ++i) force[i * d] += per_radius * values[i];
  }
};

}  // namespace

template <int d>
void find_gradients(const PackStrip<d>& strip, const double* numbers, double* gradients) {
  run_in_packs(Gradients<d>{strip, numbers, gradients});
}

template <int d>
bool find_strains(Index points, bool is_linear, const double* gradients, const double* increments, double* strains) {
  bool is_upright = true;
  run_in_packs(Strains<d>{points, is_linear, gradients, increments, strains, &is_upright});
  return is_upright;
}

template <int d>
void find_strain_changes(Index points, const double* gradients, const double* increments, double* changes) {
  run_in_packs(StrainChanges<d>{points, gradients, increments, changes});
}

template <int d>
void add_forces(const PackStrip<d>& strip, bool is_linear, const double* gradients, const double* stresses,
                double* numbers) {
  run_in_packs(Forces<d>{strip, is_linear, gradients, stresses, numbers});
}

template void find_gradients<2>(const PackStrip<2>&, const double*, double*);
template void find_gradients<3>(const PackStrip<3>&, const double*, double*);
template bool find_strains<2>(Index, bool, const double*, const double*, double*);
template bool find_strains<3>(Index, bool, const double*, const double*, double*);
template void find_strain_changes<2>(Index, const double*, const double*, double*);
template void find_strain_changes<3>(Index, const double*, const double*, double*);
template void add_forces<2>(const PackStrip<2>&, bool, const double*, const double*, double*);
template void add_forces<3>(const PackStrip<3>&, bool, const double*, const double*, double*);

}  // namespace ricochet
