#pragma once

/// @file What a contact point does.
namespace ricochet {

enum class ContactStatus : char {
  open = 0,    ///< no force
  closed = 1,  ///< pressed, and without friction
  stick = 2,   ///< pressed, and without slip
  slip = 3,    ///< pressed, and slipping with the largest friction it can have
};

}  // namespace ricochet
