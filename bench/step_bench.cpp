#include <benchmark/benchmark.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>

#include "ricochet/base/log.hpp"
#include "ricochet/base/timer.hpp"
#include "ricochet/case/model.hpp"
#include "ricochet/case/read_case.hpp"
#include "ricochet/linear_algebra/sparse_cholesky.hpp"
#include "ricochet/simulation/simulation.hpp"

// What a time step costs, as a multiple of the plain triangular solve with the same matrix (METIS order, no dof last):
// the limit that a step with contact should approach. Ratios within one run: machines are noisy.

namespace {

using namespace ricochet;

/// A square or cubic block of `n` cells per side that rests on the floor, cut into triangles or tetrahedra.
std::string block_mesh(int dimension, int n) {
  const std::filesystem::path path = std::filesystem::temp_directory_path() /
                                     ("ricochet_bench_" + std::to_string(dimension) + "_" + std::to_string(n) + ".msh");
  std::ofstream out(path);
  const bool flat = dimension == 2;
  const int layers = flat ? 0 : n;
  const auto node = [&](int i, int j, int k) { return 1 + i + (n + 1) * (j + (n + 1) * k); };
  out << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n"
      << dimension - 1 << " 1 \"bottom\"\n"
      << dimension << " 2 \"body\"\n$EndPhysicalNames\n$Nodes\n"
      << (n + 1) * (n + 1) * (layers + 1) << "\n";
  for (int k = 0; k <= layers; ++k) {
    for (int j = 0; j <= n; ++j) {
      for (int i = 0; i <= n; ++i)
        out << node(i, j, k) << " " << double(i) / n << " " << double(j) / n << " " << double(k) / n << "\n";
    }
  }
  std::ostringstream cells;
  int count = 0;
  const auto add = [&](int type, int group, std::initializer_list<int> nodes) {
    cells << ++count << ' ' << type << " 2 " << group << " 1";
    for (const int i : nodes) cells << ' ' << i;
    cells << '\n';
  };
  if (flat) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        const int a = node(i, j, 0), b = node(i + 1, j, 0), c = node(i + 1, j + 1, 0), d = node(i, j + 1, 0);
        if (j == 0) add(1, 1, {a, b});
        add(2, 2, {a, b, c});
        add(2, 2, {a, c, d});
      }
    }
  } else {
    for (int k = 0; k < n; ++k) {
      for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
          int v[8];
          for (int b = 0; b < 8; ++b) v[b] = node(i + (b & 1), j + (b >> 1 & 1), k + (b >> 2));
          // Kuhn's six tetrahedra around the diagonal; the contact face is y = 0.
          const int paths[6][2] = {{1, 3}, {3, 2}, {2, 6}, {6, 4}, {4, 5}, {5, 1}};
          for (const auto& p : paths) add(4, 2, {v[0], v[p[0]], v[p[1]], v[7]});
          if (j == 0) {
            add(2, 1, {v[0], v[1], v[5]});
            add(2, 1, {v[0], v[5], v[4]});
          }
        }
      }
    }
  }
  out << "$EndNodes\n$Elements\n" << count << "\n" << cells.str() << "$EndElements\n";
  return path.string();
}

struct Bench {
  Case input;
  std::unique_ptr<Model> model;
  std::unique_ptr<Scheme> scheme;
  std::unique_ptr<Simulation> simulation;
};

/// A block that falls onto the floor at once, so that contact is active in the steps measured, sliding at first.
std::unique_ptr<Bench> make_bench(int dimension, int n, double friction = 0.0) {
  log::set_level(log::Level::error);
  auto bench = std::make_unique<Bench>();
  const std::string zero = dimension == 3 ? ", 0.0]" : "]";
  const std::filesystem::path path = std::filesystem::temp_directory_path() / "ricochet_bench.toml";
  std::ofstream(path) << "[mesh]\nfile = \"" << block_mesh(dimension, n)
                      << "\"\n[[material]]\ngroup = \"body\"\ndensity = 1.0\nlambda = 1e4\nmu = 5e3\n"
                      << "[obstacle.floor]\ntype = \"plane\"\npoint = [0.0, 0.0" << zero << "\nnormal = [0.0, 1.0"
                      << zero << "\n[[contact]]\ngroup = \"bottom\"\nobstacle = \"floor\"\nfriction = " << friction
                      << "\n[initial]\nvelocity = [0.2, -1.0" << zero
                      << "\n[time]\nscheme = \"newmark\"\npreset = \"trapezoidal\"\nstep = 1e-4\nend = 1.0\n";
  bench->input = read_case(path.string());
  bench->model = build_model(bench->input);
  bench->scheme = make_scheme({"newmark", 1e-4, 0.25, 0.5});
  bench->simulation = std::make_unique<Simulation>(bench->model->problem, *bench->scheme, bench->model->initial);
  return bench;
}

/// Seconds of one plain solve with the scheme's operator.
double plain_solve_seconds(const Bench& bench) {
  const OperatorCoefficients a = bench.scheme->operators(bench.model->problem).front();
  const SparseMatrix matrix =
      a.stiffness * bench.model->problem.internal_force->tangent() + a.mass * bench.model->problem.mass;
  SparseCholesky factor(matrix);
  Vector b = Vector::Ones(matrix.cols()), y, x;
  double best = 1e30;
  for (int k = 0; k < 7; ++k) {
    Timer timer;
    factor.forward(b, y);
    factor.backward(y, x);
    best = std::min(best, timer.seconds());
  }
  return best;
}

void step(benchmark::State& state, int dimension) {
  const auto bench = make_bench(dimension, static_cast<int>(state.range(0)), 0.1 * static_cast<double>(state.range(1)));
  const double solve = plain_solve_seconds(*bench);
  bench->simulation->advance();
  double seconds = 0.0;
  for (auto _ : state) {
    Timer timer;
    bench->simulation->advance();
    seconds += timer.seconds();
  }
  const double per_step = seconds / static_cast<double>(state.iterations());
  state.counters["dofs"] = static_cast<double>(bench->model->problem.dof_count());
  state.counters["contact_points"] = static_cast<double>(bench->model->problem.contact.size());
  state.counters["active"] =
      static_cast<double>((bench->simulation->state().forces.normal_reaction.array() > 0.0).count());
  long sticking = 0, slipping = 0;
  for (const ContactStatus status : bench->simulation->state().contact_status) {
    sticking += status == ContactStatus::stick ? 1 : 0;
    slipping += status == ContactStatus::slip ? 1 : 0;
  }
  state.counters["sticking"] = static_cast<double>(sticking);
  state.counters["slipping"] = static_cast<double>(slipping);
  state.counters["plain_solve_ms"] = 1e3 * solve;
  state.counters["step_over_solve"] = per_step / solve;
}

void step_2d(benchmark::State& state) {
  step(state, 2);
}
void step_3d(benchmark::State& state) {
  step(state, 3);
}

void assemble(benchmark::State& state) {
  const auto bench = make_bench(3, static_cast<int>(state.range(0)));
  const NodeGraph graph = node_graph(bench->model->space);
  for (auto _ : state) benchmark::DoNotOptimize(assemble_stiffness(bench->model->body, graph).valuePtr());
  state.counters["cells_per_second"] = benchmark::Counter(static_cast<double>(bench->model->mesh.cell_count()),
                                                          benchmark::Counter::kIsIterationInvariantRate);
}

}  // namespace

// Cells per side, and ten times the coefficient of friction.
BENCHMARK(step_2d)->ArgsProduct({{30, 100, 190}, {0, 3}})->Unit(benchmark::kMillisecond);
BENCHMARK(step_3d)->ArgsProduct({{8, 15}, {0, 3}})->Unit(benchmark::kMillisecond);
BENCHMARK(assemble)->Arg(20)->Unit(benchmark::kMillisecond);

BENCHMARK_MAIN();
