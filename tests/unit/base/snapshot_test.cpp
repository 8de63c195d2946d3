#include "ricochet/base/snapshot.hpp"

#include <gtest/gtest.h>

#include "ricochet/base/contact_status.hpp"
#include "ricochet/base/error.hpp"

namespace ricochet {
namespace {

struct Sighting {
  Index node = -1;
  double depth = 0.0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  bool is_told = false;
  [[nodiscard]] auto members() { return std::tie(node, depth, position, is_told); }
  bool operator==(const Sighting&) const = default;
};

/// State with an entry of every kind.
struct PersistentThing {
  double limit = 0.0;
  int level = 0;
  long first = 0;
  bool second = false;
  std::string kind;
  std::vector<Index> points;
  std::vector<ContactStatus> states;
  Vector forces = Vector::Zero(3);
  Points normals;
  std::vector<Sighting> all = std::vector<Sighting>(2), some;
  bool operator==(const PersistentThing&) const = default;

  void persist(const SnapshotVisitor& visit) {
    visit("", limit);
    visit("level", level, {0, 5});
    visit.integers("both", {0, 9}, first, second);
    visit("kind", kind);
    visit("points", points, {0, 99});
    visit("states", states, {0, 3}, 2);
    visit.part("inner").part(7)("forces", forces, 3, 0);
    visit("normals", normals, 2, 4, 0);
    visit.numbers("all", all);
    visit.list("some", some, 2);
    visit.require(limit >= 0.0, "", "is negative");
  }
};

PersistentThing example_thing() {
  const Sighting seen{3, 0.1, {1.0, -0.0, 1e-308}, true};
  return {.limit = 0.1,
          .level = 5,
          .first = 9,
          .second = true,
          .kind = "a",
          .points = {4, 0, 99},
          .states = {ContactStatus::slip, ContactStatus::open},
          .forces = Vector::Constant(3, 1e300),
          .normals = Points::Constant(2, 4, -1.0),
          .all = {seen, {}},
          .some = {seen}};
}

TEST(SnapshotVisitor, LoadsWhatItHasSaved) {
  Snapshot snapshot;
  PersistentThing thing = example_thing(), found;
  thing.persist(snapshot.saver("run.thing"));
  EXPECT_EQ(snapshot.real("run.thing"), 0.1);
  EXPECT_EQ(snapshot.integers("run.thing.both"), (Snapshot::Integers{9, 1}));
  EXPECT_EQ(snapshot.reals("run.thing.inner.7.forces"), thing.forces);
  EXPECT_EQ(snapshot.reals("run.thing.all").head(6), (Vector(6) << 3.0, 0.1, 1.0, -0.0, 1e-308, 1.0).finished());
  found.persist(snapshot.loader("run.thing"));
  EXPECT_TRUE(found == thing);
  // Without a name, entries have their keys.
  Snapshot unnamed;
  thing.persist(unnamed.saver(""));
  EXPECT_TRUE(unnamed.has("level"));
}

TEST(SnapshotVisitor, RefusesWhatDoesNotFit) {
  Snapshot snapshot;
  example_thing().persist(snapshot.saver("thing"));
  const auto expect_refused = [&](const std::string& key, const Snapshot::Value& value, const std::string& why) {
    Snapshot changed = snapshot;
    const std::string name = key.empty() ? "thing" : "thing." + key;
    changed.set(name, value);
    PersistentThing thing;
    try {
      thing.persist(changed.loader("thing"));
      ADD_FAILURE() << name << why;
    } catch (const Error& problem) {
      EXPECT_EQ(problem.what(), "the saved state does not fit: " + name + " " + why);
    }
  };
  using Integers = Snapshot::Integers;
  const auto reals = [](std::initializer_list<double> values) {
    return Vector(Eigen::Map<const Vector>(values.begin(), Index(values.size())));
  };
  expect_refused("", reals({1.0, 2.0}), "has 2 numbers where 1 are expected");
  expect_refused("", reals({-1.0}), "is negative");
  expect_refused("level", Integers{6}, "has 6, which is not from 0 to 5");
  expect_refused("level", reals({1.0}), "does not hold integers");
  expect_refused("both", Integers{1, 2}, "has 2, out of range");
  expect_refused("both", Integers{1}, "has 1 numbers where 2 are expected");
  expect_refused("points", Integers{0, -1}, "has -1, which is not from 0 to 99");
  expect_refused("states", Integers{0}, "has 1 numbers where 2 are expected");
  expect_refused("inner.7.forces", reals({1.0}), "has 1 numbers where 3 are expected");
  expect_refused("normals", reals({1.0, 2.0}), "has 2 numbers where 8 are expected");
  for (const double node : {0.5, 1e19, -1e300, std::nan("")}) {
    expect_refused("all", reals({node, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}),
                   std::string("has ") +
                       (node == 0.5    ? "0.5"
                        : node == 1e19 ? "1e+19"
                        : node < 0.0   ? "-1e+300"
                                       : "nan") +
                       ", which is no whole number of its range");
  }
  expect_refused("all", reals({0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0}), "has 2, which is no whole number of its range");
  expect_refused("all", reals({0, 0, 0, 0, 0, -1, 0, 0, 0, 0, 0, 0}), "has -1, which is no whole number of its range");
  expect_refused("some", reals({0.0}), "has 1 numbers where a multiple of 6 is expected");
  expect_refused("some", Vector(Vector::Zero(18)), "has 3 records where at most 2 are possible");
}

TEST(SnapshotVisitor, RefusesRecordsWithoutNumbers) {
  Snapshot snapshot;
  snapshot.save("legs", Vector(Vector::Zero(6)));
  std::vector<Vector> legs;
  EXPECT_THROW(snapshot.loader("legs").list("", legs), Error) << "an empty prototype divides by no width";
  snapshot.loader("legs").list("", legs, 9, Vector(Vector::Zero(3)));
  EXPECT_EQ(legs.size(), 2U);
}

}  // namespace
}  // namespace ricochet
