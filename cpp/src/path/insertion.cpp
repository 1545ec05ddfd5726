#include "viapoint/path/insertion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "path/curve_follower.hpp"
#include "path/deviation.hpp"
#include "path/insertion_failure.hpp"
#include "viapoint/core/units.hpp"

namespace viapoint {
namespace {

/// Shortest step, as a share of the curve: shorter ones mean that the curve cannot be followed on.
/// (Joints that turn within less of it make motions of minutes, which nobody wants.)
constexpr double kShortestStep = 1e-8;
/// A knot whose rate misses the curve's by more than this share does not follow it.
constexpr double kRateResidual = 1e-6;
/// A quintic Hermite piece with exact ends errs like the sixth power of its length.
constexpr double kErrorOrder = 6.0;
constexpr size_t kMostPieces = 20000;
/// Places of the curve that are looked at, at most: so many, and so many more for every piece. A
/// piece takes 25 on average; the hardest of thousands of lines by a singular wrist took 1200.
constexpr long kMostPlaces = 20000;
constexpr long kMostPlacesAPiece = 200;
/// What Newton's method for one knot counts as.
constexpr long kPlacesAKnot = 8;
/// Near a singularity joints whose axes line up may turn against each other without moving the
/// tool, so the tool alone does not tell that they follow the curve. In one piece a free revolute
/// joint sweeps this much at most [rad]: too little to come out on another turn or branch.
constexpr double kMostSweep = 1.0;
/// And at most its own change between the knots by this factor, and this angle [rad].
constexpr double kSweepFactor = 1.5;
constexpr double kSweepFloor = 0.05;
/// Beyond a limit that is passed the walk goes on for so many pieces, or for so many [rad].
constexpr size_t kMostPiecesBeyond = 1000;
constexpr double kFarBeyond = 2.0 * kPi;
/// A goal this many times as far as the arm reaches is refused without walking there.
constexpr double kFarGoal = 100.0;

void check_arguments(const ForwardKinematics& arm, const JointLimits& limits,
                     const TaskCurve& curve, const JointVector& start,
                     const InsertionOptions& options) {
  if (start.size() != arm.joints() || limits.joints() != arm.joints()) {
    throw MotionError(ErrorCode::kBadArgument, "the arm has " + std::to_string(arm.joints()) +
                                                   " joints, the start " +
                                                   std::to_string(start.size()) + ", the limits " +
                                                   std::to_string(limits.joints()));
  }
  if (!start.allFinite()) {
    throw MotionError(ErrorCode::kBadArgument, "the start joints are not finite");
  }
  if (options.hold == Hold::kWrist && options.wrist_goal.size() != arm.joints()) {
    throw MotionError(ErrorCode::kBadArgument,
                      "the wrist goal has " + std::to_string(options.wrist_goal.size()) +
                          " joints, the arm " + std::to_string(arm.joints()));
  }
  if (!(options.position_tolerance > 0.0) || !(options.angle_tolerance > 0.0)) {
    throw MotionError(ErrorCode::kBadArgument, "insertion tolerances must be above zero");
  }
  if (!(curve.length() > 0.0)) {
    throw MotionError(ErrorCode::kZeroLength,
                      "the move goes nowhere: its start and its goal are the same pose",
                      {"remove the move, or wait() where a pause is meant"});
  }
}

/// How far the joint comes from its place at the start of the piece, bounded by the control points
/// of the Bernstein form: b_k = Σ_{j<=k} C(k, j) / C(5, j) c_j.
double sweep_bound(const JointPiece& piece, int joint) {
  static constexpr std::array<double, 6> kOfFive = {1.0, 5.0, 10.0, 10.0, 5.0, 1.0};
  double low = 0.0;
  double high = 0.0;
  for (int k = 1; k <= 5; ++k) {
    double control = 0.0;
    double of_k = 1.0;  // C(k, j)
    for (int j = 1; j <= k; ++j) {
      of_k *= static_cast<double>(k - j + 1) / j;
      control += of_k / kOfFive[static_cast<size_t>(j)] * piece.coefficients(j, joint);
    }
    low = std::min(low, control);
    high = std::max(high, control);
    if (!std::isfinite(control)) return control;
  }
  return high - low;
}

/// Walks along the curve and keeps what it has proven.
class Marcher {
 public:
  Marcher(const ForwardKinematics& arm, const JointLimits& limits, const TaskCurve& curve,
          const JointVector& start, const InsertionOptions& options)
      : arm_(arm),
        limits_(limits),
        curve_(curve),
        options_(options),
        follower_(arm, curve, start, options),
        tolerance_{options.position_tolerance, options.angle_tolerance},
        step_(curve.length()) {
    here_ = follower_.derivatives(0.0, start);
    result_.knots.push_back(start);
  }

  Insertion run() {
    refuse_start_off_the_curve();
    const double length = curve_.length();
    while (s_ < length) {
      // The rest in equal steps, so that no stub is left at the end.
      const double steps = std::ceil((length - s_) / step_ * (1.0 - 1e-9));
      const double even = steps <= 1.0 ? length : s_ + (length - s_) / steps;
      // A piece across a jump of the curve's third derivative would have to be short: end there,
      // unless that makes a stub.
      const double next = curve_.last_break(0.5 * (s_ + even), even);
      // Written so that NaN fails.
      if (!(next - s_ >= kShortestStep * length || next >= length)) fail();
      refuse_endless_work();
      if (advance(next) && far_beyond_limit()) fail();
    }
    if (crossing_) throw_limit_crossing(arm_, *crossing_, crossing_share_, options_);
    return std::move(result_);
  }

 private:
  void refuse_start_off_the_curve() const {
    if (here_.residual.position <= tolerance_.position &&
        here_.residual.angle <= tolerance_.angle) {
      return;
    }
    Problem problem;
    problem.code = ErrorCode::kDiscontinuous;
    problem.message = "the start joints are not on the curve that is to be followed";
    problem.share = 0.0;
    problem.value = here_.residual.position;
    problem.limit = tolerance_.position;
    throw MotionError(std::move(problem));
  }

  /// Whether the sweep of every free revolute joint is what following the curve takes.
  bool sweeps_little(const JointPiece& piece) const {
    for (int i = 0; i < follower_.free_joints(); ++i) {
      if (arm_.type(i) != JointType::kRevolute) continue;
      const double net = std::abs(piece.coefficients.col(i).tail<5>().sum());
      // Written so that NaN sweeps too much.
      if (!(sweep_bound(piece, i) <= std::min(kSweepFactor * net + kSweepFloor, kMostSweep))) {
        return false;
      }
    }
    return true;
  }

  /// How far the free revolute joints are extrapolated [rad].
  double reach_ahead(const JointVector& guess) const {
    double farthest = 0.0;
    for (int i = 0; i < follower_.free_joints(); ++i) {
      if (arm_.type(i) != JointType::kRevolute) continue;
      const double ahead = std::abs(guess[i] - here_.point.q[i]);
      if (!(ahead <= farthest)) farthest = ahead;
    }
    return farthest;
  }

  [[noreturn]] void fail() const {
    if (crossing_) throw_limit_crossing(arm_, *crossing_, crossing_share_, options_);
    throw_insertion_failure(follower_, curve_, here_.point, s_, options_);
  }

  void refuse_endless_work() const {
    const size_t pieces = result_.pieces.size();
    const long most = kMostPlaces + kMostPlacesAPiece * static_cast<long>(pieces);
    if (pieces <= kMostPieces && places_ <= most) return;
    if (crossing_) throw_limit_crossing(arm_, *crossing_, crossing_share_, options_);
    throw_endless_work(pieces, s_ / curve_.length(), options_);
  }

  /// Tries the piece from here to `next`; shortens the step where it does not hold.
  bool advance(double next) {
    const double h = next - s_;
    const PathPoint& from = here_.point;
    const JointVector guess = from.q + h * (from.q1 + 0.5 * h * from.q2);
    const double ahead = reach_ahead(guess);
    if (!(ahead <= kMostSweep)) {
      step_ = h * (std::isfinite(ahead) ? std::clamp(kMostSweep / ahead, 0.1, 0.8) : 0.1);
      return false;
    }
    places_ += kPlacesAKnot;
    const std::optional<CurveFollower::Knot> knot = follower_.solve(next, guess);
    if (!knot || knot->rate_residual > kRateResidual) {
      step_ = 0.5 * h;
      return false;
    }
    JointPiece piece = JointPiece::hermite(from, knot->point, h);
    if (!sweeps_little(piece)) {
      step_ = 0.5 * h;
      return false;
    }
    // Three samples tell quickly, and how much shorter; only the proof counts in the end.
    double ratio = 0.0;
    for (const double u : {0.5, 0.25, 0.75}) {
      const Deviation at =
          deviation_at(arm_, piece, curve_, s_, angle_kept_by(options_.hold), u * h);
      ratio = std::max({ratio, at.position / tolerance_.position, at.angle / tolerance_.angle});
    }
    if (!(ratio <= 1.0)) {
      step_ = h * std::clamp(0.9 * std::pow(ratio, -1.0 / kErrorOrder), 0.1, 0.8);
      return false;
    }
    const std::optional<Deviation> proven =
        prove_deviation(arm_, piece, curve_, s_, angle_kept_by(options_.hold), tolerance_, places_);
    if (!proven) {
      step_ = 0.75 * h;
      return false;
    }
    piece.position_deviation = proven->position;
    piece.angle_deviation = proven->angle;
    keep(piece, *knot, next);
    step_ = h * std::clamp(0.9 * std::pow(std::max(ratio, 1e-12), -1.0 / kErrorOrder), 0.8, 3.0);
    return true;
  }

  void keep(const JointPiece& piece, const CurveFollower::Knot& knot, double next) {
    hold_limits(piece);
    result_.position_deviation = std::max(result_.position_deviation, piece.position_deviation);
    result_.angle_deviation = std::max(result_.angle_deviation, piece.angle_deviation);
    result_.pieces.push_back(piece);
    result_.knots.push_back(knot.point.q);
    here_ = knot;
    s_ = next;
  }

  /// Enough is known of how far beyond a limit the curve leads.
  bool far_beyond_limit() const {
    return crossing_ && (result_.pieces.size() > last_within_ + kMostPiecesBeyond ||
                         std::abs(crossing_->value - crossing_->limit) > kFarBeyond);
  }

  /// A breach is told at the end: only then is known how far beyond the limit the joint would go.
  void hold_limits(const JointPiece& piece) {
    if (!crossing_) {
      crossing_ = piece_position_violation(piece, limits_);
      if (crossing_) crossing_share_ = (s_ + crossing_->s) / curve_.length();
      last_within_ = result_.pieces.size();
      return;
    }
    const double value = farthest_value(piece, limits_, *crossing_);
    const bool farther =
        std::abs(value - crossing_->limit) > std::abs(crossing_->value - crossing_->limit);
    const bool same_side = (value > crossing_->limit) == (crossing_->value > crossing_->limit);
    if (farther && same_side) crossing_->value = value;
  }

  const ForwardKinematics& arm_;
  const JointLimits& limits_;
  const TaskCurve& curve_;
  const InsertionOptions& options_;
  CurveFollower follower_;
  Deviation tolerance_;
  CurveFollower::Knot here_;
  Insertion result_;
  std::optional<LimitCrossing> crossing_;
  double crossing_share_ = 0.0;
  size_t last_within_ = 0;  ///< pieces before the one that crosses
  double s_ = 0.0;
  double step_;
  long places_ = 0;  ///< of the curve that were looked at
};

}  // namespace

Insertion insert_curve(const ForwardKinematics& arm, const JointLimits& limits,
                       const TaskCurve& curve, const JointVector& start,
                       const InsertionOptions& options) {
  check_arguments(arm, limits, curve, start, options);
  refuse_far_goal(arm, limits, curve, start, kFarGoal);
  return Marcher(arm, limits, curve, start, options).run();
}

}  // namespace viapoint
