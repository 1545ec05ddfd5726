/// @file
/// What the closed forms have in common.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "kinematics/inverse_errors.hpp"
#include "viapoint/kinematics/branch_set.hpp"
#include "viapoint/kinematics/forward_kinematics.hpp"

namespace viapoint {

/// Signed distances from the singularities: each sign is one side of the configuration.
struct ArmSides {
  std::optional<double> shoulder;  ///< wrist to the plane of axis 1 parallel to axis 2 [m]
  std::optional<double> elbow;     ///< elbow from stretched or folded [rad]
  std::optional<double> wrist;     ///< wrist from the alignment of its axes [rad]
  double length = 1.0;             ///< the arm's length, to compare metres with radians [m]
};

/// One family of solutions, whole turns left aside.
struct ClosedBranch {
  JointVector q;
  /// Where two wrist joints turn about one line only q[first] + sign · q[second] = sum is
  /// determined [rad].
  bool wrist_free = false;
  int first = 0;
  int second = 0;
  double wrist_sum = 0.0;
  double wrist_sign = 1.0;
  ArmSides sides;  ///< of arms that have no formula for them
};

/// At most kMostBranches branches in a fixed place: no heap.
class BranchList {
 public:
  [[nodiscard]] int size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] ClosedBranch* begin() { return items_.data(); }
  [[nodiscard]] ClosedBranch* end() { return items_.data() + size_; }
  [[nodiscard]] const ClosedBranch* begin() const { return items_.data(); }
  [[nodiscard]] const ClosedBranch* end() const { return items_.data() + size_; }
  /// A new branch at the end; the last one is taken again when the list is full.
  [[nodiscard]] ClosedBranch& add() {
    if (size_ < kMostBranches) ++size_;
    ClosedBranch& branch = items_[static_cast<size_t>(size_ - 1)];
    branch.wrist_free = false;
    return branch;
  }
  template <typename Predicate>
  void keep_if(Predicate&& keep) {
    int kept = 0;
    for (int i = 0; i < size_; ++i) {
      const ClosedBranch& branch = items_[static_cast<size_t>(i)];
      if (!keep(branch)) continue;
      if (kept != i) items_[static_cast<size_t>(kept)] = branch;
      ++kept;
    }
    size_ = kept;
  }

 private:
  int size_ = 0;
  std::array<ClosedBranch, kMostBranches> items_;
};

/// What the closed form finds for one task.
struct ClosedSolutions {
  BranchList branches;
  double out_of_reach = 0.0;  ///< how far the wrist is out of reach [m]; 0 when it is not
  /// The least by which a branch is missing [m]; 0 where none is, or the form does not tell.
  double near_miss = 0.0;
  /// The form has put every branch through its own forward kinematics already.
  bool confirmed = false;
  bool meeting = true;  ///< two branches may be one
  /// A joint was held at a singular pose, and another value of it might do better.
  bool held = false;
};

/// The geometry of one kind of arm, read off its chain at q = 0. Immutable. Real-time: solve() is
/// safe. Threads: any.
class ClosedForm {
 public:
  virtual ~ClosedForm() = default;
  [[nodiscard]] virtual std::string family() const = 0;
  /// True where the solver can answer such a task: one of positions may need another closed form.
  [[nodiscard]] virtual bool answers(const InverseTask& task) const { return !task.position_only; }
  /// Every branch; where a joint is free it takes its value in `held`. @pre answers(task)
  virtual void solve(const InverseTask& task, const JointVector& held,
                     ClosedSolutions& solutions) const = 0;
  [[nodiscard]] virtual ArmSides sides(const JointVector& q) const = 0;
};

/// The closed form for this chain, or nothing.
[[nodiscard]] std::unique_ptr<const ClosedForm> recognise_closed_form(
    const ForwardKinematics& forward);

/// The closed form, of those with eight branches, of the true arm that this chain comes near, or
/// nothing.
[[nodiscard]] std::unique_ptr<const ClosedForm> recognise_nearly_closed_form(
    const ForwardKinematics& forward);

// What the solvers share.

/// How exactly axes must be parallel, square or concurrent for a closed form to be used.
inline constexpr double kExactAxes = 1e-9;
/// The same for an arm out of true, whose closed form gives starts only.
inline constexpr double kNearlyExactAxes = 0.02;
/// A wrist beyond the boundary by no more than this is taken to be on it [m]; the forward
/// kinematics still has to confirm the answer, to kPoseTolerance.
inline constexpr double kBoundary = 8e-10;
/// Below this sine of the wrist angle two joints turn about one line [rad].
inline constexpr double kWristSine = 2e-10;
/// Below this distance a direction is not determined [m].
inline constexpr double kOnAxis = 1e-10;

/// Point of line a nearest to line b; nothing when they are parallel.
[[nodiscard]] std::optional<Eigen::Vector3d> nearest_point(const Eigen::Vector3d& origin_a,
                                                           const Eigen::Vector3d& axis_a,
                                                           const Eigen::Vector3d& origin_b,
                                                           const Eigen::Vector3d& axis_b);

/// Base to frame S: origin on axis 1 at the height of axis 2, z along axis 1, y along axis 2.
[[nodiscard]] Pose shoulder_frame(const ChainFrames& zero);

/// Rotation about y and z by `angle`.
[[nodiscard]] Eigen::Matrix3d about_y(double angle);
[[nodiscard]] Eigen::Matrix3d about_z(double angle);

/// `angle` from the nearest multiple of π, in [0, π/2], with the sign of its sine.
[[nodiscard]] double from_half_turns(double angle);

}  // namespace viapoint
