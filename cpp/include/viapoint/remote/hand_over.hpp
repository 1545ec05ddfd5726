/// @file
#pragma once

#include <cstdint>

#include "viapoint/realtime/motion_link.hpp"

namespace viapoint {

/// What whoever lengthens a run has to know of it (Follower).
struct HandOver {
  LinkFate fate = LinkFate::kNotYet;  ///< of the motion handed over last
  double earliest_leave = 0.0;        ///< [s]
  std::uint64_t waited_cycles = 0;
};

}  // namespace viapoint
