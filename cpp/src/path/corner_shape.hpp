/// @file
/// The shape of one corner for given cuts, and proven measures of it.
///
/// Between straight legs that meet in C with unit directions u1, u2 and cuts d1, d2 the blend is
/// the quintic Bézier with the control points C − d1·u1, C − d1/2·u1, C, C, C + d2/2·u2, C + d2·u2:
///   b(u) = C − α(u) d1 u1 + β(u) d2 u2,
///   α(u) = (1 − u)⁴ (1 + 3u/2) = 1 − 5u/2 + 5u³ − 5u⁴ + 3u⁵/2,   β(u) = α(1 − u).
/// In Hermite form: q, q' of the legs at the cuts over a length h of s with h‖q'‖ = 5/2·cut, q''
/// that of the legs. The same rule on curved legs makes the blend C² whatever they are.
///
/// Distance. Let u* be where the blend comes nearest to C, ρ = α(u*)/β(u*). Pair b(u) with the
/// point of leg 1 at the share a(u) = α(u) − ρβ(u) of its cut for u <= u*, and with that of leg 2
/// at the share β(u) − α(u)/ρ beyond. Both run monotonously over the whole of their cuts, so the
/// largest distance of the pairs bounds the distance both ways (Hausdorff); on straight legs it is
/// ‖b(u*) − C‖, which is the least that any pairing can have: nothing is given away.
#pragma once

#include <functional>
#include <limits>

#include "path/tool_motion.hpp"

namespace viapoint {

/// Two legs that meet. Cuts are in each leg's own s, counted from the corner.
class CornerLegs {
 public:
  enum Side { kBefore, kAfter };

  CornerLegs(const JointPath& before, const JointPath& after);

  [[nodiscard]] const JointPath& path(Side side) const {
    return side == kBefore ? before_ : after_;
  }
  /// Joints on a leg, `cut` from the corner.
  [[nodiscard]] PathPoint at_cut(Side side, double cut) const;
  [[nodiscard]] const JointVector& corner() const { return corner_; }
  [[nodiscard]] JointVector direction_before() const;
  [[nodiscard]] JointVector direction_after() const;
  /// True where the leg is a straight line in joint space from the corner to the cut.
  [[nodiscard]] bool is_straight(Side side, double cut) const;
  /// Joint distance [2-norm] between the corner and the cut.
  [[nodiscard]] double chord(Side side, double cut) const;
  /// The cut with this chord, or `room` where the chord there is shorter.
  [[nodiscard]] double cut_of_chord(Side side, double chord, double room) const;
  /// The nearest cut where `inside` ends, or `room` where it does not end (by samples).
  [[nodiscard]] double cut_while(Side side, double room,
                                 const std::function<bool(const JointVector&)>& inside) const;
  /// Largest |q_i| along both, (n,).
  [[nodiscard]] JointVector travel() const;

 private:
  const JointPath& before_;
  const JointPath& after_;
  JointVector corner_;
};

class CornerShape {
 public:
  CornerShape(const CornerLegs& legs, double cut_before, double cut_after);

  /// Both cuts longer than `shortest` in joint distance, and a blend that can be run.
  [[nodiscard]] bool valid(double shortest) const;
  [[nodiscard]] double cut_before() const { return cut_before_; }
  [[nodiscard]] double cut_after() const { return cut_after_; }
  [[nodiscard]] double scale_after() const { return scale_after_; }
  [[nodiscard]] const JointPiece& blend() const { return blend_; }

  /// Largest distance of blend and cut parts from the corner, proven. Above `give_up` it only
  /// tells that.
  [[nodiscard]] double bound_radius(const MotionSpace& space, double resolution,
                                    double give_up) const;
  /// Largest distance both ways between the blend and the cut parts, proven.
  [[nodiscard]] double bound_deviation_from_legs(const MotionSpace& space, double resolution,
                                                 double share) const;
  /// Largest angle between the tool's orientation on blend and cut parts and that at the corner,
  /// proven. Above `give_up` it only tells that.
  [[nodiscard]] double bound_turn(const MotionSpace& tool, double resolution, double give_up) const;
  /// Largest angle between the tool's orientations on the blend and on the cut parts, proven for
  /// the pairing above with the u* of `space`: what lies side by side is turned alike.
  [[nodiscard]] double bound_turn_from_legs(const MotionSpace& space, const MotionSpace& tool,
                                            double resolution, double share) const;
  /// Least distance of the blend from the corner: the deviation is this or more, and nearly always
  /// just this. Quick, and no bound.
  [[nodiscard]] double distance_from_corner(const MotionSpace& space) const;
  /// The tool's angle there from that at the corner.
  [[nodiscard]] double turn_from_corner(const MotionSpace& space, const MotionSpace& tool) const;

 private:
  using Polynomial6 = Eigen::Matrix<double, 6, 1>;

  /// u* in `space`, by samples; any value gives a valid bound, the best one the tightest.
  [[nodiscard]] double nearest_to_corner(const MotionSpace& space) const;
  /// The cut part of a leg over u in [0, 1].
  [[nodiscard]] PathMotion cut_part(CornerLegs::Side side) const;
  /// s of the leg before / after over u for the pairing above.
  [[nodiscard]] Polynomial6 s_before(double u_star) const;
  [[nodiscard]] Polynomial6 s_after(double u_star) const;

  const CornerLegs& legs_;
  double cut_before_;
  double cut_after_;
  double chord_before_;
  double chord_after_;
  double scale_after_ = 1.0;
  JointPiece blend_;
};

}  // namespace viapoint
