#include "ricochet/solver/stage/moved_product.hpp"

#include <gtest/gtest.h>

#include "ricochet/fem/assembly.hpp"
#include "support/box_mesh.hpp"

namespace ricochet::test_support {
namespace {

/// A (x − x₀) for few nodes, whose columns are kept, and for many, where A is multiplied.
TEST(MovedProduct, IsTheProductWithWhatHasMoved) {
  const auto test = make_meshed_body(make_box_mesh(BoxMesh{CellShape::tetrahedron, {6, 7, 8}, 1, 0.15, {}}), 1);
  const SparseMatrix whole = assemble_stiffness(test->body, node_graph(test->space));
  const Index count = test->space.node_count();
  const StageProduct product(whole, 3);
  for (const Index stride : {count, Index{50}, Index{20}, Index{9}, Index{1}}) {
    std::vector<Index> nodes;
    for (Index node = 3; node < count; node += stride) nodes.push_back(node);
    MovedProduct moved;
    moved.make(product, nodes, count, 3);
    for (int time = 0; time < 2; ++time) {
      const Vector before = Vector::Random(whole.cols());
      Vector after = before, found;
      for (const Index node : nodes) after.segment(node * 3, 3) += Vector::Random(3);
      moved.begin(before);
      moved.multiply(after, found);
      const Vector expected = whole * (after - before);
      EXPECT_LE((found - expected).norm(), 1e-14 * expected.norm()) << stride;
    }
  }
}

/// A rank without nodes near the contact takes part as well.
TEST(MovedProduct, OfNoNodesIsZero) {
  const auto test = make_meshed_body(make_box_mesh(BoxMesh{CellShape::triangle, {6, 7}, 1, 0.15, {}}), 1);
  const StageProduct product(assemble_stiffness(test->body, node_graph(test->space)), 2);
  MovedProduct moved;
  moved.make(product, {}, test->space.node_count(), 2);
  const Vector x = Vector::Random(2 * test->space.node_count());
  moved.begin(x);
  Vector found;
  moved.multiply(x, found);
  ASSERT_EQ(found.size(), x.size());
  EXPECT_EQ(found, Vector::Zero(x.size()));
}

}  // namespace
}  // namespace ricochet::test_support
