/// @file
/// Laws of constant acceleration from rest to rest: linear segment with parabolic blends (LSPB, the
/// trapezoid of velocity) and bang-bang, its shortest form.
#pragma once

#include "viapoint/profile/axis_law.hpp"

namespace viapoint {

/// A trapezoid of velocity: ramp up for blend_time, cruise, ramp down for blend_time.
struct Trapezoid {
  AxisLaw law;
  double velocity = 0.0;      ///< of the linear part, signed [1/s]
  double acceleration = 0.0;  ///< of the first blend, signed [1/s²]
  double blend_time = 0.0;    ///< [s]
};

/// LSPB from q0 to q1 in `duration`, with a third of it in each blend.
/// (Spong, Hutchinson & Vidyasagar 2006, §5.5.2, for all three forms.)
/// @throws MotionError(kBadArgument) unless all is finite and duration > 0
[[nodiscard]] Trapezoid lspb(double q0, double q1, double duration);
/// LSPB with a chosen blend time. @throws MotionError(kBadArgument) unless
/// 0 < blend_time <= duration / 2; the message names that range
[[nodiscard]] Trapezoid lspb_with_blend_time(double q0, double q1, double duration,
                                             double blend_time);
/// LSPB with a chosen linear velocity (with the sign of q1 − q0). @throws MotionError(kBadArgument)
/// unless |q1 − q0|/duration < |velocity| <= 2 |q1 − q0|/duration; the message names that range
[[nodiscard]] Trapezoid lspb_with_velocity(double q0, double q1, double duration, double velocity);

/// The quickest move from rest to rest under limits on velocity and acceleration: a trapezoid, or
/// bang-bang where the velocity is not reached (Biagiotti & Melchiorri 2008, §3.2.3).
/// @throws MotionError(kBadArgument) unless limits > 0, all is finite and q0 != q1
[[nodiscard]] Trapezoid quickest_trapezoid(double q0, double q1, double velocity,
                                           double acceleration);

/// The quickest move from rest to rest under an acceleration limit: half the time each way,
/// t_s = √(|q1 − q0|/a) to the switch.
/// @throws MotionError(kBadArgument) unless acceleration > 0, all is finite and q0 != q1
[[nodiscard]] Trapezoid bang_bang(double q0, double q1, double acceleration);

}  // namespace viapoint
