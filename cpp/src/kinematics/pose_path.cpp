#include "viapoint/kinematics/pose_path.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "viapoint/core/error.hpp"
#include "viapoint/core/units.hpp"
#include "viapoint/kinematics/inverse_kinematics.hpp"

namespace viapoint {
namespace {

/// Values of what seven joints leave open, over its range.
constexpr int kGrid = 96;
/// Finer grids about the way that the coarser one found, each this much finer, to both sides.
constexpr int kRefinements = 2;
constexpr int kFiner = 4;
/// Solutions nearer than this are one [rad or m].
constexpr double kSame = 1e-7;
/// Of the places reached so far, so many are also followed by the nearest solution.
constexpr size_t kFollowed = 8;

/// How far goal joints may miss the last pose [m, rad].
constexpr double kGoalMiss = 1e-6;

constexpr double kNever = std::numeric_limits<double>::infinity();

double step_between(const JointVector& a, const JointVector& b) {
  return (a - b).cwiseAbs().maxCoeff();
}

bool holds(const RobotModel& robot, const JointVector& q, const Pose& pose) {
  if (q.size() != robot.joints()) return false;
  const Pose reached = robot.forward().pose(q);
  return (reached.translation() - pose.translation()).norm() <= kGoalMiss &&
         rotation_distance(reached.linear(), pose.linear()) <= kGoalMiss;
}

/// A solution of one pose that is reached without a jump.
struct Place {
  JointVector q;
  double cost = 0.0;  ///< least sum of squared steps from the start
  int before = -1;    ///< index in the layer of the pose before
};
using Layer = std::vector<Place>;

class Follower {
 public:
  Follower(const RobotModel& robot, std::span<const Pose> poses, double largest_step,
           const JointVector* goal)
      : inverse_(robot.inverse()), poses_(poses), largest_step_(largest_step), goal_(goal) {
    if (inverse_.redundancy().empty()) return;
    open_ = true;
    from_ = -kPi;
    to_ = kPi;
    if (inverse_.redundancy() != "arm angle") {  // a joint: of the arms known, the last one
      from_ = robot.limits().position_min[robot.joints() - 1];
      to_ = robot.limits().position_max[robot.joints() - 1];
    }
  }

  std::vector<JointVector> run(const JointVector& start) {
    JointVector first;
    at(0, [&] { first = inverse_.solve_near(poses_[0], start); });
    if (std::optional<std::vector<JointVector>> way = by_the_nearest(first)) return *way;
    std::vector<JointVector> way = through_layers(first, nullptr);
    double width = (to_ - from_) / kGrid;
    for (int i = 0; open_ && i < kRefinements; ++i) {
      width_ = width /= kFiner;
      way = through_layers(first, &way);
    }
    return way;
  }

 private:
  [[nodiscard]] double share(size_t k) const {
    return poses_.size() < 2 ? 0.0
                             : static_cast<double>(k) / static_cast<double>(poses_.size() - 1);
  }

  /// Says in a refusal at which pose it came.
  template <typename Solve>
  void at(size_t k, const Solve& solve) const {
    try {
      solve();
    } catch (const MotionError& error) {
      Problem problem = error.problem();
      problem.message = "pose " + std::to_string(k) + ": " + problem.message;
      problem.share = share(k);
      throw MotionError(std::move(problem));
    }
  }

  std::optional<std::vector<JointVector>> by_the_nearest(const JointVector& first) const {
    std::vector<JointVector> way{first};
    for (size_t k = 1; k < poses_.size(); ++k) {
      at(k, [&] { way.push_back(inverse_.solve_near(poses_[k], way[k - 1])); });
      if (step_between(way[k], way[k - 1]) > largest_step_) return std::nullopt;
    }
    if (goal_ != nullptr && step_between(way.back(), *goal_) > kSame) return std::nullopt;
    return way;
  }

  /// @param about a way to look beside on a finer grid; null for the whole range
  std::vector<JointVector> through_layers(const JointVector& first,
                                          const std::vector<JointVector>* about) const {
    std::vector<Layer> layers{{Place{first}}};
    for (size_t k = 1; k < poses_.size(); ++k) {
      Layer layer;
      const Layer& reached = layers.back();
      for (const JointVector& q : candidates(k, reached, about)) {
        std::optional<Place> place = reach(q, reached);
        if (place) layer.push_back(*std::move(place));
      }
      if (layer.empty()) refuse(k, reached);
      layers.push_back(std::move(layer));
    }
    const Layer& last = layers.back();
    const auto best = std::min_element(
        last.begin(), last.end(), [](const auto& a, const auto& b) { return a.cost < b.cost; });
    std::vector<JointVector> way(poses_.size());
    auto place = static_cast<int>(best - last.begin());
    for (size_t k = poses_.size(); k-- > 0;) {
      const Place& here = layers[k][static_cast<size_t>(place)];
      way[k] = here.q;
      place = here.before;
    }
    return way;
  }

  std::vector<JointVector> candidates(size_t k, const Layer& reached,
                                      const std::vector<JointVector>* about) const {
    if (goal_ != nullptr && k + 1 == poses_.size()) return {*goal_};
    std::vector<JointVector> found;
    const auto keep = [&](const std::vector<JointVector>& more) {
      found.insert(found.end(), more.begin(), more.end());
    };
    const Pose& pose = poses_[k];
    if (!open_) {
      attempt([&] { keep(inverse_.solve_all(pose, reached.front().q)); });
    } else if (about != nullptr) {
      const JointVector& there = (*about)[k];
      found.push_back(there);
      const double value = inverse_.redundancy_of(there);
      for (int i = -kFiner; i <= kFiner; ++i) {
        attempt([&] { keep(inverse_.solve_all_at(pose, value + i * width_, there)); });
      }
    } else {
      for (int i = 0; i <= kGrid; ++i) {
        const double value = from_ + (to_ - from_) * i / kGrid;
        attempt([&] { keep(inverse_.solve_all_at(pose, value, reached.front().q)); });
      }
    }
    // What the grid misses, and joints that a singular pose leaves free.
    const size_t every = std::max<size_t>(1, reached.size() / kFollowed);
    for (size_t i = 0; i < reached.size(); i += every) {
      attempt([&] { found.push_back(inverse_.solve_near(pose, reached[i].q)); });
    }
    std::vector<JointVector> distinct;
    for (JointVector& q : found) {
      const bool known = std::any_of(distinct.begin(), distinct.end(), [&](const auto& other) {
        return step_between(q, other) < kSame;
      });
      if (!known) distinct.push_back(std::move(q));
    }
    return distinct;
  }

  /// That one value has no solution says nothing of the others.
  template <typename Solve>
  static void attempt(const Solve& solve) {
    try {
      solve();
    } catch (const MotionError& error) {
      const ErrorCode code = error.code();
      if (code != ErrorCode::kUnreachable && code != ErrorCode::kOutsideLimits) throw;
    }
  }

  [[nodiscard]] std::optional<Place> reach(const JointVector& q, const Layer& reached) const {
    Place place{q, kNever, -1};
    for (size_t i = 0; i < reached.size(); ++i) {
      if (step_between(q, reached[i].q) > largest_step_) continue;
      const double cost = reached[i].cost + (q - reached[i].q).squaredNorm();
      if (cost < place.cost) {
        place.cost = cost;
        place.before = static_cast<int>(i);
      }
    }
    if (place.before < 0) return std::nullopt;
    return place;
  }

  /// Every choice ends before pose k: says which joint would have to jump, and how far.
  [[noreturn]] void refuse(size_t k, const Layer& reached) const {
    double least = kNever;
    JointVector from;
    JointVector to;
    for (const JointVector& q : candidates(k, reached, nullptr)) {
      for (const Place& place : reached) {
        if (step_between(q, place.q) >= least) continue;
        least = step_between(q, place.q);
        from = place.q;
        to = q;
      }
    }
    Problem problem;
    problem.share = share(k);
    problem.code = ErrorCode::kBranchChange;
    problem.limit = largest_step_;
    problem.ways_out = {"begin on another branch: another start",
                        "lead the tool round the place, or turn it otherwise on the way"};
    char text[240];
    if (least < kNever) {
      Eigen::Index joint = 0;
      problem.value = (to - from).cwiseAbs().maxCoeff(&joint);
      problem.joint = static_cast<int>(joint);
      std::snprintf(text, sizeof text,
                    "the way must change its branch before pose %zu of %zu, %.4g %% of it: joint "
                    "%d would jump from %.4g to %.4g, by %.4g where %.4g is allowed [rad or m]",
                    k, poses_.size(), 100.0 * share(k), static_cast<int>(joint) + 1, from[joint],
                    to[joint], *problem.value, largest_step_);
    } else {
      std::snprintf(text, sizeof text, "no choice of branch reaches pose %zu of %zu", k,
                    poses_.size());
    }
    problem.message = text;
    throw MotionError(std::move(problem));
  }

  const InverseKinematics& inverse_;
  std::span<const Pose> poses_;
  double largest_step_;
  const JointVector* goal_;
  bool open_ = false;  ///< seven joints, of which a pose leaves one number open
  double from_ = 0.0;  ///< its range
  double to_ = 0.0;
  double width_ = 0.0;  ///< of the finer grid
};

}  // namespace

std::vector<JointVector> follow_poses(const RobotModel& robot, std::span<const Pose> poses,
                                      const JointVector& start, double largest_step,
                                      const JointVector* goal) {
  if (!robot.has_kinematics()) {
    throw MotionError(ErrorCode::kUncontrolled,
                      "robot \"" + robot.name() + "\" has no kinematics: poses mean nothing to it",
                      {"move it in joint space"});
  }
  if (poses.empty() || !(largest_step > 0.0) || !std::isfinite(largest_step)) {
    throw MotionError(
        ErrorCode::kBadArgument,
        poses.empty() ? "no pose to follow" : "the largest step must be positive and finite");
  }
  if (goal != nullptr && !holds(robot, *goal, poses.back())) {
    throw MotionError(ErrorCode::kBadArgument, "the goal joints do not hold the last pose");
  }
  return Follower(robot, poses, largest_step, goal).run(start);
}

}  // namespace viapoint
