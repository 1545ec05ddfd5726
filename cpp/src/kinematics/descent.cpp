#include "kinematics/descent.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace viapoint {
namespace {

constexpr double kDamping = 0.02;  ///< λ = this · ‖e‖²
constexpr double kDampingFloor = 1e-15;
constexpr double kMostStep = 0.8;  ///< of one joint in one step [rad or m]
constexpr double kDone = 1e-13;    ///< error below which no step is of use

template <int Joints>
inline constexpr int kCapacity = Joints == Eigen::Dynamic ? kMaxJoints : Joints;
template <int Joints>
using Joint = Eigen::Matrix<double, Joints, 1, Eigen::ColMajor, kCapacity<Joints>, 1>;
template <int Joints, int Rows>
using TaskRows = Eigen::Matrix<double, Rows, Joints, Eigen::ColMajor, Rows, kCapacity<Joints>>;
template <int Size>
using Square = Eigen::Matrix<double, Size, Size, Eigen::ColMajor, kCapacity<Size>, kCapacity<Size>>;

/// b ← (A + damping I)⁻¹ b for a positive semidefinite A, by Cholesky's factors without roots.
/// Their pivots are at least the damping, but for rounding.
template <int Size>
void solve_damped(Square<Size>& a, double damping, Joint<Size>& b) {
  const Eigen::Index n = a.rows();
  for (Eigen::Index j = 0; j < n; ++j) {
    const double scale = 1.0 / std::max(a(j, j) + damping, damping);
    a(j, j) = scale;
    for (Eigen::Index k = j + 1; k < n; ++k) {
      const double factor = a(k, j) * scale;
      for (Eigen::Index i = k; i < n; ++i) a(i, k) -= factor * a(i, j);
      b[k] -= factor * b[j];
    }
  }
  for (Eigen::Index j = n; j-- > 0;) {
    double rest = b[j];
    for (Eigen::Index i = j + 1; i < n; ++i) rest -= a(i, j) * b[i];
    b[j] = rest * a(j, j);
  }
}

/// Pose and geometric Jacobian; the latter position over orientation, in the base frame.
template <int Joints>
struct Kinematics {
  Eigen::Matrix3d rotation;
  Eigen::Vector3d position;
  TaskRows<Joints, 6> jacobian;

  Kinematics(const WalkedChain& chain, const Joint<Joints>& q) {
    const Eigen::Index joints = q.size();
    jacobian.resize(6, joints);
    std::array<Eigen::Vector3d, static_cast<size_t>(kCapacity<Joints>)> axes;
    std::array<Eigen::Vector3d, static_cast<size_t>(kCapacity<Joints>)> origins;
    rotation.setIdentity();
    position.setZero();
    for (Eigen::Index i = 0; i < joints; ++i) {
      const auto k = static_cast<size_t>(i);
      chain.advance(static_cast<int>(i), q[i], rotation, position);
      axes[k] = rotation.col(2);
      origins[k] = position;
    }
    position += rotation * chain.tool_offset();
    rotation = (rotation * chain.tool_rotation()).eval();
    for (Eigen::Index i = 0; i < joints; ++i) {
      const auto k = static_cast<size_t>(i);
      if (chain.type(static_cast<int>(i)) == JointType::kPrismatic) {
        jacobian.col(i) << axes[k], Eigen::Vector3d::Zero();
      } else {
        jacobian.col(i) << axes[k].cross(position - origins[k]), axes[k];
      }
    }
  }
};

/// The damped least-squares step.
template <int Joints, int Rows>
Joint<Joints> damped_step(const TaskRows<Joints, Rows>& jacobian,
                          const Eigen::Matrix<double, Rows, 1>& miss, double damping) {
  if (jacobian.cols() > Rows) {
    Square<Rows> normal = jacobian * jacobian.transpose();
    Joint<Rows> force = miss;
    solve_damped<Rows>(normal, damping, force);
    return jacobian.transpose() * force;
  }
  Square<Joints> normal = jacobian.transpose() * jacobian;
  Joint<Joints> step = jacobian.transpose() * miss;
  solve_damped<Joints>(normal, damping, step);
  return step;
}

}  // namespace

Descent::Descent(const ForwardKinematics& forward, const JointLimits& limits, double length)
    : chain_(forward), low_(limits.position_min), high_(limits.position_max), length_(length) {}

Descent::End Descent::run(const InverseTask& task, const JointVector& start,
                          const Options& options) const {
  if (task.position_only) return run_as<Eigen::Dynamic, 3>(task, start, options);
  if (chain_.joints() == 6) return run_as<6, 6>(task, start, options);
  if (chain_.joints() == 7) return run_as<7, 6>(task, start, options);
  return run_as<Eigen::Dynamic, 6>(task, start, options);
}

template <int Joints, int Rows>
Descent::End Descent::run_as(const InverseTask& task, const JointVector& start,
                             const Options& options) const {
  const Joint<Joints> low = low_;
  const Joint<Joints> high = high_;
  Joint<Joints> q = start;
  if (options.bounded) q = q.cwiseMax(low).cwiseMin(high);
  Joint<Joints> best = q;
  PoseError least_error{1e300, 1e300};
  double least = 1e300;
  double before = 1e300;
  double caution = 1.0;  // more damping while the error grows: a goal out of reach bends the valley
  int idle = 0;
  const Joint<Joints> first = q;
  for (int iteration = 0; iteration < options.iterations; ++iteration) {
    const Kinematics<Joints> now(chain_, q);
    Eigen::Matrix<double, Rows, 1> miss;
    miss.template head<3>() = task.goal.translation() - now.position;
    PoseError error{miss.template head<3>().norm(), 0.0};
    miss.template head<3>() /= length_;
    if constexpr (Rows == 6) {
      const Eigen::Matrix3d rest = task.goal.linear() * now.rotation.transpose();
      miss.template tail<3>() = rotation_log(rest);
      error.angle = miss.template tail<3>().norm();
    }
    const double square = miss.squaredNorm();
    idle = square < 0.7 * least ? 0 : idle + 1;
    if (square < least) {
      least = square;
      best = q;
      least_error = error;
    }
    const bool solved = least_error.within(kPoseTolerance);
    if (error.within(kDone) || idle >= (solved ? 2 : options.patience)) break;

    caution = square > before ? std::min(4.0 * caution, 1e6) : std::max(0.7 * caution, 1.0);
    before = square;
    const double damping = kDamping * caution * square + kDampingFloor;
    TaskRows<Joints, Rows> jacobian = now.jacobian.template topRows<Rows>();
    jacobian.template topRows<3>() /= length_;
    Joint<Joints> step;
    // A joint on its limit that would go on outwards is held, and the others solve without it.
    for (Eigen::Index pass = 0; pass < q.size(); ++pass) {
      step = damped_step<Joints, Rows>(jacobian, miss, damping);
      if (!options.bounded) break;
      bool held = false;
      for (Eigen::Index i = 0; i < q.size(); ++i) {
        const bool outwards =
            (q[i] >= high[i] && step[i] > 0.0) || (q[i] <= low[i] && step[i] < 0.0);
        if (!outwards) continue;
        jacobian.col(i).setZero();
        held = true;
      }
      if (!held) break;
    }
    const double most = step.template lpNorm<Eigen::Infinity>();
    if (most > kMostStep) step *= kMostStep / most;
    q += step;
    if (options.bounded) q = q.cwiseMax(low).cwiseMin(high);
    if ((q - first).template lpNorm<Eigen::Infinity>() > options.leash) break;
  }
  return {best, least_error};
}

}  // namespace viapoint
