#include "planning/leg_merger.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <tuple>
#include <utility>
#include <variant>

#include "planning/leg_builder.hpp"
#include "viapoint/core/units.hpp"

namespace viapoint::planning {
namespace {

/// Of a zone that merging may use; the corners at the ends of the run keep the rest. Dense ways are
/// quickest with more of it, a sharp corner beside them with less; in between both lose little.
constexpr double kShare = 0.5;
/// How far the tool may be turned by it where no zone bounds its angle.
constexpr double kMostTurn = 0.5 * kDegree;
/// A run that turns the tool farther is left to several legs.
constexpr double kMostTotalTurn = 1.0;
/// Looking at a run once more costs by its length.
constexpr size_t kMostLegs = 128;
/// A merged leg may miss the joints at its end by rounding alone [rad or m].
constexpr double kSameEnd = 1e-7;

bool in_joints(const Leg& leg) { return std::holds_alternative<PtpMove>(leg.straight); }

/// A zone at the run's ends or inside: it must be told in the space in which the legs are straight.
bool fits(const Zone& zone, bool joints) {
  if (joints) return zone.kind == ZoneKind::kJointDeviation && !zone.bounds_angle();
  return zone.kind == ZoneKind::kRadius || zone.kind == ZoneKind::kDeviation;
}

/// How a line treats the orientation; nothing for any that merging knows no bound for.
std::optional<Hold> hold_of(const LinMove& line) {
  const Hold hold = planning::hold_of(line.orientation, line.target);
  const bool known =
      hold == Hold::kPosition || (hold == Hold::kPose && (line.orientation == Orientation::kLeast ||
                                                          line.orientation == Orientation::kFixed));
  return known ? std::optional(hold) : std::nullopt;
}

bool same_kind(const Leg& a, const Leg& b) {
  if (a.straight.index() != b.straight.index() || a.robot != b.robot) return false;
  if (std::holds_alternative<std::monostate>(a.straight)) return false;
  if (in_joints(a)) return true;
  const auto& first = std::get<LinMove>(a.straight);
  const auto& second = std::get<LinMove>(b.straight);
  return hold_of(first) && hold_of(first) == hold_of(second) &&
         first.orientation == second.orientation;
}

/// But for the zones.
bool same_wishes(const MoveOptions& a, const MoveOptions& b) {
  const auto all = [](const MoveOptions& of) {
    return std::tie(of.speed, of.acceleration, of.scale, of.angular_speed, of.angular_acceleration,
                    of.process_speed);
  };
  return all(a) == all(b);
}

constexpr double kNever = std::numeric_limits<double>::infinity();

/// What the zones of the run leave to merging.
struct Allowance {
  double distance = kNever, turn = kNever;
  double radius = kNever;  ///< smallest of inner points

  void take(const Zone& zone, bool inner) {
    if (zone.kind == ZoneKind::kFine) return;
    distance = std::min(distance, kShare * zone.size);
    if (zone.bounds_angle()) turn = std::min(turn, kShare * zone.angle);
    if (inner && zone.kind == ZoneKind::kRadius) radius = std::min(radius, zone.size);
  }
};

/// How far apart tools can be whose joints are `distance` apart: ‖Δp‖ <= Σ R_i |Δq_i|.
double at_the_tool(const Leg& leg, double distance) {
  if (!leg.robot->has_kinematics()) return 0.0;
  const JointVector travel = leg.start.cwiseAbs().cwiseMax(leg.goal.cwiseAbs()).array() + distance;
  const ForwardKinematics& arm = leg.robot->forward();
  JointVector reach = arm.reach_bound(travel);
  for (int i = 0; i < arm.joints(); ++i) {
    if (arm.type(i) == JointType::kPrismatic) reach[i] = 1.0;
  }
  return reach.norm() * distance;
}

/// Moves the end of the leg, and nothing of its slopes there, to where the next leg begins.
bool end_at(Leg& leg, const JointVector& goal) {
  const JointVector miss = goal - leg.goal;
  if (!(miss.cwiseAbs().maxCoeff() <= kSameEnd)) return false;
  JointPath path;
  const auto& pieces = leg.path.pieces();
  for (size_t k = 0; k < pieces.size(); ++k) {
    JointPiece piece = pieces[k];
    if (k + 1 == pieces.size()) {
      piece.coefficients.row(3) += 10.0 * miss.transpose();
      piece.coefficients.row(4) -= 15.0 * miss.transpose();
      piece.coefficients.row(5) += 6.0 * miss.transpose();
    }
    path.append(std::move(piece));
  }
  leg.path = std::move(path);
  leg.goal = goal;
  leg.position_deviation += at_the_tool(leg, miss.norm());
  leg.angle_deviation += miss.lpNorm<1>();
  return true;
}

}  // namespace

void LegMerger::add(Leg leg) {
  if (!run_.empty() && !goes_on_with(leg)) flush();
  const bool may_go_on = merges_ && same_kind(leg, leg) && fits(leg.options.zone, in_joints(leg));
  if (may_go_on || !run_.empty()) {
    if (run_.empty()) places_ = {place_of(leg, leg.start)};
    places_.push_back(place_of(leg, leg.goal));
  }
  run_.push_back(std::move(leg));
  if (!may_go_on) flush();
}

MergedPlace LegMerger::place_of(const Leg& leg, const JointVector& q) {
  if (in_joints(leg)) return {q};
  const Pose pose = leg.robot->forward().pose(q);
  MergedPlace place{pose.translation()};
  if (*hold_of(std::get<LinMove>(leg.straight)) == Hold::kPose) place.rotation = pose.linear();
  return place;
}

LegMerger::Offset LegMerger::offset_of(std::span<const MergedPlace> places) {
  Offset offset;
  const MergedPlace &first = places.front(), &last = places.back();
  const auto along = (last.at - first.at).eval();
  const double square = along.squaredNorm();
  const Eigen::Vector3d turn = rotation_log(first.rotation.transpose() * last.rotation);
  if (turn.norm() > kMostTotalTurn) offset.worst_turn = kNever;
  double share = 0.0, angle = 0.0;
  for (size_t k = 1; k < places.size(); ++k) {
    const bool end = k + 1 == places.size();
    const double before = share, angle_before = angle;
    share = end ? 1.0 : along.dot(places[k].at - first.at) / square;
    const double length = (places[k].at - places[k - 1].at).norm();
    offset.longest = std::max(offset.longest, length);
    if (k == 1) offset.first = length;
    if (end) offset.last = length;
    // Written so that NaN, of a run that comes back to its start, does not go forward either.
    if (!(share > before)) {
      offset.worst = kNever;
      return offset;
    }
    angle =
        end ? 0.0
            : rotation_distance(first.rotation * rotation_exp(share * turn), places[k].rotation);
    if (!end) {
      offset.point.push_back((places[k].at - first.at - share * along).norm());
      offset.turn.push_back(angle);
      offset.worst = std::max(offset.worst, offset.point.back());
    }
    // Between two points each orientation turns by half its way at most from the nearer one.
    const double half = 0.5 * (rotation_distance(places[k - 1].rotation, places[k].rotation) +
                               (share - before) * turn.norm());
    if (half > 0.0) {
      offset.worst_turn = std::max(offset.worst_turn, std::max(angle, angle_before) + half);
    }
  }
  return offset;
}

bool LegMerger::goes_on_with(const Leg& leg) {
  const Leg& last = run_.back();
  if (run_.size() >= kMostLegs || !same_kind(last, leg) ||
      !same_wishes(last.options, leg.options)) {
    return false;
  }
  const bool joints = in_joints(leg);
  Allowance allowance;
  for (const Zone* end : {&std::as_const(before_), &leg.options.zone}) {
    if (end->kind != ZoneKind::kFine && !fits(*end, joints)) return false;
    allowance.take(*end, false);
  }
  for (const Leg& passed : run_) allowance.take(passed.options.zone, true);
  places_.push_back(place_of(leg, leg.goal));
  const Offset offset = offset_of(places_);
  places_.pop_back();
  // At an end without such a zone, the leg is left only where the point inside allows it.
  const auto reach = [&](double length, const Zone& end) {
    const bool allows = end.kind == ZoneKind::kRadius && end.size >= allowance.radius;
    return allows ? 0.5 * length : length;
  };
  const double farthest = std::max(
      {0.5 * offset.longest, reach(offset.first, before_), reach(offset.last, leg.options.zone)});
  return offset.worst <= allowance.distance &&
         offset.worst_turn <= std::min(allowance.turn, kMostTurn) &&
         offset.worst + farthest <= allowance.radius;
}

void LegMerger::flush() {
  if (run_.empty()) return;
  before_ = run_.back().options.zone;
  std::optional<Leg> one = run_.size() > 1 ? merged() : std::nullopt;
  std::vector<Leg> run = std::exchange(run_, {});
  if (one) {
    emit_(std::move(*one));
  } else {
    for (Leg& leg : run) emit_(std::move(leg));
  }
}

std::optional<Leg> LegMerger::one_leg() const {
  const JointVector &start = run_.front().start, &goal = run_.back().goal;
  const LegBuilder builder(*run_.back().robot, tolerance_);
  const auto finished = [&](Leg leg) -> std::optional<Leg> {
    leg.robot = run_.back().robot;
    return end_at(leg, goal) ? std::optional(std::move(leg)) : std::nullopt;
  };
  try {
    if (in_joints(run_.back())) return finished(builder.ptp({JointTarget{goal}}, start));
    const auto& line = std::get<LinMove>(run_.back().straight);
    if (auto leg = finished(builder.lin(line, start))) return leg;
    // The way along the run has led joints that the tool leaves open to other places.
    return finished(builder.lin_to(line, start, goal));
  } catch (const MotionError&) {
    return std::nullopt;  // the legs themselves are there already
  }
}

std::optional<Leg> LegMerger::merged() const {
  const Leg& last = run_.back();
  std::optional<Leg> found = one_leg();
  if (!found) return std::nullopt;
  Leg& leg = *found;
  const LegBuilder builder(*last.robot, tolerance_);
  builder.apply(leg, last.options, last.step);
  const Offset offset = offset_of(places_);
  leg.merged.distance = offset.worst;
  leg.merged.turn = offset.worst_turn;
  leg.merged.at_tool = in_joints(last) ? at_the_tool(leg, offset.worst) : offset.worst;
  for (size_t k = 0; k + 1 < run_.size(); ++k) {
    CornerOutcome point;
    point.move = run_[k].step;
    point.asked = run_[k].options.zone;
    point.used = offset.point[k];
    point.used_angle = point.asked.bounds_angle() ? offset.turn[k] : 0.0;
    point.cut = in_joints(last) ? at_the_tool(leg, point.used) : point.used;
    point.merged_into = last.step;
    leg.merged.points.push_back(std::move(point));
    leg.merged.places.push_back(places_[k + 1]);
  }
  return found;
}

}  // namespace viapoint::planning
