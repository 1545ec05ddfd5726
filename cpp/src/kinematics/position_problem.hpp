/// @file
/// Which joints carry a point to its place: at most three joints, of any kind.
///
/// With E1 E2 E3 p = t the middle joint is eliminated: x = E3 p and y = E1⁻¹ t must be of one
/// height along axis 2 and at one distance from a point on it (E2 turns), or alike across its axis
/// in two directions (E2 slides). Where neighbouring axes are parallel, square or meet, one of the
/// two equations has one joint only, and everything follows (Pieper 1968).
#pragma once

#include <array>
#include <optional>
#include <span>

#include "kinematics/screw.hpp"

namespace viapoint {

/// One way to place the point.
struct PositionRoot {
  std::array<double, 3> q{};
  std::array<double, 3> side{};  ///< of each joint's choice, signed [rad or m]; 0 without one
};

struct PositionRoots {
  int count = 0;
  std::array<PositionRoot, 4> roots;
  double missing = 0.0;    ///< out of reach [m], when there is none
  double near_miss = 0.0;  ///< the least by which a root is missing, [m]; 0: none is
  bool held = false;       ///< a joint was free and was held
};

class PositionProblem {
 public:
  /// Nothing where no equation has one joint only.
  [[nodiscard]] static std::optional<PositionProblem> plan(std::span<const Screw> joints,
                                                           const Eigen::Vector3d& point);
  /// @param held (joints,), for what the target leaves free
  void solve(const Eigen::Vector3d& target, std::span<const double> held,
             PositionRoots& found) const;
  /// The joints with two sides, in the order of the chain.
  [[nodiscard]] std::array<bool, 3> choices() const { return choices_; }

 private:
  /// The two equations of a target: back(q1) = ahead(q3) in each row.
  struct Equations {
    Track back, ahead;
    std::array<JointTerm, 2> of_first, of_last;
  };
  PositionProblem() = default;
  [[nodiscard]] Equations equations(const Eigen::Vector3d& target) const;
  /// Finds the row to start with. @return false where both rows have both joints
  [[nodiscard]] bool decouple(std::span<const Screw> joints);
  /// Height of the point over the centre, along a turning axis 2; 0 where both joints change it.
  [[nodiscard]] double common_height(const Equations& rows) const;
  [[nodiscard]] Roots solve_row(int row, const JointTerm& term, double value, double height,
                                double& missing) const;

  static constexpr int kNone = -1;
  std::array<Screw, 3> joint_;  ///< first, middle, last
  std::array<int, 3> index_{kNone, kNone, kNone};
  Eigen::Vector3d point_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();  ///< on axis 2, when it turns
  std::array<Eigen::Vector3d, 2> across_;             ///< axis 2, when it slides
  double size_ = 1.0;                                 ///< of the arm [m]
  int row_ = 0;                                       ///< solved first
  bool last_first_ = false;                           ///< for the last joint
  std::array<bool, 3> choices_{};
};

}  // namespace viapoint
