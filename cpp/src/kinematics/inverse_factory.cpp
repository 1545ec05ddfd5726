#include "kinematics/inverse_factory.hpp"

#include <string>

#include "kinematics/numerical_inverse.hpp"
#include "kinematics/spherical_wrist_inverse.hpp"

namespace viapoint {

std::unique_ptr<const InverseKinematics> make_inverse(const ForwardKinematics& forward,
                                                      const JointLimits& limits) {
  if (const auto wrist = SphericalWrist::recognise(forward)) {
    return std::make_unique<SphericalWristInverse>(forward, limits, *wrist);
  }
  const std::string why = forward.joints() == 6 ? "the last three axes do not meet at right angles "
                                                  "behind a shoulder with parallel axes 2 "
                                                  "and 3"
                                                : std::to_string(forward.joints()) +
                                                      " joints, a chain without a closed form here";
  return std::make_unique<NumericalInverse>(forward, limits, why);
}

}  // namespace viapoint
