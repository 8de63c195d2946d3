#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <fstream>
#include <sstream>

#include "support/case_run.hpp"

// Results must not depend on the units, the orientation, the numbering or the observer.

namespace ricochet::test_support::invariances_test {

/// A case of a body above an oblique plane with transformable numbers.
struct Setting {
  int dimension = 2;
  std::string mesh;
  double scale = 1.0;  ///< of the mesh
  Eigen::Vector3d point{0.0, 0.0, 0.0}, normal{0.1, 1.0, 0.0}, gravity{0.3, -2.0, 0.0}, velocity{0.1, -0.8, 0.0},
      obstacle_velocity{0.0, 0.0, 0.0};
  double friction = 0.0, rotation_rate = 0.0;
  double density = 1.3, lambda = 30.0, mu = 20.0, step = 0.01, end = 1.0;
};

std::string vector_text(const Eigen::Vector3d& v, int dimension) {
  std::string text = fmt::format("{:.17e}, {:.17e}", v[0], v[1]);
  return "[" + text + (dimension == 3 ? fmt::format(", {:.17e}]", v[2]) : "]");
}

std::string case_text(const Setting& s, const std::string& time, const std::string& mass) {
  const int d = s.dimension;
  return fmt::format(
      "[mesh]\nfile = \"{}\"\nscale = {:.17e}\n[[material]]\ngroup = \"body\"\ndensity = {:.17e}\nlambda = {:.17e}\nmu "
      "= {:.17e}\n"
      "[obstacle.plane]\ntype = \"plane\"\npoint = {}\nnormal = {}\nvelocity = {}\nrotation_rate = {:.17e}\n"
      "[[contact]]\ngroup = \"contact\"\nobstacle = \"plane\"\nfriction = {:.17e}\n"
      "[load]\ngravity = {}\n[initial]\nvelocity = {}\n[mass]\ntype = \"{}\"\n[time]\n{}step = {:.17e}\nend = "
      "{:.17e}\n",
      s.mesh, s.scale, s.density, s.lambda, s.mu, vector_text(s.point, d), vector_text(s.normal, d),
      vector_text(s.obstacle_velocity, d), s.rotation_rate, s.friction, vector_text(s.gravity, d),
      vector_text(s.velocity, d), mass, time, s.step, s.end);
}

Setting setting(int dimension, double friction = 0.0) {
  Setting s;
  s.dimension = dimension;
  s.friction = friction;
  if (dimension == 2) {
    s.mesh = mesh_geometry(
        "disc", "Disk(1)={0,1.02,0,1}; Physical Surface(\"body\")={1}; Physical Curve(\"contact\")={1};", 0.3, 1);
  } else {
    s.mesh = mesh_geometry(
        "ball", "Sphere(1)={0,1.02,0,1}; Physical Volume(\"body\")={1}; Physical Surface(\"contact\")={1};", 0.5, 1);
    s.normal = {0.1, 1.0, -0.05};
    s.velocity[2] = 0.07;
  }
  return s;
}

struct SchemeChoice {
  std::string time, mass;
  bool smooth;  ///< no chatter: results agree over the whole run, not only up to the first release
};

const std::vector<SchemeChoice>& scheme_choices() {
  static const std::vector<SchemeChoice> all{
      {"scheme = \"midpoint\"\n", "consistent", false},
      {"scheme = \"klr-conserving\"\n", "consistent", false},
      {"scheme = \"newmark\"\npreset = \"textbook-half\"\n", "equivalent", true},
      {"scheme = \"newmark\"\npreset = \"trapezoidal\"\n", "equivalent", true},
      {"scheme = \"semi-explicit\"\n", "equivalent-lumped", true},
  };
  return all;
}

struct Frame {
  Vector displacement;
  Vector reaction;  ///< contact forces on the body, per dof
  Vector normal;    ///< normal reactions, per contact point
};

/// All frames of a run.
std::vector<Frame> frames(const Setting& s, const SchemeChoice& choice) {
  CaseRun run(case_text(s, choice.time, choice.mass));
  std::vector<Frame> result;
  run.run([&] {
    const StepForces& forces = run.state().forces;
    Vector reaction = Vector::Zero(run.problem().dof_count());
    run.state().forces.rows->add_force(forces.normal_reaction, forces.tangential_reaction, reaction);
    result.push_back({run.state().displacement, reaction, forces.normal_reaction});
  });
  return result;
}

/// Number of frames up to the first step in which a contact reopens; all frames for smooth schemes.
std::size_t comparable(const std::vector<Frame>& all, bool smooth) {
  EXPECT_TRUE(std::ranges::any_of(all, [](const Frame& f) { return f.normal.maxCoeff() > 0.0; })) << "no contact";
  if (smooth) return all.size();
  for (std::size_t k = 1; k < all.size(); ++k) {
    if (((all[k - 1].normal.array() > 0.0) && !(all[k].normal.array() > 0.0)).any()) return k;
  }
  return all.size();
}

/// Largest difference of displacement and reaction after `map` is applied to the second run, relative to the largest
/// value of each.
double difference(const std::vector<Frame>& a, const std::vector<Frame>& b, std::size_t count,
                  const std::function<Frame(const Frame&)>& map) {
  double u = 0.0, r = 0.0, u_size = 0.0, r_size = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    u_size = std::max(u_size, a[k].displacement.lpNorm<Eigen::Infinity>());
    r_size = std::max(r_size, a[k].reaction.lpNorm<Eigen::Infinity>());
    if (k >= count) continue;
    const Frame mapped = map(b[k]);
    u = std::max(u, (a[k].displacement - mapped.displacement).lpNorm<Eigen::Infinity>());
    r = std::max(r, (a[k].reaction - mapped.reaction).lpNorm<Eigen::Infinity>());
  }
  return std::max(u / u_size, r / r_size);
}

TEST(Invariance, UnitsByPowersOfTwoGiveTheSameBits) {
  for (const auto& [dimension, friction] : {std::pair{2, 0.0}, {3, 0.0}, {2, 0.3}, {3, 0.3}}) {
    Setting s = setting(dimension, friction);
    if (friction > 0.0) s.obstacle_velocity = {0.2, -0.02, 0.0};
    if (friction > 0.0 && dimension == 3) s.rotation_rate = 0.5;
    for (const auto& [length, time, mass] : {std::tuple{3, 0, 0}, {0, 5, 0}, {0, 0, 7}, {-9, 4, -3}, {1, 1, 1}}) {
      Setting t = s;
      const auto unit = [](int exponent) { return std::ldexp(1.0, exponent); };
      t.scale *= unit(length);
      t.point *= unit(length);
      t.velocity *= unit(length - time);
      t.obstacle_velocity *= unit(length - time);
      t.rotation_rate *= unit(-time);
      t.gravity *= unit(length - 2 * time);
      t.density *= unit(mass - 3 * length);
      t.lambda *= unit(mass - length - 2 * time);
      t.mu *= unit(mass - length - 2 * time);
      t.step *= unit(time);
      t.end *= unit(time);
      const double force = unit(mass - 2 * time + (dimension == 3 ? length : 0));
      for (const SchemeChoice& choice : scheme_choices()) {
        const std::vector<Frame> a = frames(s, choice), b = frames(t, choice);
        ASSERT_EQ(a.size(), b.size());
        for (std::size_t k = 0; k < a.size(); ++k) {
          ASSERT_TRUE((a[k].displacement * unit(length) == b[k].displacement) &&
                      (a[k].reaction * force == b[k].reaction))
              << choice.time << "step " << k << " dimension " << dimension << " friction " << friction << " units "
              << length << " " << time << " " << mass;
        }
      }
    }
  }
}

TEST(Invariance, MetreKilogramAgainstMillimetreTonne) {
  for (const auto& [dimension, friction] : {std::pair{2, 0.0}, {3, 0.0}, {2, 0.3}, {3, 0.3}}) {
    const Setting s = setting(dimension, friction);
    Setting t = s;
    t.scale *= 1e3;
    t.velocity *= 1e3;
    t.gravity *= 1e3;
    t.density *= 1e-12;  // kg/m³ → t/mm³
    t.lambda *= 1e-6;    // Pa → MPa
    t.mu *= 1e-6;
    const double force = dimension == 3 ? 1.0 : 1e3;  // N; in 2D N/m → N/mm is 1e-3
    for (const SchemeChoice& choice : scheme_choices()) {
      const std::vector<Frame> a = frames(s, choice), b = frames(t, choice);
      const double found = difference(a, b, comparable(a, choice.smooth), [&](const Frame& f) {
        return Frame{f.displacement * 1e-3, f.reaction * force, f.normal * force};
      });
      EXPECT_LT(found, 1e-9) << choice.time << dimension << " friction " << friction;
    }
  }
}

/// Writes a copy of an ASCII .msh 2.2 file with moved nodes, numbered in reverse if requested.
std::string transformed_mesh(const std::string& path, const std::string& name, const Eigen::Matrix3d& map,
                             bool renumber, bool flip) {
  // Meshes are shared: a file beside the mesh would be written by one test and read by another.
  const std::string plain = write_temporary("plain.msh", "");
  if (std::system(("gmsh '" + path + "' -v 1 -save -format msh22 -o '" + plain + "'").c_str()) != 0)
    throw std::runtime_error("gmsh failed");
  std::ifstream in(plain);
  std::string text, line;
  long nodes = 0;
  const auto number = [&](long tag) { return renumber ? nodes + 1 - tag : tag; };
  while (std::getline(in, line)) {
    text += line + "\n";
    if (line == "$Nodes") {
      std::getline(in, line);
      nodes = std::stol(line);
      std::vector<std::string> lines(static_cast<std::size_t>(nodes));
      for (long i = 0; i < nodes; ++i) {
        long tag = 0;
        Eigen::Vector3d x;
        in >> tag >> x[0] >> x[1] >> x[2];
        const Eigen::Vector3d y = map * x;
        lines[std::size_t(number(tag) - 1)] =
            fmt::format("{} {:.17g} {:.17g} {:.17g}\n", number(tag), y[0], y[1], y[2]);
      }
      std::getline(in, line);
      text += fmt::format("{}\n", nodes);
      for (const std::string& l : lines) text += l;
    } else if (line == "$Elements") {
      std::getline(in, line);
      text += line + "\n";
      for (long i = std::stol(line); i > 0; --i) {
        std::getline(in, line);
        std::istringstream words(line);
        long tag = 0, type = 0, tags = 0, physical = 0, entity = 0;
        words >> tag >> type >> tags >> physical >> entity;
        std::vector<long> cell;
        for (long node = 0; words >> node;) cell.push_back(number(node));
        if (flip && cell.size() > 2) std::swap(cell[1], cell[2]);  // a reflection turns cells inside out
        text += fmt::format("{} {} {} {} {}", tag, type, tags, physical, entity);
        for (const long node : cell) text += fmt::format(" {}", node);
        text += "\n";
      }
    }
  }
  return write_temporary(name, text);
}

/// Compares a case with itself under an orthogonal map of space.
void expect_same_under(const Setting& s, const Eigen::Matrix3d& map, bool renumber, const std::string& name) {
  Setting t = s;
  t.mesh = transformed_mesh(s.mesh, name + ".msh", map, renumber, map.determinant() < 0.0);
  Setting plain = s;
  plain.mesh = transformed_mesh(s.mesh, name + "_plain.msh", Eigen::Matrix3d::Identity(), false, false);
  for (Eigen::Vector3d* v : {&t.point, &t.normal, &t.gravity, &t.velocity, &t.obstacle_velocity}) *v = map * *v;
  if (map.determinant() < 0.0) t.rotation_rate *= -1.0;
  const int d = s.dimension;
  for (const SchemeChoice& choice : scheme_choices()) {
    const std::vector<Frame> a = frames(plain, choice), b = frames(t, choice);
    // Nodes keep their numbers of the file in both meshes, except for those that belong to no cell: match by position.
    CaseRun first(case_text(plain, choice.time, choice.mass)), second(case_text(t, choice.time, choice.mass));
    const Points& x = first.problem().nodes;
    const Points& y = second.problem().nodes;
    std::vector<Index> partner(static_cast<std::size_t>(x.cols()));
    for (Index i = 0; i < x.cols(); ++i) {
      Eigen::Vector3d position = Eigen::Vector3d::Zero();
      position.head(d) = x.col(i);
      const Vector image = (map * position).head(d);
      Index at = 0;
      (y.colwise() - image).colwise().squaredNorm().minCoeff(&at);
      partner[std::size_t(i)] = at;
    }
    const auto image = [&](const Vector& field) {
      Vector mapped(field.size());
      for (Index i = 0; i < x.cols(); ++i) {
        Eigen::Vector3d u = Eigen::Vector3d::Zero();
        u.head(d) = field.segment(partner[std::size_t(i)] * d, d);
        mapped.segment(i * d, d) = (map.transpose() * u).head(d);
      }
      return mapped;
    };
    const double found = difference(a, b, comparable(a, choice.smooth), [&](const Frame& f) {
      return Frame{image(f.displacement), image(f.reaction), f.normal};
    });
    EXPECT_LT(found, 1e-9) << name << " " << choice.time << "dimension " << d << " friction " << s.friction;
  }
}

TEST(Invariance, RotationOfTheWholeCase) {
  for (const double friction : {0.0, 0.3}) {
    expect_same_under(setting(2, friction), Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()).toRotationMatrix(), false,
                      "rotated2");
    expect_same_under(setting(3, friction),
                      Eigen::AngleAxisd(1.1, Eigen::Vector3d(1.0, 2.0, -0.5).normalized()).toRotationMatrix(), false,
                      "rotated3");
  }
  // Also an obstacle that moves and rotates.
  Setting turning = setting(3, 0.3);
  turning.obstacle_velocity = {0.2, -0.02, 0.1};
  turning.rotation_rate = 0.8;
  expect_same_under(turning, Eigen::AngleAxisd(1.1, Eigen::Vector3d(1.0, 2.0, -0.5).normalized()).toRotationMatrix(),
                    false, "rotated3");
}

TEST(Invariance, Reflection) {
  const Eigen::Matrix3d mirror = Eigen::Vector3d(-1.0, 1.0, 1.0).asDiagonal();
  for (const double friction : {0.0, 0.3}) {
    expect_same_under(setting(2, friction), mirror, false, "mirrored2");
    expect_same_under(setting(3, friction), mirror, false, "mirrored3");
  }
  Setting turning = setting(3, 0.3);
  turning.rotation_rate = 0.8;
  expect_same_under(turning, mirror, false, "mirrored3");
}

TEST(Invariance, RenumberingOfNodes) {
  for (const double friction : {0.0, 0.3}) {
    expect_same_under(setting(2, friction), Eigen::Matrix3d::Identity(), true, "renumbered2");
    expect_same_under(setting(3, friction), Eigen::Matrix3d::Identity(), true, "renumbered3");
  }
}

/// Compares a case with the same case seen by an observer who moves with −`moving`, so that body and obstacle move with
/// it.
void expect_same_for_observer(const Setting& s, const Eigen::Vector3d& moving, bool obstacle_moves_too,
                              const std::vector<SchemeChoice>& choices = scheme_choices()) {
  Setting t = s;
  t.velocity += moving;
  if (obstacle_moves_too) t.obstacle_velocity += moving;
  for (const SchemeChoice& choice : choices) {
    const std::vector<Frame> a = frames(s, choice);
    std::vector<Frame> b = frames(t, choice);
    for (std::size_t k = 0; k < b.size(); ++k) {
      for (Index i = 0; i < b[k].displacement.size(); ++i)
        b[k].displacement[i] -= moving[i % s.dimension] * s.step * double(k);
    }
    EXPECT_LT(difference(a, b, comparable(a, choice.smooth), [](const Frame& f) { return f; }), 1e-9)
        << choice.time << s.dimension << " friction " << s.friction;
  }
}

TEST(Invariance, ObserverMovingAlongThePlane) {
  // Without friction a uniform velocity along the plane changes nothing but the position.
  for (const int dimension : {2, 3}) {
    const Setting s = setting(dimension);
    const Eigen::Vector3d along = Eigen::Vector3d(1.0, -0.1, 0.0);  // in the plane: its normal is (0.1, 1, ·)
    ASSERT_NEAR(along.dot(s.normal), 0.0, 1e-15);
    expect_same_for_observer(s, along, false);
  }
}

TEST(Invariance, ObstacleMovingAgainstBodyMovingTheOtherWay) {
  // Along the plane and across it, with friction and without.
  for (const auto& [dimension, friction] : {std::pair{2, 0.0}, {3, 0.0}, {2, 0.3}, {3, 0.3}}) {
    Eigen::Vector3d moving(0.7, 0.4, dimension == 3 ? -0.3 : 0.0);
    expect_same_for_observer(setting(dimension, friction), moving, true);
  }
}

/// Restitution and friction act on velocities relative to the obstacle.
TEST(Invariance, ObstacleMovingUnderPublishedSchemes) {
  const std::vector<SchemeChoice> with_friction{
      {"scheme = \"moreau-jean\"\ntheta = 0.7\nrestitution = 0.5\n", "consistent", false},
      {"scheme = \"moreau-jean\"\nslip = \"theta\"\n", "consistent", false},
      {"scheme = \"paoli-schatzman\"\nrestitution = 0.5\n", "consistent", false},
      {"scheme = \"kane\"\n", "consistent", false},
      {"scheme = \"laursen-chawla\"\n", "consistent", false},
      {"scheme = \"laursen-love\"\n", "consistent", false},
      {"scheme = \"generalized-alpha\"\n", "consistent", false},
      {"scheme = \"bathe\"\n", "consistent", false},
  };
  const std::vector<SchemeChoice> without{
      {"scheme = \"nonsmooth-generalized-alpha\"\nrestitution = 0.5\n", "consistent", false},
      {"scheme = \"penalty-midpoint\"\n", "consistent", false},
      {"scheme = \"nitsche\"\n", "consistent", false},
  };
  const std::vector<SchemeChoice> with_short_steps{
      {"scheme = \"cd-lagrange\"\nrestitution = 0.5\n", "lumped", false},
      {"scheme = \"taylor-flanagan\"\n", "lumped", false},
  };
  const Eigen::Vector3d moving(0.7, 0.4, 0.0);
  expect_same_for_observer(setting(2, 0.3), moving, true, with_friction);
  expect_same_for_observer(setting(2), moving, true, without);
  Setting short_steps = setting(2, 0.3);
  short_steps.step = 0.0015;
  short_steps.end = 0.3;
  expect_same_for_observer(short_steps, moving, true, with_short_steps);
}

TEST(Invariance, SameBitsTwice) {
  for (const SchemeChoice& choice : scheme_choices()) {
    const Setting s = setting(2, 0.3);
    const std::vector<Frame> a = frames(s, choice), b = frames(s, choice);
    for (std::size_t k = 0; k < a.size(); ++k)
      ASSERT_TRUE(a[k].displacement == b[k].displacement && a[k].reaction == b[k].reaction) << k;
  }
}

}  // namespace ricochet::test_support::invariances_test
