/// @file
#pragma once

#include "kinematics/forward_walk.hpp"
#include "kinematics/inverse_errors.hpp"
#include "viapoint/core/joint_limits.hpp"

namespace viapoint {

/// Levenberg–Marquardt on SE(3) with error-scaled damping (Sugihara 2011), from one start. The
/// budget is one of iterations, never of time. Immutable. Real-time: safe. Threads: any.
class Descent {
 public:
  /// @param length of the arm's size [m], to weigh metres against radians
  Descent(const ForwardKinematics& forward, const JointLimits& limits, double length);

  struct Options {
    bool bounded = false;  ///< within the limits all the way
    int iterations = 60;
    int patience = 12;     ///< steps without progress that end it
    double leash = 1e300;  ///< a joint that comes so far from the start ends it [rad or m]
  };
  /// Where a descent ended.
  struct End {
    JointVector q;
    PoseError error;
  };
  [[nodiscard]] End run(const InverseTask& task, const JointVector& start,
                        const Options& options) const;

 private:
  /// @tparam Joints of the chain, or Eigen::Dynamic; @tparam Rows of the task
  template <int Joints, int Rows>
  [[nodiscard]] End run_as(const InverseTask& task, const JointVector& start,
                           const Options& options) const;

  WalkedChain chain_;
  JointVector low_;
  JointVector high_;
  double length_;
};

}  // namespace viapoint
