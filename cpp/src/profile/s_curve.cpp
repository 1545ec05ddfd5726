#include "viapoint/profile/s_curve.hpp"

#include "profile/argument_check.hpp"

namespace viapoint {

AxisLaw s_curve(double q0, double q1, double velocity, double acceleration, double jerk) {
  require_finite(q0, "q0");
  require_finite(q1, "q1");
  require_positive(velocity, "velocity");
  require_positive(acceleration, "acceleration");
  require_positive(jerk, "jerk");
  if (q0 == q1) refuse("from " + written(q0) + " to itself there is nothing to move", 0.0, 0.0);
  JerkProfile profile = rest_to_rest(q1 - q0, velocity, acceleration, jerk);
  profile.start.q = q0;
  AxisLaw law(profile);
  require_arrival(law.parts().back(), q1);
  return law;
}

}  // namespace viapoint
