/// @file
/// Joint motions over a common parameter u, and proven bounds of how far apart two of them come, at
/// the tool or in joint space: what the proof of a corner's zone is made of.
#pragma once

#include <array>
#include <limits>
#include <span>

#include "path/chain_bounds.hpp"
#include "path/turning.hpp"
#include "viapoint/path/joint_path.hpp"

namespace viapoint {

/// A joint motion around one u: value and derivatives by u in the middle of an interval, and
/// suprema of the derivatives over all of it.
struct LocalMotion {
  PathPoint at;
  JointSuprema sup;
};

/// Joints as a function of u with a bounded third derivative (C² at knots).
class JointMotion {
 public:
  virtual ~JointMotion() = default;
  [[nodiscard]] virtual JointVector at(double u) const = 0;
  /// Over [middle - half, middle + half].
  [[nodiscard]] virtual LocalMotion over(double middle, double half) const = 0;
};

/// A whole piece, u in [0, 1].
class PieceMotion final : public JointMotion {
 public:
  explicit PieceMotion(const JointPiece& piece);
  [[nodiscard]] JointVector at(double u) const override;
  [[nodiscard]] LocalMotion over(double middle, double half) const override;

 private:
  JointPiece piece_;
};

/// A path walked by s = σ(u), σ a quintic in u that is monotone where it is used.
class PathMotion final : public JointMotion {
 public:
  /// @param s_of_u coefficients of u^0 … u^5; values are clamped to the path
  PathMotion(const JointPath& path, const Eigen::Matrix<double, 6, 1>& s_of_u);
  [[nodiscard]] JointVector at(double u) const override;
  [[nodiscard]] LocalMotion over(double middle, double half) const override;

 private:
  const JointPath& path_;
  JointPiece s_of_u_;  ///< one column
};

/// Rests at one point.
class RestMotion final : public JointMotion {
 public:
  explicit RestMotion(const JointVector& q);
  [[nodiscard]] JointVector at(double u) const override;
  [[nodiscard]] LocalMotion over(double middle, double half) const override;

 private:
  LocalMotion local_;
};

/// Where two motions are compared, and at the tool their orientations, too.
class MotionSpace {
 public:
  /// In joint space, 2-norm over all joints.
  MotionSpace() = default;
  /// At the tool point. @param travel largest |q_i| that occurs, (n,); counts for prismatic joints
  MotionSpace(const ForwardKinematics& arm, const JointVector& travel);
  /// True for the joints' own space.
  [[nodiscard]] bool is_joint_space() const { return arm_ == nullptr; }

  /// Distance of two joint positions [rad] or of the tool points [m].
  [[nodiscard]] double distance(const JointVector& a, const JointVector& b) const;

  /// A bound of the distance between the motions at equal u, for all u in [u0, u1]: never too
  /// small, and above a distance that is reached by `resolution` + `share` of it at most.
  /// Taylor about the middle of subintervals: e, e' and e'' exact, remainder by chain_bounds.hpp.
  /// @param reached a distance known to be reached: what is below is not looked at closely
  /// @param give_up the search ends early, with a value above this, once the distance exceeds it
  [[nodiscard]] double bound_distance(const JointMotion& a, const JointMotion& b, double u0,
                                      double u1, double resolution, double share, double reached,
                                      double give_up) const;

  /// Angle between the tool's orientations [rad]. @pre not the joints' own space
  [[nodiscard]] double angle(const JointVector& a, const JointVector& b) const;
  /// bound_distance() of that angle. @pre not the joints' own space
  [[nodiscard]] double bound_angle(const JointMotion& a, const JointMotion& b, double u0, double u1,
                                   double resolution, double share, double reached,
                                   double give_up) const;

  /// A bound of the distance of every point of `a` from the nearest point of any of `targets`, all
  /// over [0, 1]; resolution, share and reached as above. Each subinterval of `a` is compared with
  /// a stretch of a target around the nearest point, walked at the rate that follows it: any choice
  /// bounds the distance from above, a near one bounds it tightly.
  [[nodiscard]] double bound_directed(const JointMotion& a,
                                      std::span<const JointMotion* const> targets,
                                      double resolution, double share, double reached) const;

 private:
  static constexpr size_t kTargetSamples = 16;
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxJoints, 1>;
  struct Expansion {
    Vector value, first, second;
    double third = 0.0;  ///< bound of the norm
  };
  /// A motion to come near to, and points along it to begin the search at.
  struct Target {
    const JointMotion* motion = nullptr;
    std::array<Vector, kTargetSamples + 1> points;
  };
  /// Where a target comes near to a point.
  struct Nearest {
    const JointMotion* target = nullptr;
    double u = 0.0;
    double distance = std::numeric_limits<double>::infinity();
  };

  [[nodiscard]] Expansion expand(const LocalMotion& local) const;
  [[nodiscard]] Turning expand_turn(const LocalMotion& local, double half) const;
  [[nodiscard]] Vector point(const JointMotion& motion, double u) const;
  [[nodiscard]] Nearest nearest(const Vector& wanted, const Target& target) const;
  /// sup ‖a − b‖ over |t| <= half from the expansions of both about t = 0.
  [[nodiscard]] static double bound_difference(const Expansion& a, const Expansion& b, double half);

  const ForwardKinematics* arm_ = nullptr;
  JointVector reach_;
};

}  // namespace viapoint
