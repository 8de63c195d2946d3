#include "ricochet/contact/contact_members.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "ricochet/base/archive.hpp"
#include "ricochet/base/selection.hpp"
#include "ricochet/contact/contact_cut.hpp"
#include "support/case_run.hpp"
#include "support/thrown_body.hpp"

/// @file Members of a contact boundary, sent and cut.
namespace ricochet {
namespace {

std::vector<char> bytes_of(ContactBoundary contact) {
  Archive archive;
  archive(contact);
  if (contact.geometry) {
    CurvedContactData data = *contact.geometry->curved();
    archive(data);
  }
  return archive.take();
}

/// A disc above a ball, so that rows follow the motion.
std::string disc_above_ball() {
  std::string text = test_support::thrown_case(test_support::thrown_bodies().front(), "consistent",
                                               test_support::time_of("newmark"), "friction = 0.3\n");
  const std::string plane = "\"plane\"\npoint = [0.0, 0.0]\nnormal = [0.1, 1.0]\n";
  return text.replace(text.find(plane), plane.size(),
                      "\"sphere\"\ncentre = [0.0, -2.0]\nradius = 2.0\nside = \"outside\"\n");
}

std::vector<Index> numbers_below(Index count) {
  std::vector<Index> result(static_cast<std::size_t>(count));
  std::iota(result.begin(), result.end(), Index{0});
  return result;
}

TEST(ContactMembers, AreSentAndCut) {
  const test_support::CaseRun run(disc_above_ball());
  const ContactBoundary& contact = run.problem().contact;
  ASSERT_GT(contact.size(), 3);
  ContactBoundary received;
  Archive archive(bytes_of(contact));
  archive(received);
  received.geometry = contact.geometry;
  EXPECT_TRUE(bytes_of(received) == bytes_of(contact));
  // The part with everything is the whole.
  const Index nodes = run.problem().nodes.cols();
  ContactCut part{numbers_below(contact.size()), numbers_below(Index(contact.nodes.size())), numbers_below(nodes),
                  numbers_below(contact.facets.back() + 1), nodes};
  ContactBoundary whole = cut_contact(contact, part);
  whole.has_friction_elsewhere = contact.has_friction_elsewhere;
  EXPECT_TRUE(bytes_of(whole) == bytes_of(contact));
  // A part has the gaps and forces of its points.
  part.points = {1, contact.size() - 1};
  const ContactBoundary own = cut_contact(contact, part);
  ASSERT_EQ(own.size(), 2);
  EXPECT_EQ(own.initial_gap, chosen(contact.initial_gap, part.points));
  ASSERT_EQ(contact.rows->gap.size(), contact.size());
  EXPECT_EQ(own.rows->gap, chosen(contact.rows->gap, part.points));
  EXPECT_EQ(own.geometry->curved()->points.size(), 2U);
  EXPECT_EQ(std::ranges::count_if(own.own_point, [](Index point) { return point >= 0; }), 2);
  EXPECT_GT(std::ranges::count(own.own_point, -2), 0);
  Vector all = Vector::Zero(contact.size()), force = Vector::Zero(nodes * contact.dimension), own_force = force;
  all[1] = 1.0;
  contact.rows->add_force(all, {}, force);
  own.rows->add_force(Vector::Unit(2, 0), {}, own_force);
  EXPECT_EQ(own_force, force);
}

}  // namespace
}  // namespace ricochet
