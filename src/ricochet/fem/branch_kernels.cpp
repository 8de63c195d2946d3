#include "ricochet/fem/branch_kernels.hpp"

#include "ricochet/fem/node_packs.hpp"
#include "ricochet/fem/symmetric_tensor.hpp"

namespace ricochet {

namespace {

/// Deviators of the strains at a pack of points.
template <class T>
struct BranchStrains {
  T middle, start, end, at;
};

template <int d, int W>
struct BranchPack {
  using Number = Pack<W>;
  using Strain = std::conditional_t<d == 2, PlaneTensor<Number>, SpaceTensor<Number>>;
  const BranchPoints<d>& points;
  Index pack;
  int point;

  RICOCHET_PART_OF_CALLER Strain deviator_at(const double* strains) const {
    if (strains == nullptr) return Strain{};
    return deviator(load_tensor<Strain>(strains + (pack * points.points + point) * Strain::components * W));
  }
  RICOCHET_PART_OF_CALLER BranchStrains<Strain> strains() const {
    return {deviator_at(points.middle), deviator_at(points.start), deviator_at(points.end), deviator_at(points.at)};
  }
  /// Index of a branch of this point in the internal strains of a cell.
  [[nodiscard]] RICOCHET_PART_OF_CALLER std::size_t offset(std::size_t branch) const {
    return (std::size_t(point) * points.branches.size() + branch) * internal_components;
  }
  RICOCHET_PART_OF_CALLER Strain internal(std::size_t branch) const {
    const double* const* lanes = points.internal + pack * W;
    const std::size_t from = offset(branch);
    Pack<4> parts[2][8];  // of four cells each: six components and padding
    for (int k = 0; k < W / 4; ++k, lanes += 4) {
      Pack<4>* const own = parts[k];
      transpose(load<4>(lanes[0] + from), load<4>(lanes[1] + from), load<4>(lanes[2] + from), load<4>(lanes[3] + from),
                own[0], own[1], own[2], own[3]);
      if (d == 3) {
        const auto tail = [&](int lane) RICOCHET_LAMBDA_OF_CALLER {
          const Pack<2> two = load<2>(lanes[lane] + from + 4);
          return __builtin_shufflevector(two, two, 0, 1, 0, 1);
        };
        transpose(tail(0), tail(1), tail(2), tail(3), own[4], own[5], own[6], own[7]);
      }
    }
    Strain result;
    for_each_component(
        result, [&](int k, Number& component) RICOCHET_LAMBDA_OF_CALLER { component = joined<W>(&parts[0][k], 8); });
    return result;
  }
  RICOCHET_PART_OF_CALLER void write(const Strain& from, std::size_t branch, double* const* next) const {
    double* const* lanes = next + pack * W;
    const std::size_t to = offset(branch);
    Strain value = from;
    Number components[8] = {};
    for_each_component(value,
                       [&](int k, const Number& component) RICOCHET_LAMBDA_OF_CALLER { components[k] = component; });
    for (int k = 0; k < W / 4; ++k, lanes += 4) {
      Pack<4> heads[4], tails[4];
      transpose(quarter<W>(components[0], k), quarter<W>(components[1], k), quarter<W>(components[2], k),
                quarter<W>(components[3], k), heads[0], heads[1], heads[2], heads[3]);
      transpose(quarter<W>(components[4], k), quarter<W>(components[5], k), Pack<4>{}, Pack<4>{}, tails[0], tails[1],
                tails[2], tails[3]);
      for (int lane = 0; lane < 4; ++lane) {
        if (lanes[lane] == nullptr) continue;
        store<4>(lanes[lane] + to, heads[lane]);
        store<2>(lanes[lane] + to + 4, __builtin_shufflevector(tails[lane], tails[lane], 0, 1));
      }
    }
  }
};

/// Calls work(pack of points) for all points.
template <int W, int d, class Work>
RICOCHET_PART_OF_CALLER void for_each_pack(const BranchPoints<d>& points, const Work& work) {
  for (Index pack = 0; pack < points.packs; ++pack) {
    for (int point = 0; point < points.points; ++point) work(BranchPack<d, W>{points, pack, point});
  }
}

template <int d>
struct BranchStresses {
  BranchStress of;
  const BranchPoints<d>& points;
  double* result;

  template <class T>
  RICOCHET_PART_OF_CALLER T acting(const RelaxationRule& rule, const BranchStrains<T>& at, const T& own) const {
    if (of == BranchStress::mean) return rule.mean(at.middle, at.end, own);
    return at.end - rule.next(at.middle, at.end, own);
  }
  template <int W>
  RICOCHET_PART_OF_CALLER void run() const {
    using Strain = typename BranchPack<d, W>::Strain;
    for_each_pack<W>(points, [&](const BranchPack<d, W>& pack) RICOCHET_LAMBDA_OF_CALLER {
      const BranchStrains<Strain> at = pack.strains();
      Strain stress{};
      for (std::size_t b = 0; b < points.branches.size(); ++b) {
        const auto& [modulus, rule] = points.branches[b];
        stress = stress + 2.0 * modulus * acting(rule, at, pack.internal(b));
      }
      store_tensor(result + (pack.pack * points.points + pack.point) * Strain::components * W, stress);
    });
  }
};

template <int d>
struct BranchWorks {
  BranchWork of;
  const BranchPoints<d>& points;
  double* const* next;
  double* result;

  template <class T>
  RICOCHET_PART_OF_CALLER typename T::Number work(const RelaxationRule& rule, const BranchStrains<T>& at,
                                                  const T& own) const {
    if (of == BranchWork::dissipation) return rule.dissipation(at.start, at.middle, at.end, own);
    if (of == BranchWork::start_energy)
      return rule.start_energy(at.at, own, T(at.end - rule.next(at.middle, at.end, own)));
    const T elastic = at.at - own;
    return double_dot(elastic, elastic);
  }
  template <int W>
  RICOCHET_PART_OF_CALLER void run() const {
    using Strain = typename BranchPack<d, W>::Strain;
    for_each_pack<W>(points, [&](const BranchPack<d, W>& pack) RICOCHET_LAMBDA_OF_CALLER {
      const BranchStrains<Strain> at = pack.strains();
      Pack<W> sum{};
      for (std::size_t b = 0; b < points.branches.size(); ++b) {
        const auto& [modulus, rule] = points.branches[b];
        const Strain own = pack.internal(b);
        sum += modulus * work(rule, at, own);
        if (next != nullptr) pack.write(rule.next(at.middle, at.end, own), b, next);
      }
      store<W>(result + (pack.pack * points.points + pack.point) * W, sum);
    });
  }
};

template <int d>
struct BranchRelaxation {
  const BranchPoints<d>& points;
  double* const* next;

  template <int W>
  RICOCHET_PART_OF_CALLER void run() const {
    for_each_pack<W>(points, [&](const BranchPack<d, W>& pack) RICOCHET_LAMBDA_OF_CALLER {
      const auto strain = pack.deviator_at(points.at);
      for (std::size_t b = 0; b < points.branches.size(); ++b) pack.write(strain, b, next);
    });
  }
};

}  // namespace

template <int d>
void find_branch_stresses(BranchStress of, const BranchPoints<d>& points, double* stresses) {
  run_in_packs(BranchStresses<d>{of, points, stresses});
}
template <int d>
void find_branch_works(BranchWork of, const BranchPoints<d>& points, double* const* next, double* works) {
  run_in_packs(BranchWorks<d>{of, points, next, works});
}
template <int d>
void relax_branches(const BranchPoints<d>& points, double* const* next) {
  run_in_packs(BranchRelaxation<d>{points, next});
}

template void find_branch_stresses<2>(BranchStress, const BranchPoints<2>&, double*);
template void find_branch_stresses<3>(BranchStress, const BranchPoints<3>&, double*);
template void find_branch_works<2>(BranchWork, const BranchPoints<2>&, double* const*, double*);
template void find_branch_works<3>(BranchWork, const BranchPoints<3>&, double* const*, double*);
template void relax_branches<2>(const BranchPoints<2>&, double* const*);
template void relax_branches<3>(const BranchPoints<3>&, double* const*);

}  // namespace ricochet
