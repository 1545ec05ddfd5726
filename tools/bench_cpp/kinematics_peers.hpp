/// @file
/// Solvers of others for the same arms, all in C++, to be timed beside ours.
#pragma once

#include <cmath>
#include <cstddef>
#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainiksolverpos_lma.hpp>
#include <kdl/chainiksolverpos_nr_jl.hpp>
#include <kdl/chainiksolvervel_pinv.hpp>
#include <numbers>
#include <optional>
#include <random>

#include "viapoint/kinematics/robot_model.hpp"

#ifdef VIAPOINT_EAIK
#include <EAIK.h>
#endif

namespace viapoint::bench {

inline KDL::Vector kdl_vector(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

inline KDL::Frame kdl_frame(const Pose& pose) {
  const Eigen::Matrix3d r = pose.linear();
  return {KDL::Rotation(r(0, 0), r(0, 1), r(0, 2), r(1, 0), r(1, 1), r(1, 2), r(2, 0), r(2, 1),
                        r(2, 2)),
          kdl_vector(pose.translation())};
}

/// Every frame of the chain is the base's at q = 0, but for the tool's.
inline KDL::Chain kdl_chain(const ForwardKinematics& forward) {
  const ChainFrames zero = forward.frames(JointVector::Zero(forward.joints()));
  KDL::Chain chain;
  for (int i = 0; i < forward.joints(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    const auto type =
        forward.type(i) == JointType::kRevolute ? KDL::Joint::RotAxis : KDL::Joint::TransAxis;
    const KDL::Joint joint("joint", kdl_vector(zero.origin[k]), kdl_vector(zero.axis[k]), type);
    const bool last = i + 1 == forward.joints();
    chain.addSegment(
        KDL::Segment(joint, last ? kdl_frame(zero.pose_base_tool) : KDL::Frame::Identity()));
  }
  return chain;
}

/// KDL's two solvers, each from the joints given and then from up to nine seeded ones, until an
/// answer lies within the limits.
class KdlSolvers {
 public:
  explicit KdlSolvers(const RobotModel& robot)
      : robot_(robot),
        chain_(kdl_chain(robot.forward())),
        low_(kdl_joints(robot.limits().position_min)),
        high_(kdl_joints(robot.limits().position_max)) {}

  [[nodiscard]] std::optional<JointVector> lma(const Pose& pose, const JointVector& near) {
    return restarted(pose, near, lma_);
  }
  [[nodiscard]] std::optional<JointVector> nr_jl(const Pose& pose, const JointVector& near) {
    return restarted(pose, near, nr_jl_);
  }

 private:
  static KDL::JntArray kdl_joints(const JointVector& q) {
    KDL::JntArray out(static_cast<unsigned>(q.size()));
    out.data = q;
    return out;
  }

  std::optional<JointVector> restarted(const Pose& pose, const JointVector& near,
                                       KDL::ChainIkSolverPos& solver) {
    constexpr int kStarts = 10;
    const KDL::Frame goal = kdl_frame(pose);
    KDL::JntArray from = kdl_joints(near);
    KDL::JntArray q(from.rows());
    for (int start = 0; start < kStarts; ++start) {
      if (solver.CartToJnt(from, goal, q) >= 0) {
        JointVector found = q.data;
        for (int i = 0; i < found.size(); ++i) found[i] = inside(i, found[i]);
        if (robot_.limits().contains(found, 1e-9)) return found;
      }
      for (unsigned i = 0; i < from.rows(); ++i) {
        from(i) = std::uniform_real_distribution<double>(low_(i), high_(i))(generator_);
      }
    }
    return std::nullopt;
  }

  /// By whole turns to where the joint's range begins, or within it.
  [[nodiscard]] double inside(int joint, double q) const {
    if (robot_.forward().type(joint) != JointType::kRevolute) return q;
    const auto i = static_cast<unsigned>(joint);
    constexpr double kTurn = 2.0 * std::numbers::pi;
    return q - kTurn * std::floor((q - low_(i)) / kTurn);
  }

  const RobotModel& robot_;
  KDL::Chain chain_;
  KDL::JntArray low_, high_;
  std::mt19937_64 generator_{3};
  KDL::ChainIkSolverPos_LMA lma_{chain_, 1e-9, 100, 1e-12};
  KDL::ChainFkSolverPos_recursive forward_{chain_};
  KDL::ChainIkSolverVel_pinv velocity_{chain_};
  KDL::ChainIkSolverPos_NR_JL nr_jl_{chain_, low_, high_, forward_, velocity_, 100, 1e-9};
};

#ifdef VIAPOINT_EAIK
/// EAIK's robot of the same axes and points.
inline EAIK::Robot eaik_robot(const ForwardKinematics& forward) {
  const int n = forward.joints();
  const ChainFrames zero = forward.frames(JointVector::Zero(n));
  Eigen::MatrixXd axes(3, n);
  Eigen::MatrixXd points(3, n + 1);
  Eigen::Vector3d before = Eigen::Vector3d::Zero();
  for (int i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    axes.col(i) = zero.axis[k];
    points.col(i) = zero.origin[k] - before;
    before = zero.origin[k];
  }
  points.col(n) = zero.pose_base_tool.translation() - before;
  return EAIK::Robot(axes, points, zero.pose_base_tool.linear());
}
#endif

}  // namespace viapoint::bench
