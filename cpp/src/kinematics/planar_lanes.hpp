/// @file
/// The steps that the closed forms of six-axis arms share, for four branches at once: arithmetic on
/// sines and cosines, in which the compiler fills the processor's wide registers.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>

#include "kinematics/angle_lanes.hpp"
#include "kinematics/closed_form.hpp"

namespace viapoint {

/// One value for each of four branches.
using Lanes = Eigen::Array<double, 4, 1>;

/// The first value for two lanes, then the second.
[[nodiscard]] inline Lanes in_pairs(const Eigen::Vector2d& values) {
  return {values[0], values[0], values[1], values[1]};
}

/// Cosines and sines of four angles.
struct LaneTurn {
  Lanes cosine = Lanes::Ones();
  Lanes sine = Lanes::Zero();

  /// Of the direction (cosine, sine), of any length but none.
  [[nodiscard]] static LaneTurn along(const Lanes& cosine, const Lanes& sine) {
    const Lanes scale = (cosine * cosine + sine * sine).sqrt().inverse();
    return {cosine * scale, sine * scale};
  }
};

/// One turn after the other.
[[nodiscard]] inline LaneTurn turned(const LaneTurn& a, const LaneTurn& b) {
  return {a.cosine * b.cosine - a.sine * b.sine, a.sine * b.cosine + a.cosine * b.sine};
}

/// The two ways joint 1 brings a point at `side` along axis 2 to (x, y), before and behind axis 1.
struct ShoulderTurns {
  double missing = 0.0;  ///< how far out of reach [m]
  double forward = 0.0;  ///< of the point, in the arm's plane, before joint 1 turns: ± this [m]
  Eigen::Vector2d cosine = Eigen::Vector2d::Zero();
  Eigen::Vector2d sine = Eigen::Vector2d::Zero();
  double off_square = 0.0;  ///< how far the point misses (x, y), squared [m²]
  bool meet = false;        ///< both are one, or nearly
};
/// @param held joint 1 where the point lies on axis 1 [rad]
[[nodiscard]] ShoulderTurns turn_shoulder(double x, double y, double side, double held);

/// A planar arm with links a and b that spans `span`.
struct LaneElbow {
  LaneTurn bend;  ///< of the forearm against the upper arm; 0 is stretched
  Lanes missing;  ///< how far out of reach; solved up to kBoundary [m]
};
/// @param side +1 or -1: the way it bends
[[nodiscard]] inline LaneElbow bend_elbow(double a, double b, const Lanes& span,
                                          const Lanes& side) {
  const double apart = std::abs(a - b);
  const Lanes stretched = (a + b) - span;
  const Lanes folded = span - apart;
  // 1 − cos γ = (a + b − r)(a + b + r)/2ab and 1 + cos γ = (r − |a − b|)(r + |a − b|)/2ab: the
  // factors vanish at the boundary, so that no digits are lost there.
  const Lanes minus = stretched.max(0.0) * ((a + b) + span);
  const Lanes plus = folded.max(0.0) * (span + apart);
  const Lanes scale = (plus + minus).inverse();
  LaneElbow elbow;
  elbow.bend.cosine = (plus - minus) * scale;
  elbow.bend.sine = side * (2.0 * scale * (plus * minus).sqrt());
  elbow.missing = -stretched.min(folded);
  return elbow;
}

/// Angles that are found together at the end.
template <size_t Count>
class AngleLanes {
 public:
  void put(size_t at, const LaneTurn& turn) {
    std::copy_n(turn.cosine.data(), 4, cosines_.begin() + at);
    std::copy_n(turn.sine.data(), 4, sines_.begin() + at);
  }
  void put(size_t at, double cosine, double sine) {
    cosines_[at] = cosine;
    sines_[at] = sine;
  }
  void solve() { angles_of(sines_, cosines_, angles_); }
  [[nodiscard]] double operator[](size_t at) const { return angles_[at]; }

 private:
  std::array<double, Count> cosines_;
  std::array<double, Count> sines_;
  std::array<double, Count> angles_;
};

/// Branches whose joints differ by less than this sine may be one.
inline constexpr double kMeeting = 1e-8;
/// How far a branch may miss its pose in the form's own check: what is left is for an arm that is
/// not exactly the form's [m and rad].
inline constexpr double kFormTolerance = 0.9 * kPoseTolerance;

}  // namespace viapoint
