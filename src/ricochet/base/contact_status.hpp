#pragma once

/// @file State of a contact point.
namespace ricochet {

enum class ContactStatus : char {
  open = 0,    ///< no force
  closed = 1,  ///< in contact, frictionless
  stick = 2,   ///< in contact, without slip
  slip = 3,    ///< in contact, slipping at the friction limit
};

}  // namespace ricochet
