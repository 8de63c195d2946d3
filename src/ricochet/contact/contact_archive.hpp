#pragma once

#include "ricochet/base/archive.hpp"
#include "ricochet/contact/curved_contact.hpp"

/// @file Serialization of contact boundaries for transfer between processes.
namespace ricochet {

void transfer(Archive& archive, ContactRows& rows);
/// Transfers all members except `rows` and `geometry`.
void transfer(Archive& archive, ContactBoundary& contact);
void transfer(Archive& archive, CurvedContactData::Point& point);
void transfer(Archive& archive, CurvedContactData::Node& node);

}  // namespace ricochet
