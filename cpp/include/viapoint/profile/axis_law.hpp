/// @file
/// The course of one axis over a stretch of time: polynomials one after the other. Every law of
/// this module that has parts (blends, ramps, via points) is one of these.
#pragma once

#include <vector>

#include "viapoint/profile/polynomial.hpp"

namespace viapoint {

/// Immutable. Real-time: not (it owns a vector). Threads: any.
class AxisLaw {
 public:
  /// @param parts each begins where the one before ends; parts of no duration are dropped
  /// @throws MotionError(kBadArgument) for no part at all, parts that do not meet in time, or
  /// values that doubles do not hold
  explicit AxisLaw(std::vector<Polynomial> parts);
  /// The law of a jerk-limited move, from time 0. @throws MotionError(kBadArgument) if it has no
  /// phases
  explicit AxisLaw(const JerkProfile& profile);

  [[nodiscard]] double start() const { return parts_.front().t0; }
  [[nodiscard]] double end() const { return parts_.back().t1; }
  [[nodiscard]] double duration() const { return end() - start(); }
  [[nodiscard]] const std::vector<Polynomial>& parts() const { return parts_; }
  /// State at t; where two parts meet, that of the later one.
  /// @throws MotionError(kBadArgument) for a time outside [start(), end()] by more than rounding
  [[nodiscard]] AxisState at(double t) const;
  /// Extremes of the derivative of that order (0 to 3) over the whole law.
  [[nodiscard]] Extremes extremes(int derivative) const;

 private:
  std::vector<Polynomial> parts_;
};

/// At rest at q from t0 to t1. @throws MotionError(kBadArgument) unless all is finite and t0 < t1
[[nodiscard]] AxisLaw resting(double q, double t0, double t1);
/// The same course, `seconds` later (or, below 0, earlier). @throws MotionError(kBadArgument)
[[nodiscard]] AxisLaw delayed(const AxisLaw& law, double seconds);
/// The same way from the same start until `end`. In κ times the duration velocities are 1/κ of what
/// they were, accelerations 1/κ², jerks 1/κ³. @throws MotionError(kBadArgument) unless end >
/// start()
[[nodiscard]] AxisLaw stretched(const AxisLaw& law, double end);
/// The law with rest before and after it, so that it covers [t0, t1].
/// @throws MotionError(kBadArgument) where it would have to rest but its velocity there is not 0
[[nodiscard]] AxisLaw held(const AxisLaw& law, double t0, double t1);

}  // namespace viapoint
