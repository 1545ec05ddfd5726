/// @file
/// Inverse kinematics of any chain by damped least squares from many starts.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "kinematics/inverse_errors.hpp"
#include "kinematics/joint_turns.hpp"
#include "viapoint/kinematics/inverse_kinematics.hpp"

namespace viapoint {

/// Levenberg–Marquardt on SE(3) with error-scaled damping (Sugihara 2011), started from `near` and
/// from the points of a Halton sequence (Halton 1960), in turn free (wrapped into the limits at the
/// end) and held within the limits all the way. The budget is one of iterations, never of time: the
/// answer is the same on any machine under any load.
class NumericalInverse final : public InverseKinematics {
 public:
  NumericalInverse(const ForwardKinematics& forward, const JointLimits& limits, std::string why);

  [[nodiscard]] std::string family() const override;
  [[nodiscard]] std::vector<JointVector> solve_all(const Pose& pose_base_tool) const override;
  [[nodiscard]] JointVector solve_near(const Pose& pose_base_tool,
                                       const JointVector& near) const override;
  [[nodiscard]] std::vector<JointVector> solve_all(const Eigen::Vector3d& position) const override;
  [[nodiscard]] JointVector solve_near(const Eigen::Vector3d& position,
                                       const JointVector& near) const override;
  [[nodiscard]] JointVector solve_near_unlimited(const Pose& pose_base_tool,
                                                 const JointVector& near) const override;

 private:
  struct Task {
    Pose goal;
    bool position_only;
  };
  /// Where one descent ended.
  struct Descent {
    JointVector q;
    PoseError error;
  };
  /// What all starts together found.
  struct Search {
    std::vector<JointVector> inside;   ///< distinct branches within the limits
    std::vector<JointVector> outside;  ///< distinct branches that are not
    PoseError least{1e300, 1e300};     ///< nearest miss
    JointVector nearest;               ///< where that was
  };

  [[nodiscard]] PoseError error(const Task& task, const JointVector& q) const;
  /// @param patience steps without progress that end it
  [[nodiscard]] Descent descend(const Task& task, JointVector q, bool bounded, int iterations,
                                int patience) const;
  /// @param reference the turn nearest to it is kept; @param enough stop at so many branches
  [[nodiscard]] Search search(const Task& task, const JointVector& reference, int starts,
                              size_t enough) const;
  void add(const Task& task, const JointVector& branch, std::vector<JointVector>& branches) const;
  [[nodiscard]] JointVector start(int index) const;
  [[nodiscard]] std::vector<JointVector> all(const Task& task) const;
  [[nodiscard]] JointVector near(const Task& task, const JointVector& near) const;
  [[nodiscard]] bool redundant(const Task& task) const;
  [[noreturn]] void refuse(const Task& task, const Search& search) const;

  ForwardKinematics forward_;
  JointLimits limits_;
  JointTurns turns_;
  std::string why_;
  double length_ = 1.0;          ///< the arm's size [m], to weigh metres against radians
  std::array<bool, 6> moves_{};  ///< x, y, z, and turns about them: what the arm can move
};

}  // namespace viapoint
