#include "profile/rest_motion.hpp"

#include <algorithm>
#include <cmath>

namespace viapoint {
namespace {

/// Newton's steps converge in a handful.
constexpr int kMostSteps = 100;
constexpr double kConverged = 4e-16;

}  // namespace

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

RestMotion::Side RestMotion::side(double top, double cap) const noexcept {
  if (top > half_ * cap * cap) return {cap, top / cap - half_ * cap};
  return {std::sqrt(top / half_), 0.0};
}

double RestMotion::length(double top, double cap) const noexcept {
  if (top > half_ * cap * cap) {
    return 0.5 * top * (top / cap + per_down_ * cap) +
           half_ * (per_up_ - per_down_) * cap * cap * cap * (1.0 / 12.0);
  }
  return top * std::sqrt(top / half_) * (per_up_ + 2.0 * per_down_) * (1.0 / 3.0);
}

/// Both sides hold: square · u² + linear · u + constant = distance.
double RestMotion::top_of_both(double distance) const noexcept {
  const double a = limits_.rise, b = limits_.fall;
  const double square = 0.5 * (a + b) / (a * b);
  const double linear = 0.5 * per_down_ * (a + b);
  const double constant = half_ * (per_up_ - per_down_) * (a * a * a + b * b * b) * (1.0 / 12.0);
  const double rest = distance - constant;
  return 2.0 * rest / (linear + std::sqrt(linear * linear + 4.0 * square * rest));
}

/// One side holds `cap`: a quartic in the other's peak, which rises and is convex, so that Newton's
/// steps come down to the root from above.
double RestMotion::top_of_one(double distance, double cap, double highest) const noexcept {
  const double c4 = 0.5 * half_ * half_ / cap;
  const double c3 = half_ * (per_up_ + 2.0 * per_down_) * (1.0 / 3.0);
  const double c2 = 0.5 * half_ * per_down_ * cap;
  const double rest = distance - half_ * (per_up_ - per_down_) * cap * cap * cap * (1.0 / 12.0);
  double x = std::sqrt(highest / half_);
  for (int step = 0; step < kMostSteps; ++step) {
    const double error = x * x * (c2 + x * (c3 + x * c4)) - rest;
    const double slope = x * (2.0 * c2 + x * (3.0 * c3 + x * 4.0 * c4));
    if (!(error > 0.0)) break;
    const double change = error / slope;
    x -= change;
    if (change <= kConverged * x) break;
  }
  return half_ * x * x;
}

void RestMotion::solve(double distance, const UpwardLimits& limits) noexcept {
  limits_ = limits;
  per_up_ = 1.0 / limits.jerk_up;
  per_down_ = 1.0 / limits.jerk_down;
  half_ = 0.5 * (per_up_ + per_down_);
  cruise_ = 0.0;
  const double v = limits.velocity;
  const double least = std::min(limits.rise, limits.fall);
  const double most = std::max(limits.rise, limits.fall);
  // Velocities from which on one side holds, and both.
  const double one = half_ * least * least, both = half_ * most * most;
  const auto whole = [&](double top) { return length(top, least) + length(top, most); };
  const double ramps = whole(v);
  if (ramps <= distance) {
    top_ = v;
    cruise_ = (distance - ramps) / v;
  } else if (v > both && whole(both) <= distance) {
    top_ = top_of_both(distance);
  } else if (v > one && whole(one) <= distance) {
    top_ = top_of_one(distance, least, std::min(v, both));
  } else {
    // 2 H (1/j_up + 2/j_down)/3 x³ = distance
    const double peak = std::cbrt(distance / (half_ * (per_up_ + 2.0 * per_down_) * (2.0 / 3.0)));
    top_ = half_ * peak * peak;
  }
  rise_ = side(top_, limits.rise);
  fall_ = side(top_, limits.fall);
  duration_ = 2.0 * half_ * (rise_.peak + fall_.peak) + rise_.hold + fall_.hold + cruise_;
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
  put(cruises ? rise.fall_time : (rise_.peak + fall_.peak) * per_down_, from + sign * rise.hold_way,
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
