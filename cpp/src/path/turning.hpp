/// @file
/// How far two turning frames come apart, proven over an interval.
#pragma once

#include "viapoint/core/pose.hpp"

namespace viapoint {

/// A frame that turns with a parameter t, about t = 0: its rate w and w' there, and suprema of
/// their sizes and that of w'' over |t| <= half. All in the base frame.
struct Turning {
  Eigen::Matrix3d rotation;
  Eigen::Vector3d w, w1;
  double sup_w = 0.0, sup_w1 = 0.0, sup_w2 = 0.0;
};

/// With the suprema that follow from that of w''.
[[nodiscard]] Turning turning_about(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& w,
                                    const Eigen::Vector3d& w1, double sup_w2, double half);

/// sup ‖e + e'·t + e''·t²/2‖ for |t| <= half: a norm is convex, so the control points of the
/// quadratic (Bernstein form) bound it.
[[nodiscard]] double quadratic_bound(const Eigen::Vector3d& e, const Eigen::Vector3d& e1,
                                     const Eigen::Vector3d& e2, double half);

/// Bounds the angle of Q = R_bᵀ R_a over |t| <= half. Its left rate is v = R_bᵀ (w_a − w_b). The
/// rotation vector φ of Q obeys φ' = J⁻¹(φ) v with the inverse left Jacobian of SO(3) (Bullo &
/// Murray 1995), and ‖J⁻¹(φ) − I‖ <= ½‖φ‖ + 0.0848 ‖φ‖² <= 0.585 ‖φ‖ for ‖φ‖ <= 1. So φ is the
/// quadratic φ(0) + v t + v' t²/2 up to sup‖v''‖ half³/6 + 0.585 sup‖φ‖ sup‖v‖ half.
/// @param phi φ(0)
[[nodiscard]] double angle_bound(const Eigen::Vector3d& phi, const Turning& a, const Turning& b,
                                 double half);

}  // namespace viapoint
