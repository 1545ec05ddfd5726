#include "kinematics/inverse_factory.hpp"

#include <string>
#include <utility>

#include "kinematics/closed_form_inverse.hpp"
#include "kinematics/nearly_closed_inverse.hpp"
#include "kinematics/numerical_inverse.hpp"
#include "kinematics/redundant_inverse.hpp"

namespace viapoint {

std::unique_ptr<const InverseKinematics> make_inverse(const ForwardKinematics& forward,
                                                      const JointLimits& limits) {
  if (auto form = recognise_closed_form(forward)) {
    return std::make_unique<ClosedFormInverse>(forward, limits, std::move(form));
  }
  if (auto form = recognise_redundant_form(forward)) {
    return std::make_unique<RedundantInverse>(forward, limits, std::move(form));
  }
  if (auto inverse = NearlyClosedInverse::make(forward, limits)) return inverse;
  const std::string why =
      forward.joints() == 6 ? "no three axes that meet in one point or, in the middle, are parallel"
                            : std::to_string(forward.joints()) + " joints";
  return std::make_unique<NumericalInverse>(forward, limits, why);
}

}  // namespace viapoint
