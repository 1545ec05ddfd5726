/// @file
/// Joints on a tool curve at one s: position by Newton from a guess, q' and q'' exactly.
#pragma once

#include <Eigen/QR>
#include <array>
#include <optional>

#include "viapoint/path/insertion.hpp"
#include "viapoint/path/joint_guide.hpp"

namespace viapoint {

/// Solves, for the coordinates that are held (x = tool position, and rotation for Hold::kPose),
///   J q' = x',   J q'' = x'' − J' q'.
/// For Hold::kAxis the two angular rates across the tool's z axis count, Eᵀω with E its x and y
/// axes, which turn with it: E' = ω × E.
/// With more joints than coordinates the least-norm rate is followed, q' = Jᵀλ, and its own exact
/// derivative, q'' = Jᵀλ' + J'ᵀλ, is taken; with a guide r, w and one joint more, w·(q − r) = 0 is
/// held as one row more: w·q' = w·r' − w'·(q − r), and so on. With fewer, the least-squares
/// solution, whose residual is kept. Rotation rows count in radians, position rows in shares of the
/// arm's reach.
class CurveFollower {
 public:
  /// Joints on the curve, and how well.
  struct Knot {
    PathPoint point;
    Deviation residual;          ///< of the position and angle at the knot
    double rate_residual = 0.0;  ///< ‖J q' − x'‖ / ‖x'‖ of the held coordinates
  };

  CurveFollower(const ForwardKinematics& arm, const TaskCurve& curve, const JointVector& start,
                const InsertionOptions& options);

  [[nodiscard]] int coordinates() const { return coordinates_; }  ///< 3, 5 or 6
  [[nodiscard]] int free_joints() const { return free_joints_; }  ///< those that follow the curve

  /// Newton's method from `guess`. Nothing when it does not come within a small part of the
  /// tolerances, or goes far from the guess.
  [[nodiscard]] std::optional<Knot> solve(double s, const JointVector& guess) const;
  /// q' and q'' at joints that lie on the curve at s.
  [[nodiscard]] Knot derivatives(double s, const JointVector& q) const;

  /// Damped least squares (Levenberg 1944) from `guess`, however far: the nearest the joints come
  /// to the curve at s. @return the misses of what is held, in the base frame [m, then rad], (6,)
  [[nodiscard]] Twist nearest_miss(double s, JointVector guess) const;
  /// The unit vector of joint rates that leave the curve's coordinates alone.
  /// @pre one joint more follows than coordinates are held
  [[nodiscard]] JointVector open_direction(const JointVector& q) const;
  /// Singular values of the held rows, largest first.
  [[nodiscard]] Eigen::VectorXd singular_values(const JointVector& q) const;
  /// The coordinates (x, y, z, then rotations) that the joints can move one by one while the others
  /// that are asked for stay.
  [[nodiscard]] std::array<bool, 6> holds(const JointVector& q) const;

 private:
  /// Held rows, with a guide one more, and free columns, on the stack.
  using Block =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 7, kMaxJoints>;
  using BlockTransposed =
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMaxJoints, 7>;
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 7, 1>;

  /// What a guide asks of q, q' and q'' in its direction.
  struct Guidance {
    JointVector w, w1, w2;  ///< the direction and its derivatives
    JointVector r, r1, r2;  ///< the joints and theirs
  };

  [[nodiscard]] Twist miss(double s, const Pose& pose) const;
  /// The rows that are held.
  [[nodiscard]] Rows held(const ChainFrames& frames, const Twist& twist) const;
  [[nodiscard]] Block held(const ChainFrames& frames, const Jacobian& jacobian) const;
  [[nodiscard]] std::optional<Guidance> guidance(double s) const;
  /// With the guide's row below.
  [[nodiscard]] static Block with_row(Block block, const std::optional<Guidance>& guidance);
  [[nodiscard]] static Rows with_value(Rows rows, double value);
  /// The derivative by s of the held rows of J. @param w the tool's angular rate
  [[nodiscard]] Block held_rate(const ChainFrames& frames, const Jacobian& jacobian,
                                const Jacobian& jacobian_rate, const Eigen::Vector3d& w) const;
  /// The joints that do not follow the curve, put where they belong at s.
  void place_wrist(double s, JointVector& q) const;

  const ForwardKinematics& arm_;
  const TaskCurve& curve_;
  JointVector start_;
  InsertionOptions options_;
  int coordinates_;
  int free_joints_;
  double reach_;            ///< [m] that counts as much as a radian
  JointVector wrist_rate_;  ///< q' of the joints that go straight; zero for the others
};

}  // namespace viapoint
