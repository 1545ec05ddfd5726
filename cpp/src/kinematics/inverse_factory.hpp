/// @file
#pragma once

#include <memory>

#include "viapoint/kinematics/inverse_kinematics.hpp"

namespace viapoint {

/// The solver the chain's geometry allows.
[[nodiscard]] std::unique_ptr<const InverseKinematics> make_inverse(
    const ForwardKinematics& forward, const JointLimits& limits);

}  // namespace viapoint
