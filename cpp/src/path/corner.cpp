#include "viapoint/path/corner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "path/corner_shape.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/core/units.hpp"

namespace viapoint {
namespace {

/// A turn nearer than this to a reversal is a stop: the blend would have to come to rest anyway.
constexpr double kReversal = 178.0 * kDegree;
/// Cuts shorter than this [rad or m, 2-norm over the joints] are no room at all.
constexpr double kShortestCut = 1e-7;
/// The farther leg is cut at most this many times as far back as the nearer.
constexpr double kMostUnequal = 4.0;
/// Share of the zone aimed at; the rest is for the slack of the proof.
constexpr double kAim = 0.997;
/// Slack of the proof, as a share of the distance proven.
constexpr double kProofShare = 2e-3;
constexpr int kGuesses = 8;
/// A first guess this near to the aim is left to the proof.
constexpr double kGuessShare = 0.998;
constexpr int kProofs = 40;
/// A proven use of the zone that is not improved on, and how many proofs go into reaching it.
constexpr double kFullUse = 0.992;
constexpr int kRefinements = 12;
/// How far a refinement goes at least, of what is open, and how much longer a cut grows at once.
constexpr double kLeastMove = 0.02;
constexpr double kMostGrowth = 2.0;
constexpr double kProofShrink = 0.99;
/// Below this turn there is next to nothing to cut, and a zone not used up is no news.
constexpr double kCollinear = 1.0 * kDegree;
/// Legs may miss each other by this much where they meet [rad or m].
constexpr double kMeetSlack = 1e-6;
/// Absolute slack of the tool deviation that is only reported [m].
constexpr double kToolResolution = 1e-7;

double angle_between(const JointVector& a, const JointVector& b) {
  // atan2 of the half-angle form is exact near 0 and π alike (Kahan 2006).
  const JointVector u = a.normalized();
  const JointVector v = b.normalized();
  return 2.0 * std::atan2((u - v).norm(), (u + v).norm());
}

/// One corner under way.
class CornerFit {
 public:
  CornerFit(const ForwardKinematics* arm, const JointPath& before, const JointPath& after,
            const Zone& zone, double room_before, double room_after)
      : legs_(before, after),
        zone_(zone),
        room_before_(std::clamp(room_before, 0.0, before.length())),
        room_after_(std::clamp(room_after, 0.0, after.length())) {
    if (arm != nullptr) tool_ = MotionSpace(*arm, legs_.travel());
    has_tool_ = arm != nullptr;
    if (zone.kind != ZoneKind::kJointDeviation) zone_space_ = tool_;
  }

  Corner run() {
    turn_ = angle_between(legs_.direction_before(), legs_.direction_after());
    // Written so that NaN, from a leg that stands still, is a refusal too.
    if (!(turn_ <= kReversal)) return refuse("the path turns back on itself: stop at the point");
    return zone_.kind == ZoneKind::kRadius ? fit_radius() : fit_deviation();
  }

 private:
  /// Of the zone, proven.
  struct Use {
    double size = 0.0, angle = 0.0;
  };

  double share_of(const Use& use) const {
    return std::max(use.size / zone_.size, use.angle / zone_.angle);
  }

  /// Above the zone it only tells that.
  Use radius_use(const CornerShape& shape) const {
    Use use;
    use.size = shape.bound_radius(zone_space_, kProofShare * zone_.size * 0.5, zone_.size);
    if (zone_.bounds_angle() && use.size <= zone_.size) {
      use.angle = shape.bound_turn(tool_, kProofShare * zone_.angle * 0.5, zone_.angle);
    }
    return use;
  }

  Use deviation_use(const CornerShape& shape) const {
    Use use;
    use.size = shape.bound_deviation_from_legs(zone_space_, 1e-4 * zone_.size, kProofShare);
    if (zone_.bounds_angle()) {
      use.angle = shape.bound_turn_from_legs(zone_space_, tool_, 1e-4 * zone_.angle, kProofShare);
    }
    return use;
  }

  /// The share of the zone that the shape uses at its place nearest to the corner: nearly always
  /// all of it. Quick, and no bound.
  double guessed_share(const CornerShape& shape) const {
    const double turn = zone_.bounds_angle() ? shape.turn_from_corner(zone_space_, tool_) : 0.0;
    return share_of({shape.distance_from_corner(zone_space_), turn});
  }

  static Corner refuse(std::string reason) {
    Corner corner;
    corner.reason = std::move(reason);
    return corner;
  }

  /// Why no cut is left. @param refuted whether a corner that fits was tried and kept no zone
  Corner refuse_all(bool refuted) const {
    const double most = std::min(legs_.chord(CornerLegs::kBefore, room_before_),
                                 legs_.chord(CornerLegs::kAfter, room_after_));
    // Written so that NaN is no room.
    if (!(most > kShortestCut)) return refuse("no room: a leg is too short for a corner");
    if (refuted) return refuse("no corner was proven to stay within the zone: stop at the point");
    const Use least = ends_of(shape_of(kShortestCut));
    if (least.angle / zone_.angle > least.size / zone_.size) {
      Corner corner = refuse("the zone's angle is too small for a corner");
      corner.angle_rules = true;
      return corner;
    }
    return refuse("the zone is too small for a corner");
  }

  /// How far the ends of a shape are from the corner.
  Use ends_of(const CornerShape& shape) const {
    Use use;
    for (const JointVector& q : {legs_.at_cut(CornerLegs::kBefore, shape.cut_before()).q,
                                 legs_.at_cut(CornerLegs::kAfter, shape.cut_after()).q}) {
      use.size = std::max(use.size, zone_space_.distance(q, legs_.corner()));
      if (zone_.bounds_angle()) {
        use.angle = std::max(use.angle, tool_.angle(q, legs_.corner()));
      }
    }
    return use;
  }

  /// Cuts as far back as the zone's radius reaches along each leg.
  Corner fit_radius() {
    const auto inside = [this](const JointVector& q) {
      return zone_space_.distance(q, legs_.corner()) <= kAim * zone_.size &&
             (!zone_.bounds_angle() || tool_.angle(q, legs_.corner()) <= kAim * zone_.angle);
    };
    double cut_before = legs_.cut_while(CornerLegs::kBefore, room_before_, inside);
    double cut_after = legs_.cut_while(CornerLegs::kAfter, room_after_, inside);
    const bool short_before = cut_before >= room_before_;
    const bool short_after = cut_after >= room_after_;
    balance(cut_before, cut_after);
    bool refuted = false;
    for (int attempt = 0; attempt < kProofs; ++attempt) {
      const CornerShape shape(legs_, cut_before, cut_after);
      if (!shape.valid(kShortestCut)) break;
      const Use use = radius_use(shape);
      if (use.size <= zone_.size && use.angle <= zone_.angle) {
        return finish(shape, use, short_before || short_after);
      }
      refuted = true;
      cut_before *= kProofShrink;
      cut_after *= kProofShrink;
    }
    return refuse_all(refuted);
  }

  /// Makes neither cut much longer than the other (in joint distance).
  void balance(double& cut_before, double& cut_after) const {
    const double d1 = legs_.chord(CornerLegs::kBefore, cut_before);
    const double d2 = legs_.chord(CornerLegs::kAfter, cut_after);
    if (d1 > kMostUnequal * d2) {
      cut_before = legs_.cut_of_chord(CornerLegs::kBefore, kMostUnequal * d2, cut_before);
    } else if (d2 > kMostUnequal * d1) {
      cut_after = legs_.cut_of_chord(CornerLegs::kAfter, kMostUnequal * d1, cut_after);
    }
  }

  /// The largest equal cut-back (in joint distance; less on a leg without the room) whose deviation
  /// from the legs keeps the zone.
  Corner fit_deviation() {
    const double most_before = legs_.chord(CornerLegs::kBefore, room_before_);
    const double most_after = legs_.chord(CornerLegs::kAfter, room_after_);
    const double most = std::min(std::max(most_before, most_after),
                                 kMostUnequal * std::min(most_before, most_after));
    // A first guess by the place nearest to the corner; what is used grows about like the cut.
    double chord = most;
    for (int i = 0; i < kGuesses; ++i) {
      const CornerShape shape = shape_of(chord);
      if (!shape.valid(kShortestCut)) break;
      const double guess = guessed_share(shape);
      const bool close = guess >= kGuessShare * kAim || chord >= most;
      if (guess <= kAim * (1.0 + kProofShare) && close) break;
      chord = std::min(most, chord * kAim / guess);
    }
    // The proof has the last word: the cut follows what it finds, between the longest that is
    // proven and the shortest that is not.
    std::optional<CornerShape> best;
    Use best_use;
    double proven_chord = 0.0, proven = 0.0;
    double refused_chord = std::numeric_limits<double>::infinity(), refused = 0.0;
    for (int attempt = 0; attempt < kProofs; ++attempt) {
      const CornerShape shape = shape_of(chord);
      if (!shape.valid(kShortestCut)) break;
      const Use use = deviation_use(shape);
      const double share = share_of(use);
      if (use.size <= zone_.size && use.angle <= zone_.angle) {
        best.emplace(shape);
        best_use = use;
        proven_chord = chord;
        proven = share;
      } else {
        refused_chord = chord;
        refused = share;
      }
      const bool by_room = proven_chord >= most;
      if (best && (by_room || proven >= kFullUse || attempt >= kRefinements)) {
        return finish(*best, best_use, by_room);
      }
      // Regula falsi between the two, towards the share of the zone aimed at.
      chord = std::isfinite(refused_chord)
                  ? proven_chord + (refused_chord - proven_chord) *
                                       std::clamp((kAim - proven) / (refused - proven), kLeastMove,
                                                  1.0 - kLeastMove)
                  : std::min(most, chord * std::min(kMostGrowth, kAim / share));
    }
    return refuse_all(std::isfinite(refused_chord));
  }

  CornerShape shape_of(double chord) const {
    return {legs_, legs_.cut_of_chord(CornerLegs::kBefore, chord, room_before_),
            legs_.cut_of_chord(CornerLegs::kAfter, chord, room_after_)};
  }

  Corner finish(const CornerShape& shape, const Use& use, bool limited_by_room) const {
    Corner corner;
    corner.possible = true;
    corner.cut_before = shape.cut_before();
    corner.cut_after = shape.cut_after();
    corner.scale_after = shape.scale_after();
    corner.blend = shape.blend();
    corner.used = use.size;
    corner.used_angle = use.angle;
    corner.angle_rules = use.angle / zone_.angle > use.size / zone_.size;
    if (zone_.kind == ZoneKind::kDeviation) {
      corner.tool_deviation = use.size;
    } else if (has_tool_) {
      corner.tool_deviation = shape.bound_deviation_from_legs(tool_, kToolResolution, kProofShare);
    }
    corner.short_of_room = limited_by_room;
    if (limited_by_room && turn_ > kCollinear) {
      corner.reason = "the legs are too short for the whole zone";
    }
    return corner;
  }

  CornerLegs legs_;
  Zone zone_;
  double room_before_;
  double room_after_;
  bool has_tool_ = false;
  double turn_ = 0.0;
  MotionSpace tool_;
  MotionSpace zone_space_;
};

}  // namespace

Corner round_corner(const ForwardKinematics* arm, const JointPath& before, const JointPath& after,
                    const Zone& zone, double room_before, double room_after) {
  if (before.empty() || after.empty()) {
    throw MotionError(ErrorCode::kBadArgument, "a corner needs a leg on either side");
  }
  const JointVector end = before.at(before.length()).q;
  const JointVector start = after.at(0.0).q;
  if (end.size() != start.size() || !((end - start).lpNorm<Eigen::Infinity>() <= kMeetSlack)) {
    throw MotionError(ErrorCode::kDiscontinuous, "the legs of a corner do not meet");
  }
  Corner impossible;
  if (zone.kind == ZoneKind::kFine || !(zone.size > 0.0) || !(zone.angle > 0.0)) {
    impossible.reason = "the zone has no size: stop at the point";
    return impossible;
  }
  if (arm == nullptr && (zone.kind != ZoneKind::kJointDeviation || zone.bounds_angle())) {
    impossible.reason = "an arm without kinematics has no tool: only joint zones are possible";
    return impossible;
  }
  return CornerFit(arm, before, after, zone, room_before, room_after).run();
}

}  // namespace viapoint
