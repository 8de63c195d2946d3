#pragma once

#include "ricochet/base/archive.hpp"
#include "ricochet/contact/curved_contact.hpp"

/// @file Contact boundaries on their way to another process.
namespace ricochet {

void transfer(Archive& archive, ContactRows& rows);
/// All but `rows` and `geometry`.
void transfer(Archive& archive, ContactBoundary& contact);
void transfer(Archive& archive, CurvedContactData::Point& point);
void transfer(Archive& archive, CurvedContactData::Node& node);

}  // namespace ricochet
