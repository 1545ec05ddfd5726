#include "path/corner_shape.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "viapoint/core/scalar_minimum.hpp"

namespace viapoint {
namespace {

/// h‖q'‖ over the cut: what puts the inner control points on the corner.
constexpr double kStretch = 2.5;
constexpr int kCutBisections = 50;
/// How closely a cut meets the chord asked for, as a share of it; never above.
constexpr double kChordSlack = 1e-12;
constexpr int kCutSamples = 64;
constexpr int kBlendSamples = 8, kRefinements = 8;
/// To which the place nearest to the corner is looked for.
constexpr double kResolution = 1e-6;
/// A pairing that bounds the deviation this closely (times the least possible) needs no search.
constexpr double kPairingSlack = 1.006;
/// u* stays this far from the ends of the blend.
constexpr double kEndMargin = 0.05;

using Polynomial6 = Eigen::Matrix<double, 6, 1>;

/// α and β of the header, by powers of u.
Polynomial6 alpha() { return (Polynomial6() << 1.0, -2.5, 0.0, 5.0, -5.0, 1.5).finished(); }
Polynomial6 beta() { return (Polynomial6() << 0.0, 0.0, 0.0, 0.0, 2.5, -1.5).finished(); }

double value(const Polynomial6& polynomial, double u) {
  double sum = 0.0;
  for (int k = 5; k >= 0; --k) sum = sum * u + polynomial[k];
  return sum;
}

/// q alone, at u in [0, 1].
JointVector position(const JointPiece& piece, double u) {
  const auto row = [&piece](int k) { return piece.coefficients.row(k).transpose(); };
  return row(0) + u * (row(1) + u * (row(2) + u * (row(3) + u * (row(4) + u * row(5)))));
}

}  // namespace

CornerLegs::CornerLegs(const JointPath& before, const JointPath& after)
    : before_(before), after_(after), corner_(after.at(0.0).q) {}

PathPoint CornerLegs::at_cut(Side side, double cut) const {
  return side == kBefore ? before_.at(before_.length() - cut) : after_.at(cut);
}

JointVector CornerLegs::direction_before() const { return before_.at(before_.length()).q1; }
JointVector CornerLegs::direction_after() const { return after_.at(0.0).q1; }

bool CornerLegs::is_straight(Side side, double cut) const {
  const JointPath& leg = side == kBefore ? before_ : after_;
  const JointPiece& nearest = side == kBefore ? leg.pieces().back() : leg.pieces().front();
  return cut <= nearest.length && !nearest.coefficients.bottomRows<4>().any();
}

double CornerLegs::chord(Side side, double cut) const {
  const JointPath& leg = side == kBefore ? before_ : after_;
  const double s = side == kBefore ? leg.length() - cut : cut;
  const size_t index = leg.piece_at(s);
  const JointPiece& piece = leg.pieces()[index];
  return (position(piece, (s - leg.start_of(index)) / piece.length) - corner_).norm();
}

double CornerLegs::cut_of_chord(Side side, double wanted, double room) const {
  double high = room;
  double above = chord(side, room) - wanted;
  if (above <= 0.0) return room;
  // Regula falsi (Illinois; Dowell & Jarratt 1971): the chord is nearly linear in the cut.
  double low = 0.0;
  double below = -wanted;
  for (int i = 0; i < kCutBisections && -below > kChordSlack * wanted; ++i) {
    const double cut = low - below * (high - low) / (above - below);
    const double excess = chord(side, cut) - wanted;
    if (excess <= 0.0) {
      low = cut;
      below = excess;
      above *= 0.5;
    } else {
      high = cut;
      above = excess;
      below *= 0.5;
    }
  }
  return low;
}

double CornerLegs::cut_while(Side side, double room,
                             const std::function<bool(const JointVector&)>& inside) const {
  double low = 0.0;
  for (int k = 1; k <= kCutSamples; ++k) {
    double high = room * k / kCutSamples;
    if (inside(at_cut(side, high).q)) {
      low = high;
      continue;
    }
    for (int i = 0; i < kCutBisections; ++i) {
      const double middle = 0.5 * (low + high);
      (inside(at_cut(side, middle).q) ? low : high) = middle;
    }
    return low;
  }
  return room;
}

JointVector CornerLegs::travel() const {
  JointVector travel = JointVector::Zero(corner_.size());
  for (const JointPath* leg : {&before_, &after_}) {
    for (const JointPiece& piece : leg->pieces()) {
      travel = travel.cwiseMax(piece.coefficients.cwiseAbs().colwise().sum().transpose());
    }
  }
  // The blend lies within twice what its ends can reach.
  return 2.0 * travel;
}

CornerShape::CornerShape(const CornerLegs& legs, double cut_before, double cut_after)
    : legs_(legs),
      cut_before_(cut_before),
      cut_after_(cut_after),
      chord_before_(legs.chord(CornerLegs::kBefore, cut_before)),
      chord_after_(legs.chord(CornerLegs::kAfter, cut_after)) {
  const PathPoint from = legs.at_cut(CornerLegs::kBefore, cut_before);
  PathPoint to = legs.at_cut(CornerLegs::kAfter, cut_after);
  const double length = kStretch * chord_before_ / from.q1.norm();
  // s of the leg after is multiplied by scale_after: its derivatives shrink accordingly.
  scale_after_ = length * to.q1.norm() / (kStretch * chord_after_);
  if (!(length > 0.0) || !std::isfinite(length) || !(scale_after_ > 0.0) ||
      !std::isfinite(scale_after_)) {
    return;
  }
  to.q1 /= scale_after_;
  to.q2 /= scale_after_ * scale_after_;
  blend_ = JointPiece::hermite(from, to, length);
  blend_.kind = PieceKind::kBlend;
  blend_.move = legs.path(CornerLegs::kBefore).pieces().back().move;
}

bool CornerShape::valid(double shortest) const {
  return blend_.length > 0.0 && chord_before_ > shortest && chord_after_ > shortest;
}

double CornerShape::nearest_to_corner(const MotionSpace& space) const {
  const auto distance = [&](double u) {
    return space.distance(position(blend_, u), legs_.corner());
  };
  ScalarMinimum best{0.5, std::numeric_limits<double>::infinity()};
  for (int k = 1; k < kBlendSamples; ++k) {
    const double u = static_cast<double>(k) / kBlendSamples;
    const double here = distance(u);
    if (here < best.value) best = {u, here};
  }
  const double around = 1.0 / kBlendSamples;
  best =
      refined_minimum(best.x - around, best.x + around, best, kResolution, kRefinements, distance);
  return std::clamp(best.x, kEndMargin, 1.0 - kEndMargin);
}

CornerShape::Polynomial6 CornerShape::s_before(double u_star) const {
  const double ratio = value(alpha(), u_star) / value(beta(), u_star);
  Polynomial6 s = -cut_before_ * (alpha() - ratio * beta());
  s[0] += legs_.path(CornerLegs::kBefore).length();
  return s;
}

CornerShape::Polynomial6 CornerShape::s_after(double u_star) const {
  const double ratio = value(alpha(), u_star) / value(beta(), u_star);
  return cut_after_ * (beta() - alpha() / ratio);
}

PathMotion CornerShape::cut_part(CornerLegs::Side side) const {
  const JointPath& path = legs_.path(side);
  Polynomial6 s = Polynomial6::Zero();
  s[0] = side == CornerLegs::kBefore ? path.length() - cut_before_ : 0.0;
  s[1] = side == CornerLegs::kBefore ? cut_before_ : cut_after_;
  return {path, s};
}

double CornerShape::bound_radius(const MotionSpace& space, double resolution,
                                 double give_up) const {
  const RestMotion corner(legs_.corner());
  const double reached =
      std::max(space.distance(legs_.at_cut(CornerLegs::kBefore, cut_before_).q, legs_.corner()),
               space.distance(legs_.at_cut(CornerLegs::kAfter, cut_after_).q, legs_.corner()));
  double worst = 0.0;
  const auto take = [&](const JointMotion& motion) {
    if (worst > give_up) return;
    worst = std::max(
        worst, space.bound_distance(motion, corner, 0.0, 1.0, resolution, 0.0, reached, give_up));
  };
  take(PieceMotion(blend_));
  take(cut_part(CornerLegs::kBefore));
  take(cut_part(CornerLegs::kAfter));
  return worst;
}

double CornerShape::bound_deviation_from_legs(const MotionSpace& space, double resolution,
                                              double share) const {
  const double u_star = nearest_to_corner(space);
  const double least = space.distance(position(blend_, u_star), legs_.corner());
  // Between straight legs the largest distance of the pairs is that of u*, see the header.
  const bool straight = legs_.is_straight(CornerLegs::kBefore, cut_before_) &&
                        legs_.is_straight(CornerLegs::kAfter, cut_after_);
  if (space.is_joint_space() && straight) return least;
  const PieceMotion blend(blend_);
  // By the pairing of the header: tight wherever the legs are nearly straight in this space. What
  // is far above the least that is possible is left to the dearer search.
  const double worth = kPairingSlack * least + resolution;
  const PathMotion before(legs_.path(CornerLegs::kBefore), s_before(u_star));
  double paired = space.bound_distance(blend, before, 0.0, u_star, resolution, share, least, worth);
  if (paired <= worth) {
    const PathMotion after(legs_.path(CornerLegs::kAfter), s_after(u_star));
    paired = std::max(
        paired, space.bound_distance(blend, after, u_star, 1.0, resolution, share, least, worth));
    if (paired <= worth) return paired;
  }
  const PathMotion before_part = cut_part(CornerLegs::kBefore);
  const PathMotion after_part = cut_part(CornerLegs::kAfter);
  const std::array<const JointMotion*, 2> legs = {&before_part, &after_part};
  const std::array<const JointMotion*, 1> only_blend = {&blend};
  return std::max({space.bound_directed(blend, legs, resolution, share, least),
                   space.bound_directed(before_part, only_blend, resolution, share, least),
                   space.bound_directed(after_part, only_blend, resolution, share, least)});
}

double CornerShape::bound_turn(const MotionSpace& tool, double resolution, double give_up) const {
  const RestMotion corner(legs_.corner());
  double worst = 0.0;
  const auto take = [&](const JointMotion& motion) {
    if (worst > give_up) return;
    worst = std::max(worst,
                     tool.bound_angle(motion, corner, 0.0, 1.0, resolution, 0.0, worst, give_up));
  };
  take(cut_part(CornerLegs::kBefore));
  take(cut_part(CornerLegs::kAfter));
  take(PieceMotion(blend_));
  return worst;
}

double CornerShape::bound_turn_from_legs(const MotionSpace& space, const MotionSpace& tool,
                                         double resolution, double share) const {
  const double u_star = nearest_to_corner(space);
  const double least = tool.angle(position(blend_, u_star), legs_.corner());
  const PieceMotion blend(blend_);
  const auto bound = [&](const PathMotion& leg, double u0, double u1) {
    return tool.bound_angle(blend, leg, u0, u1, resolution, share, least,
                            std::numeric_limits<double>::infinity());
  };
  return std::max(bound({legs_.path(CornerLegs::kBefore), s_before(u_star)}, 0.0, u_star),
                  bound({legs_.path(CornerLegs::kAfter), s_after(u_star)}, u_star, 1.0));
}

double CornerShape::turn_from_corner(const MotionSpace& space, const MotionSpace& tool) const {
  return tool.angle(position(blend_, nearest_to_corner(space)), legs_.corner());
}

double CornerShape::distance_from_corner(const MotionSpace& space) const {
  return space.distance(position(blend_, nearest_to_corner(space)), legs_.corner());
}

}  // namespace viapoint
