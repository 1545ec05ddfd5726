#include "planning/tool_pace.hpp"

#include <cmath>

namespace viapoint::planning {
std::array<double, 3> value_slope_bend(const std::array<double, 6>& c, double u) {
  return {c[0] + u * (c[1] + u * (c[2] + u * (c[3] + u * (c[4] + u * c[5])))),
          c[1] + u * (2 * c[2] + u * (3 * c[3] + u * (4 * c[4] + u * 5 * c[5]))),
          2 * c[2] + u * (6 * c[3] + u * (12 * c[4] + u * 20 * c[5]))};
}

RateAt rate_at(const ToolRate& rate, double u) {
  RateAt result;
  for (int axis = 0; axis < 3; ++axis) {
    const auto& c = rate.coefficients[static_cast<size_t>(axis)];
    const auto [value, slope, bend] = value_slope_bend(c, u);
    result.value[axis] = value;
    result.slope[axis] = slope;
    result.bend[axis] = bend;
  }
  return result;
}

Pace pace_at_speed(const RateAt& linear, double u, double speed) {
  const double f = linear.value.squaredNorm();
  if (!(f > 0.0)) return {u, 0.0, 0.0, 0.0};
  const double f1 = 2.0 * linear.value.dot(linear.slope);
  const double f2 = 2.0 * (linear.slope.squaredNorm() + linear.value.dot(linear.bend));
  const double v2 = speed * speed, rate = speed / std::sqrt(f);
  return {u, rate, -0.5 * v2 * f1 / (f * f),
          rate * -0.5 * v2 * (f2 / (f * f) - 2.0 * f1 * f1 / (f * f * f))};
}

void Ruling::take(double share, int order, const char* name, std::optional<int> of) {
  const double wanted = order == 1 ? share : (order == 2 ? std::sqrt(share) : std::cbrt(share));
  if (wanted > slower) *this = {wanted, name, of};
}

void Ruling::take(const JointLimits& limits, double share, const JointState& state) {
  for (int i = 0; i < limits.joints(); ++i) {
    take(std::abs(state.qd[i]) / (share * limits.velocity[i]), 1, "velocity", i);
    take(std::abs(state.qdd[i]) / (share * limits.acceleration[i]), 2, "acceleration", i);
    take(std::abs(state.qddd[i]) / (share * limits.jerk[i]), 3, "jerk", i);
  }
}

}  // namespace viapoint::planning
