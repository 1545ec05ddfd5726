#include "path/deviation.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "path/chain_bounds.hpp"
#include "path/turning.hpp"
#include "viapoint/core/units.hpp"

namespace viapoint {
namespace {

/// A stretch of a piece, halved this often at most: below 2⁻⁴⁰ only rounding is left to refine.
constexpr int kDeepest = 40;
/// A piece that needs more stretches than this for its proof is too long: where it comes within a
/// hair of the tolerance the halving would go on at every depth. Pieces that pass need fewer than
/// 400, so that a shorter piece costs less than a further search.
constexpr int kMostStretches = 1000;

struct Stretch {
  double middle;
  double half;
  int depth;
};

/// What is known of a stretch: the deviation at its middle, and a bound over all of it.
struct StretchDeviation {
  Deviation at_middle;
  Deviation bound;
};

/// Derivatives of an axis z that turns at w, by z' = w × z: exact to the second, and a bound of the
/// third over |t| <= half from that of ‖w''‖ there,
///   z''' = w'' × z + 2 w' × z' + w × z'',   ‖z'''‖ <= ‖w''‖ + 3 ‖w'‖ ‖w‖ + ‖w‖³.
struct TurningAxis {
  Eigen::Vector3d first, second;
  double third;
};

TurningAxis turning(const Eigen::Vector3d& axis, const Eigen::Vector3d& w,
                    const Eigen::Vector3d& w1, double sup_w2, double half) {
  const double sup_w1 = w1.norm() + half * sup_w2;
  const double sup_w = w.norm() + half * (w1.norm() + 0.5 * half * sup_w2);
  const Eigen::Vector3d first = w.cross(axis);
  return {first, w1.cross(axis) + w.cross(first),
          sup_w2 + 3.0 * sup_w1 * sup_w + sup_w * sup_w * sup_w};
}

/// The angle between two unit vectors whose ends are `chord` apart.
double angle_of_chord(double chord) { return 2.0 * std::asin(std::min(0.5 * chord, 1.0)); }

/// Taylor expansion of the tool about the middle of stretches of one piece.
class PieceDeviation {
 public:
  PieceDeviation(const ForwardKinematics& arm, const JointPiece& piece, const TaskCurve& curve,
                 double s0, AngleOf angle_of)
      : arm_(arm),
        piece_(piece),
        curve_(curve),
        s0_(s0),
        reach_(reach_over(arm, piece)),
        angle_of_(angle_of) {}

  StretchDeviation over(const Stretch& stretch) const {
    const double half = stretch.half;
    const PathPoint joints = piece_.at(stretch.middle);
    const CurvePoint on_curve = curve_.at(on_curve_s(stretch.middle));
    const CurveBounds bounds =
        curve_.bounds(on_curve_s(stretch.middle - half), on_curve_s(stretch.middle + half));
    const JointSuprema sup = joint_suprema(piece_, joints, stretch.middle, half);
    const ChainFrames frames = arm_.frames(joints.q);
    const Jacobian jacobian = arm_.jacobian(frames);
    const Jacobian jacobian_rate = arm_.jacobian_rate(frames, joints.q1);
    const Twist rate = jacobian * joints.q1;
    const Twist rate_change = jacobian * joints.q2 + jacobian_rate * joints.q1;

    StretchDeviation result;
    const Eigen::Vector3d e = frames.pose_base_tool.translation() - on_curve.p;
    const Eigen::Vector3d e1 = rate.head<3>() - on_curve.p1;
    const Eigen::Vector3d e2 = rate_change.head<3>() - on_curve.p2;
    result.at_middle.position = e.norm();
    result.bound.position =
        quadratic_bound(e, e1, e2, half) +
        half * half * half / 6.0 * (position_third_bound(arm_, reach_, sup) + bounds.p3);
    if (angle_of_ == AngleOf::kAxis) {
      const Eigen::Vector3d axis = frames.pose_base_tool.linear().col(2);
      const Eigen::Vector3d wanted = on_curve.rotation.col(2);
      const TurningAxis tool = turning(axis, rate.tail<3>(), rate_change.tail<3>(),
                                       rotation_second_bound(arm_, sup), half);
      const TurningAxis asked = turning(wanted, on_curve.w, on_curve.w1, bounds.w2, half);
      result.at_middle.angle = angle_between(axis, wanted);
      result.bound.angle = angle_of_chord(quadratic_bound(axis - wanted, tool.first - asked.first,
                                                          tool.second - asked.second, half) +
                                          half * half * half / 6.0 * (tool.third + asked.third));
    } else if (angle_of_ == AngleOf::kRotation) {
      const Eigen::Matrix3d rotation = frames.pose_base_tool.linear();
      const Turning tool = turning_about(rotation, rate.tail<3>(), rate_change.tail<3>(),
                                         rotation_second_bound(arm_, sup), half);
      const Turning asked = {on_curve.rotation, on_curve.w, on_curve.w1,
                             bounds.w,          bounds.w1,  bounds.w2};
      const Eigen::Vector3d phi = rotation_log(on_curve.rotation.transpose() * rotation);
      result.at_middle.angle = phi.norm();
      result.bound.angle = angle_bound(phi, tool, asked, half);
    }
    return result;
  }

 private:
  double on_curve_s(double s) const { return std::clamp(s0_ + s, 0.0, curve_.length()); }

  const ForwardKinematics& arm_;
  const JointPiece& piece_;
  const TaskCurve& curve_;
  double s0_;
  JointVector reach_;
  AngleOf angle_of_;
};

/// Both halves of a stretch, the earlier on top.
void push_halves(std::vector<Stretch>& open, const Stretch& stretch) {
  const double quarter = 0.5 * stretch.half;
  open.push_back({stretch.middle + quarter, quarter, stretch.depth + 1});
  open.push_back({stretch.middle - quarter, quarter, stretch.depth + 1});
}

}  // namespace

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

Deviation bound_deviation(const ForwardKinematics& arm, const JointPiece& piece,
                          const TaskCurve& curve, double s0, double resolution_m,
                          double resolution_rad) {
  const PieceDeviation local(arm, piece, curve, s0, AngleOf::kRotation);
  Deviation seen;    // reached for certain
  Deviation proven;  // never left
  std::vector<Stretch> open = {{0.5 * piece.length, 0.5 * piece.length, 0}};
  while (!open.empty()) {
    const Stretch stretch = open.back();
    open.pop_back();
    const StretchDeviation found = local.over(stretch);
    seen.position = std::max(seen.position, found.at_middle.position);
    seen.angle = std::max(seen.angle, found.at_middle.angle);
    const bool tight = found.bound.position <= seen.position + resolution_m &&
                       found.bound.angle <= seen.angle + resolution_rad;
    if (tight || stretch.depth >= kDeepest) {
      proven.position = std::max(proven.position, found.bound.position);
      proven.angle = std::max(proven.angle, found.bound.angle);
    } else {
      push_halves(open, stretch);
    }
  }
  return proven;
}

std::optional<Deviation> prove_deviation(const ForwardKinematics& arm, const JointPiece& piece,
                                         const TaskCurve& curve, double s0, AngleOf angle_of,
                                         const Deviation& tolerance, long& places) {
  const PieceDeviation local(arm, piece, curve, s0, angle_of);
  Deviation proven;
  std::vector<Stretch> open = {{0.5 * piece.length, 0.5 * piece.length, 0}};
  int stretches = 0;
  while (!open.empty()) {
    if (++stretches > kMostStretches) return std::nullopt;
    ++places;
    const Stretch stretch = open.back();
    open.pop_back();
    const StretchDeviation found = local.over(stretch);
    // Written so that NaN is no proof.
    if (!(found.at_middle.position <= tolerance.position &&
          found.at_middle.angle <= tolerance.angle)) {
      return std::nullopt;
    }
    if (found.bound.position <= tolerance.position && found.bound.angle <= tolerance.angle) {
      proven.position = std::max(proven.position, found.bound.position);
      proven.angle = std::max(proven.angle, found.bound.angle);
    } else if (stretch.depth >= kDeepest) {
      return std::nullopt;
    } else {
      push_halves(open, stretch);
    }
  }
  return proven;
}

Deviation deviation_at(const ForwardKinematics& arm, const JointPiece& piece,
                       const TaskCurve& curve, double s0, AngleOf angle_of, double s) {
  const Pose pose = arm.pose(piece.at(s).q);
  const CurvePoint on_curve = curve.at(std::clamp(s0 + s, 0.0, curve.length()));
  Deviation deviation = {(pose.translation() - on_curve.p).norm(), 0.0};
  if (angle_of == AngleOf::kRotation) {
    deviation.angle = rotation_distance(on_curve.rotation, pose.linear());
  } else if (angle_of == AngleOf::kAxis) {
    deviation.angle = angle_between(on_curve.rotation.col(2), pose.linear().col(2));
  }
  return deviation;
}

}  // namespace viapoint
