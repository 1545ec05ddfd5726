#include "viapoint/profile/trapezoid.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "profile/argument_check.hpp"

namespace viapoint {
namespace {

/// @pre 0 < blend_time <= duration / 2
Trapezoid trapezoid(double q0, double q1, double duration, double velocity, double blend_time) {
  const double acceleration = velocity / blend_time;
  const double ramp = 0.5 * velocity * blend_time;
  const Polynomial up{0.0, blend_time, {q0, 0.0, 0.5 * acceleration, 0.0, 0.0, 0.0}};
  const Polynomial cruise{blend_time, duration - blend_time, {q0 + ramp, velocity}};
  const Polynomial down{
      duration - blend_time, duration, {q1 - ramp, velocity, -0.5 * acceleration, 0.0, 0.0, 0.0}};
  std::vector<Polynomial> parts{up};
  if (cruise.t1 > cruise.t0) parts.push_back(cruise);
  parts.push_back(down);
  return {AxisLaw(std::move(parts)), velocity, acceleration, blend_time};
}

void require_move(double q0, double q1, double duration) {
  require_finite(q0, "q0");
  require_finite(q1, "q1");
  require_positive(duration, "duration");
}

void require_distance(double q0, double q1) {
  require_finite(q0, "q0");
  require_finite(q1, "q1");
  if (q0 == q1) refuse("from " + written(q0) + " to itself there is nothing to move", 0.0, 0.0);
}

}  // namespace

Trapezoid lspb(double q0, double q1, double duration) {
  require_move(q0, q1, duration);
  return lspb_with_blend_time(q0, q1, duration, duration / 3.0);
}

Trapezoid lspb_with_blend_time(double q0, double q1, double duration, double blend_time) {
  require_move(q0, q1, duration);
  if (!(blend_time > 0.0 && blend_time <= 0.5 * duration)) {
    refuse("a blend time of " + written(blend_time) + " s does not fit into " + written(duration) +
               " s; it must be greater than 0 and at most " + written(0.5 * duration) + " s",
           blend_time, 0.5 * duration);
  }
  return trapezoid(q0, q1, duration, (q1 - q0) / (duration - blend_time), blend_time);
}

Trapezoid lspb_with_velocity(double q0, double q1, double duration, double velocity) {
  require_move(q0, q1, duration);
  const double mean = (q1 - q0) / duration;
  const double most = 2.0 * (q1 - q0) / duration;
  if (q0 == q1) {
    refuse("from " + written(q0) + " to itself there is no linear part to give a velocity to",
           velocity, 0.0, {"give a blend time, or none, to rest there"});
  }
  const bool fits =
      q1 > q0 ? velocity > mean && velocity <= most : velocity < mean && velocity >= most;
  if (!fits) {
    refuse("a velocity of " + written(velocity) + " cannot take " + written(q0) + " to " +
               written(q1) + " in " + written(duration) +
               " s with two blends; |velocity| must be "
               "greater than " +
               written(std::abs(mean)) + " and at most " + written(std::abs(most)) +
               ", with the sign of the move",
           velocity, std::abs(velocity) < std::abs(mean) ? mean : most,
           {"choose a velocity in that range", "change the duration"});
  }
  const double blend_time = (q0 - q1 + velocity * duration) / velocity;
  if (!(blend_time > 0.0)) {
    refuse("a velocity of " + written(velocity) +
               " is so near the mean velocity that no time is "
               "left for the blends; |velocity| must be greater than " +
               written(std::abs(mean)),
           velocity, mean, {"choose a larger velocity"});
  }
  return trapezoid(q0, q1, duration, velocity, std::min(blend_time, 0.5 * duration));
}

Trapezoid quickest_trapezoid(double q0, double q1, double velocity, double acceleration) {
  require_positive(velocity, "velocity");
  require_positive(acceleration, "acceleration");
  require_distance(q0, q1);
  const double ramp = velocity / acceleration;
  const double gap = std::abs(q1 - q0);
  if (!(velocity * ramp < gap)) return bang_bang(q0, q1, acceleration);
  return trapezoid(q0, q1, gap / velocity + ramp, std::copysign(velocity, q1 - q0), ramp);
}

Trapezoid bang_bang(double q0, double q1, double acceleration) {
  require_positive(acceleration, "acceleration");
  require_distance(q0, q1);
  const double to_switch = std::sqrt(std::abs(q1 - q0) / acceleration);
  return trapezoid(q0, q1, 2.0 * to_switch, (q1 - q0) / to_switch, to_switch);
}

}  // namespace viapoint
