#include "profile/rest_motion.hpp"

#include <algorithm>
#include <cmath>

namespace viapoint {

/// Where a side is at the ends of its phases, seen from rest.
struct RestMotion::Course {
  double rise_time, fall_time;     ///< of the jerk next to rest, and of that next to the top
  double rise_velocity, velocity;  ///< at the ends of the hold
  double rise_way, hold_way, way;  ///< covered by then, and at the top

  Course(const Side& side, double top, double per_up, double per_down) noexcept {
    rise_time = side.peak * per_up;
    fall_time = side.peak * per_down;
    rise_velocity = 0.5 * side.peak * rise_time;
    velocity = top - 0.5 * side.peak * fall_time;
    rise_way = rise_velocity * rise_time * (1.0 / 3.0);
    hold_way = rise_way + side.hold * (rise_velocity + 0.5 * side.peak * side.hold);
    way = hold_way + fall_time * (velocity + side.peak * fall_time * (1.0 / 3.0));
  }
};

double RestMotion::free_length(double top, double peak) const noexcept {
  return top * peak * (per_up_ + 2.0 * per_down_) * (2.0 / 3.0);
}

void RestMotion::set_held(double top) noexcept {
  top_ = top;
  rise_ = {limits_.rise, std::max(0.0, top / limits_.rise - half_ * limits_.rise)};
  fall_ = {limits_.fall, std::max(0.0, top / limits_.fall - half_ * limits_.fall)};
}

bool RestMotion::solve(double distance, const UpwardLimits& limits) noexcept {
  limits_ = limits;
  per_up_ = 1.0 / limits.jerk_up;
  per_down_ = 1.0 / limits.jerk_down;
  half_ = 0.5 * (per_up_ + per_down_);
  cruise_ = 0.0;
  const double a = limits.rise, b = limits.fall, v = limits.velocity;
  const double least = std::min(a, b), most = std::max(a, b);
  // Velocities from which on one side holds, and both.
  const double one = half_ * least * least, both = half_ * most * most;

  // What both sides cover while both hold is square · u² + linear · u + constant.
  const double square = 0.5 * (a + b) / (a * b);
  const double linear = 0.5 * per_down_ * (a + b);
  const double constant = half_ * (per_up_ - per_down_) * (a * a * a + b * b * b) * (1.0 / 12.0);
  const auto held_length = [&](double u) { return u * (square * u + linear) + constant; };
  if (v >= both && held_length(both) <= distance) {
    const double ramps = held_length(v);
    if (ramps <= distance) {
      set_held(v);
      cruise_ = (distance - ramps) / v;
    } else {
      const double rest = distance - constant;
      set_held(2.0 * rest / (linear + std::sqrt(linear * linear + 4.0 * square * rest)));
    }
  } else {
    const double top = std::min(v, one);
    const double peak = std::sqrt(top / half_);
    const double ramps = free_length(top, peak);
    if (ramps > distance) {
      // 2 H (1/j_up + 2/j_down)/3 x³ = distance
      const double cubed = distance / (half_ * (per_up_ + 2.0 * per_down_) * (2.0 / 3.0));
      rise_ = fall_ = {std::cbrt(cubed), 0.0};
      top_ = half_ * rise_.peak * rise_.peak;
    } else if (v <= one) {
      rise_ = fall_ = {peak, 0.0};
      top_ = v;
      cruise_ = (distance - ramps) / v;
    } else {
      return false;
    }
  }
  duration_ = 2.0 * half_ * (rise_.peak + fall_.peak) + rise_.hold + fall_.hold + cruise_;
  return true;
}

void RestMotion::write(double from, double to, double sign, double stretch,
                       AxisMove& move) const noexcept {
  const Course rise(rise_, top_, per_up_, per_down_), fall(fall_, top_, per_up_, per_down_);
  const double rate = sign / stretch;
  const double bend = rate * rate;
  const double rising = bend * rate * limits_.jerk_up, falling = -bend * rate * limits_.jerk_down;
  const bool cruises = cruise_ > 0.0;
  // All are written, and those that take no time are written over.
  size_t count = 0;
  const auto put = [&](double seconds, double q, double qd, double qdd, double jerk) {
    move.phase[count] = {seconds * stretch, {q, qd * rate, qdd * bend, jerk}};
    count += seconds > 0.0 ? 1 : 0;
  };
  const double up = sign * rise_.peak, down = -sign * fall_.peak;
  put(rise.rise_time, from, 0.0, 0.0, rising);
  put(rise_.hold, from + sign * rise.rise_way, rise.rise_velocity, up, 0.0);
  put(cruises ? rise.fall_time : rise.fall_time + fall.fall_time, from + sign * rise.hold_way,
      rise.velocity, up, falling);
  put(cruise_, from + sign * rise.way, top_, 0.0, 0.0);
  put(cruises ? fall.fall_time : 0.0, to - sign * fall.way, top_, 0.0, falling);
  put(fall_.hold, to - sign * fall.hold_way, fall.velocity, down, 0.0);
  put(fall.rise_time, to - sign * fall.rise_way, fall.rise_velocity, down, rising);
  move.phases = static_cast<int>(count);
  move.total = duration_ * stretch;
  move.end = {to, 0.0, 0.0, 0.0};
}

}  // namespace viapoint
