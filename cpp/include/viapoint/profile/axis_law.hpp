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
  /// @throws MotionError(kBadArgument) for no part at all, or parts that do not meet in time
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

}  // namespace viapoint
