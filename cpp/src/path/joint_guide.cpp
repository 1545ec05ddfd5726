#include "viapoint/path/joint_guide.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "path/curve_follower.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/path/spline.hpp"

namespace viapoint {
namespace {

constexpr int kIterations = 40;
/// The way is smooth when no place would move by more [rad or m].
constexpr double kSmooth = 1e-7;
/// No place is moved by more at once: the tool bends what is moved straight [rad or m].
constexpr double kLargestMove = 0.1;
/// Within this share of its range from a limit a joint is pushed back.
constexpr double kCrowded = 0.05;
/// What a joint at its limit all along the way adds to the square of the way's length.
constexpr double kCrowdingCost = 10.0;
/// Where the way then still comes nearer to a limit than kClear of the range, it passes between
/// limits that are near one another: so much narrower, and dearer, so often.
constexpr double kNarrower = 0.35;
constexpr double kDearer = 2.0;
constexpr int kTimesNarrower = 4;
constexpr double kClear = 2e-4;

/// The first and second derivative of what a joint's crowding costs.
struct Push {
  double slope = 0.0, bend = 0.0;
};

Push push_of(double q, double low, double high, double crowded, double cost) {
  const double margin = crowded * (high - low);
  if (!std::isfinite(margin) || !(margin > 0.0)) return {};
  const double over = std::max(low + margin - q, q - (high - margin));
  if (over <= 0.0) return {};
  const double bend = 2.0 * cost / (margin * margin);
  return {q > high - margin ? bend * over : -bend * over, bend};
}

class Relaxation {
 public:
  Relaxation(const JointLimits& limits, const CurveFollower& follower, double length,
             std::span<const JointVector> way, bool goal_counts)
      : limits_(limits),
        follower_(follower),
        step_(length / static_cast<double>(way.size() - 1)),
        way_(way.begin(), way.end()),
        directions_(way.size()),
        last_(goal_counts ? way.size() - 2 : way.size() - 1) {}

  void run() {
    const std::vector<JointVector> found = way_;
    relax();
    // Anew each time: what has passed a limit may have no way back.
    for (int k = 0; k < kTimesNarrower && !is_clear(); ++k) {
      crowded_ *= kNarrower;
      cost_ *= kDearer;
      way_ = found;
      relax();
    }
  }
  [[nodiscard]] JointGuide guide() const {
    std::vector<double> at(way_.size());
    for (size_t k = 0; k < at.size(); ++k) at[k] = step_ * static_cast<double>(k);
    const auto through = [&](const std::vector<JointVector>& points) {
      return quintic_chain(natural_spline(points, at, 5), at);
    };
    return {through(way_), through(directions_)};
  }

 private:
  void relax() {
    turn_directions();
    for (int k = 0; k < kIterations; ++k) {
      const std::vector<double> moves = wanted_moves();
      double largest = 0.0;
      for (const double move : moves) largest = std::max(largest, std::abs(move));
      if (!(largest > kSmooth)) return;
      double share = std::min(1.0, kLargestMove / largest);
      while (!take(moves, share)) {
        share *= 0.5;
        if (share * largest < kSmooth) return;
      }
      turn_directions();
    }
  }

  [[nodiscard]] bool is_clear() const {
    const auto from = way_.begin() + 1, to = from + static_cast<std::ptrdiff_t>(last_);
    return std::all_of(from, to, [&](const JointVector& q) {
      for (int i = 0; i < limits_.joints(); ++i) {
        const double low = limits_.position_min[i], high = limits_.position_max[i];
        const double room = std::min(q[i] - low, high - q[i]);
        if (std::isfinite(room) && room < kClear * (high - low)) return false;
      }
      return true;
    });
  }

  /// In which the tool stays, at each place to the same side as before.
  void turn_directions() {
    for (size_t k = 0; k < way_.size(); ++k) {
      directions_[k] = follower_.open_direction(way_[k]);
      if (k > 0 && directions_[k].dot(directions_[k - 1]) < 0.0) directions_[k] = -directions_[k];
    }
  }

  /// The minimum of Σ ‖q_{k+1} − q_k‖² and of the crowding, as if the directions were straight: one
  /// equation a place, tridiagonal (Thomas).
  [[nodiscard]] std::vector<double> wanted_moves() const {
    const size_t n = way_.size();
    const double weight = 1.0 / (static_cast<double>(n - 1) * static_cast<double>(n - 1));
    std::vector<double> moves(n, 0.0), upper(n, 0.0);
    for (size_t k = 1; k <= last_; ++k) {
      const JointVector& d = directions_[k];
      JointVector slope = 2.0 * (way_[k] - way_[k - 1]);
      double diagonal = 2.0;
      if (k + 1 < n) {
        slope += 2.0 * (way_[k] - way_[k + 1]);
        diagonal += 2.0;
      }
      for (Eigen::Index i = 0; i < d.size(); ++i) {
        const Push push =
            push_of(way_[k][i], limits_.position_min[i], limits_.position_max[i], crowded_, cost_);
        slope[i] += weight * push.slope;
        diagonal += weight * push.bend * d[i] * d[i];
      }
      const double below = k > 1 ? -2.0 * d.dot(directions_[k - 1]) : 0.0;
      const double pivot = diagonal - below * upper[k - 1];
      upper[k] = k < last_ ? -2.0 * d.dot(directions_[k + 1]) / pivot : 0.0;
      moves[k] = (-slope.dot(d) - below * moves[k - 1]) / pivot;
    }
    for (size_t k = last_; k-- > 1;) moves[k] -= upper[k] * moves[k + 1];
    return moves;
  }

  /// Moves every place and brings the tool back to the curve. @return false where one cannot be
  bool take(const std::vector<double>& moves, double share) {
    std::vector<JointVector> moved = way_;
    for (size_t k = 1; k <= last_; ++k) {
      const auto knot = follower_.solve(step_ * static_cast<double>(k),
                                        way_[k] + share * moves[k] * directions_[k]);
      if (!knot) return false;
      moved[k] = knot->point.q;
    }
    way_ = std::move(moved);
    return true;
  }

  const JointLimits& limits_;
  const CurveFollower& follower_;
  double step_;
  double crowded_ = kCrowded, cost_ = kCrowdingCost;
  std::vector<JointVector> way_, directions_;
  size_t last_;  ///< place that may move
};

}  // namespace

JointGuide smooth_guide(const ForwardKinematics& arm, const JointLimits& limits,
                        const TaskCurve& curve, std::span<const JointVector> way, bool goal_counts,
                        const InsertionOptions& options) {
  if (way.size() < 3) {
    throw MotionError(ErrorCode::kBadArgument, "a way of joints has at least three places, not " +
                                                   std::to_string(way.size()));
  }
  const CurveFollower follower(arm, curve, way.front(), options);
  Relaxation relaxation(limits, follower, curve.length(), way, goal_counts);
  relaxation.run();
  return relaxation.guide();
}

}  // namespace viapoint
