#include "path/curve_follower.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "path/deviation.hpp"
#include "viapoint/core/units.hpp"

namespace viapoint {
namespace {

constexpr int kNewtonSteps = 12;
/// Knots take this part of the tolerances at most; the deviation proof counts what they take.
constexpr double kKnotShare = 1e-3;
/// Below this a further Newton step only moves rounding (coordinates scaled to the reach).
constexpr double kConverged = 1e-14;
/// A correction larger than this [rad or m] has left the branch that was extrapolated.
constexpr double kLargestCorrection = 0.7;
/// Singular directions below this share of the largest are left alone (least norm).
constexpr double kRankThreshold = 1e-10;
constexpr int kDampedSteps = 60;
/// Position and the direction of an axis.
constexpr int kAxisCoordinates = 5;

int coordinates_of(Hold hold) {
  if (hold == Hold::kPose) return 6;
  return hold == Hold::kAxis ? kAxisCoordinates : 3;
}

/// The tool's x and y axes.
using AcrossAxis = Eigen::Matrix<double, 3, 2>;
AcrossAxis across_axis(const ChainFrames& frames) {
  return frames.pose_base_tool.linear().leftCols<2>();
}

/// The rotation vector that brings one direction to the other by the least turn; of opposite ones,
/// about any axis across.
Eigen::Vector3d least_turn(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d across = from.cross(to);
  const double sine = across.norm();
  if (sine == 0.0) {
    if (from.dot(to) > 0.0) return Eigen::Vector3d::Zero();
    return kPi * from.unitOrthogonal();
  }
  return angle_between(from, to) / sine * across;
}

}  // namespace

CurveFollower::CurveFollower(const ForwardKinematics& arm, const TaskCurve& curve,
                             const JointVector& start, const InsertionOptions& options)
    : arm_(arm),
      curve_(curve),
      start_(start),
      options_(options),
      coordinates_(coordinates_of(options.hold)),
      free_joints_(options.hold == Hold::kWrist ? std::min(3, arm.joints()) : arm.joints()),
      reach_(1.0),
      wrist_rate_(JointVector::Zero(arm.joints())) {
  const double reach = arm.reach_bound(start.cwiseAbs()).maxCoeff();
  if (reach > 0.0) reach_ = reach;
  for (int i = free_joints_; i < arm.joints(); ++i) {
    wrist_rate_[i] = (options.wrist_goal[i] - start[i]) / curve.length();
  }
}

Twist CurveFollower::miss(double s, const Pose& pose) const {
  const CurvePoint wanted = curve_.at(s);
  Twist miss = Twist::Zero();
  miss.head<3>() = wanted.p - pose.translation();
  if (coordinates_ == 6) {
    miss.tail<3>() = rotation_log(wanted.rotation * pose.linear().transpose());
  } else if (coordinates_ == kAxisCoordinates) {
    miss.tail<3>() = least_turn(pose.linear().col(2), wanted.rotation.col(2));
  }
  return miss;
}

CurveFollower::Rows CurveFollower::held(const ChainFrames& frames, const Twist& twist) const {
  Rows rows = twist.head(coordinates_);
  rows.head<3>() /= reach_;
  if (coordinates_ == kAxisCoordinates) {
    rows.tail<2>() = across_axis(frames).transpose() * twist.tail<3>();
  }
  return rows;
}

CurveFollower::Block CurveFollower::held(const ChainFrames& frames,
                                         const Jacobian& jacobian) const {
  Block block = jacobian.topLeftCorner(coordinates_, free_joints_);
  block.topRows<3>() /= reach_;
  if (coordinates_ == kAxisCoordinates) {
    block.bottomRows<2>() =
        across_axis(frames).transpose() * jacobian.bottomRows<3>().leftCols(free_joints_);
  }
  return block;
}

CurveFollower::Block CurveFollower::held_rate(const ChainFrames& frames, const Jacobian& jacobian,
                                              const Jacobian& jacobian_rate,
                                              const Eigen::Vector3d& w) const {
  Block block = held(frames, jacobian_rate);
  if (coordinates_ == kAxisCoordinates) {
    const AcrossAxis across = across_axis(frames);
    AcrossAxis across_rate;
    across_rate << w.cross(across.col(0)), w.cross(across.col(1));
    block.bottomRows<2>() +=
        across_rate.transpose() * jacobian.bottomRows<3>().leftCols(free_joints_);
  }
  return block;
}

std::optional<CurveFollower::Guidance> CurveFollower::guidance(double s) const {
  if (options_.guide == nullptr) return std::nullopt;
  const PathPoint direction = options_.guide->direction.at(s);
  const PathPoint joints = options_.guide->joints.at(s);
  return Guidance{direction.q, direction.q1, direction.q2, joints.q, joints.q1, joints.q2};
}

CurveFollower::Block CurveFollower::with_row(Block block, const std::optional<Guidance>& guidance) {
  if (!guidance) return block;
  block.conservativeResize(block.rows() + 1, Eigen::NoChange);
  block.bottomRows<1>() = guidance->w.transpose();
  return block;
}

CurveFollower::Rows CurveFollower::with_value(Rows rows, double value) {
  rows.conservativeResize(rows.size() + 1);
  rows[rows.size() - 1] = value;
  return rows;
}

void CurveFollower::place_wrist(double s, JointVector& q) const {
  for (int i = free_joints_; i < arm_.joints(); ++i) q[i] = start_[i] + wrist_rate_[i] * s;
}

std::optional<CurveFollower::Knot> CurveFollower::solve(double s, const JointVector& guess) const {
  JointVector q = guess;
  place_wrist(s, q);
  const JointVector from = q;
  const std::optional<Guidance> guide = guidance(s);
  const auto rows_of = [&](const ChainFrames& at, const Twist& missed, const JointVector& joints) {
    const Rows rows = held(at, missed);
    return guide ? with_value(rows, guide->w.dot(guide->r - joints)) : rows;
  };
  ChainFrames frames = arm_.frames(q);
  Twist error = miss(s, frames.pose_base_tool);
  Rows rows = rows_of(frames, error, q);
  double size = rows.norm();
  for (int step = 0; step < kNewtonSteps && size > kConverged; ++step) {
    Eigen::CompleteOrthogonalDecomposition<Block> solver;
    solver.setThreshold(kRankThreshold);
    solver.compute(with_row(held(frames, arm_.jacobian(frames)), guide));
    JointVector trial = q;
    trial.head(free_joints_) += solver.solve(rows);
    if (!trial.allFinite() || (trial - from).lpNorm<Eigen::Infinity>() > kLargestCorrection) {
      return std::nullopt;
    }
    const ChainFrames trial_frames = arm_.frames(trial);
    const Twist trial_error = miss(s, trial_frames.pose_base_tool);
    const Rows trial_rows = rows_of(trial_frames, trial_error, trial);
    const double trial_size = trial_rows.norm();
    // Near a solution a step that no longer gains is rounding; far from one it is divergence, and
    // the test of the residual below tells.
    if (step > 2 && trial_size >= size) break;
    q = trial;
    frames = trial_frames;
    error = trial_error;
    rows = trial_rows;
    size = trial_size;
  }
  const Deviation residual = {error.head<3>().norm(), error.tail<3>().norm()};
  if (!(residual.position <= kKnotShare * options_.position_tolerance)) return std::nullopt;
  if (coordinates_ != 3 && !(residual.angle <= kKnotShare * options_.angle_tolerance)) {
    return std::nullopt;
  }
  return derivatives(s, q);
}

CurveFollower::Knot CurveFollower::derivatives(double s, const JointVector& q) const {
  const ChainFrames frames = arm_.frames(q);
  const CurvePoint wanted = curve_.at(s);
  const Jacobian jacobian = arm_.jacobian(frames);
  const Block block = held(frames, jacobian);
  const std::optional<Guidance> guide = guidance(s);
  Eigen::CompleteOrthogonalDecomposition<Block> solver;
  solver.setThreshold(kRankThreshold);
  solver.compute(with_row(block, guide));
  const JointVector off = guide ? JointVector(q - guide->r) : JointVector();

  Knot knot;
  const Twist error = miss(s, frames.pose_base_tool);
  knot.residual = {error.head<3>().norm(), error.tail<3>().norm()};
  knot.point.q = q;
  knot.point.q1 = wrist_rate_;
  Twist rate;
  rate << wanted.p1, wanted.w;
  const Rows wanted_rate = held(frames, rate);
  const Rows by_free = held(frames, Twist(rate - jacobian * wrist_rate_));
  knot.point.q1.head(free_joints_) =
      guide ? solver.solve(with_value(by_free, guide->w.dot(guide->r1) - guide->w1.dot(off)))
            : solver.solve(by_free);
  const double rate_size = wanted_rate.norm();
  const Rows rate_miss = block * knot.point.q1.head(free_joints_) - by_free;
  knot.rate_residual = rate_size > 0.0 ? rate_miss.norm() / rate_size : 0.0;

  const Jacobian jacobian_rate = arm_.jacobian_rate(frames, knot.point.q1);
  Twist rate_change;
  rate_change << wanted.p2, wanted.w1;
  rate_change -= jacobian_rate * knot.point.q1;
  // From (Eᵀ(ω − ω_c))' = 0, where ω is the tool's rate and ω_c the curve's.
  const Eigen::Vector3d tool_rate = (jacobian * knot.point.q1).tail<3>();
  if (coordinates_ == kAxisCoordinates) rate_change.tail<3>() -= tool_rate.cross(wanted.w);
  knot.point.q2 = JointVector::Zero(arm_.joints());
  const Rows change = held(frames, rate_change);
  if (guide) {
    const double along = guide->w.dot(guide->r2) - 2.0 * guide->w1.dot(knot.point.q1 - guide->r1) -
                         guide->w2.dot(off);
    knot.point.q2.head(free_joints_) = solver.solve(with_value(change, along));
  } else {
    knot.point.q2.head(free_joints_) = solver.solve(change);
  }
  if (!guide && free_joints_ > coordinates_) {
    // The derivative of least norm lacks what turns the row space of J: (I − J⁺J) J'ᵀλ.
    const BlockTransposed transposed = block.transpose();
    Eigen::CompleteOrthogonalDecomposition<BlockTransposed> dual;
    dual.setThreshold(kRankThreshold);
    dual.compute(transposed);
    const JointVector q1_free = knot.point.q1.head(free_joints_);
    const Rows lambda = dual.solve(q1_free);
    const JointVector turn =
        held_rate(frames, jacobian, jacobian_rate, tool_rate).transpose() * lambda;
    const Rows seen = block * turn;
    knot.point.q2.head(free_joints_) += turn - solver.solve(seen);
  }
  knot.point.q3 = JointVector::Zero(arm_.joints());
  return knot;
}

Twist CurveFollower::nearest_miss(double s, JointVector guess) const {
  place_wrist(s, guess);
  double damping = 1e-3;
  ChainFrames frames = arm_.frames(guess);
  Twist error = miss(s, frames.pose_base_tool);
  for (int step = 0; step < kDampedSteps && held(frames, error).norm() > 1e-12; ++step) {
    const Block block = held(frames, arm_.jacobian(frames));
    JointMatrix normal = block.transpose() * block;
    normal.diagonal().array() += damping;
    const JointVector right = block.transpose() * held(frames, error);
    JointVector trial = guess;
    trial.head(free_joints_) += normal.ldlt().solve(right);
    const ChainFrames trial_frames = arm_.frames(trial);
    const Twist trial_error = miss(s, trial_frames.pose_base_tool);
    if (held(trial_frames, trial_error).norm() < held(frames, error).norm()) {
      guess = trial;
      frames = trial_frames;
      error = trial_error;
      damping = std::max(0.1 * damping, 1e-14);
    } else {
      damping *= 10.0;
      if (damping > 1e6) break;
    }
  }
  return error;
}

JointVector CurveFollower::open_direction(const JointVector& q) const {
  const ChainFrames frames = arm_.frames(q);
  const BlockTransposed transposed = held(frames, arm_.jacobian(frames)).transpose();
  const Eigen::ColPivHouseholderQR<BlockTransposed> factors(transposed);
  // The last column of Q is square to all rows.
  JointVector direction = JointVector::Unit(free_joints_, free_joints_ - 1);
  direction.applyOnTheLeft(factors.householderQ());
  return direction;
}

Eigen::VectorXd CurveFollower::singular_values(const JointVector& q) const {
  const ChainFrames frames = arm_.frames(q);
  const Eigen::MatrixXd block = held(frames, arm_.jacobian(frames));
  return Eigen::JacobiSVD<Eigen::MatrixXd>(block).singularValues();
}

std::array<bool, 6> CurveFollower::holds(const JointVector& q) const {
  // A coordinate is free when its unit vector lies in what the joints can make of rates.
  constexpr double kIndependent = 1e-6;
  // In the base frame, also where an axis is held: these coordinates have names.
  const int coordinates = coordinates_ == kAxisCoordinates ? 6 : coordinates_;
  Eigen::MatrixXd block = arm_.jacobian(arm_.frames(q)).topLeftCorner(coordinates, free_joints_);
  block.topRows<3>() /= reach_;
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(block, Eigen::ComputeThinU);
  const Eigen::VectorXd& values = svd.singularValues();
  std::array<bool, 6> which{};
  for (Eigen::Index i = 0; i < coordinates; ++i) {
    double within = 0.0;
    for (Eigen::Index k = 0; k < values.size(); ++k) {
      if (values[k] > kIndependent * values[0]) {
        within += svd.matrixU()(i, k) * svd.matrixU()(i, k);
      }
    }
    which[static_cast<size_t>(i)] = within > 1.0 - kIndependent;
  }
  return which;
}

}  // namespace viapoint
