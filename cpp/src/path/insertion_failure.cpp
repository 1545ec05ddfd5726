#include "path/insertion_failure.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <utility>

#include "viapoint/core/units.hpp"

namespace viapoint {
namespace {

/// How far ahead of the stop the arm is asked whether it gets there at all, as a share of the
/// curve.
constexpr double kProbe = 1e-3;
/// The curve counts as reached ahead when it is missed by less than this share of the tolerances:
/// the arm may otherwise stand at the edge of its workspace, out of it by less than they are.
constexpr double kReachedShare = 1e-3;
/// Starts of the search for any solution ahead; fixed seed, so that a refusal repeats.
constexpr int kProbeStarts = 24;
constexpr unsigned kProbeSeed = 1;
/// Smallest over largest singular value above which the arm counts as clear of singularities.
constexpr double kClearOfSingularity = 1e-2;

/// Halvings that tell where a curve leaves the reach, to rounding.
constexpr int kShareHalvings = 60;

constexpr const char* kWristWayOut =
    "keep the tool position on the curve and interpolate the wrist joints (orientation=\"wrist\")";

std::string format(const char* pattern, double a, double b = 0.0, double c = 0.0) {
  std::array<char, 300> text{};
  std::snprintf(text.data(), text.size(), pattern, a, b, c);
  return text.data();
}

/// The least miss ahead over many starts, [m and rad], and whether it is within the tolerances.
struct Ahead {
  Twist miss;
  bool reached = false;
};

Ahead look_ahead(const CurveFollower& follower, const PathPoint& here, double s,
                 const InsertionOptions& options) {
  Ahead best;
  best.miss.setConstant(std::numeric_limits<double>::infinity());
  std::mt19937 random(kProbeSeed);
  std::normal_distribution<double> normal;
  for (int start = 0; start < kProbeStarts && !best.reached; ++start) {
    JointVector guess = here.q;
    const double spread = 0.1 * start;
    for (double& value : guess) value += spread * normal(random);
    const Twist miss = follower.nearest_miss(s, guess);
    if (miss.norm() < best.miss.norm()) best.miss = miss;
    best.reached = best.miss.head<3>().norm() <= kReachedShare * options.position_tolerance &&
                   best.miss.tail<3>().norm() <= kReachedShare * options.angle_tolerance;
  }
  return best;
}

/// "x, rotation about z": those that are true.
std::string coordinate_names(const std::array<bool, 6>& which) {
  static constexpr std::array<const char*, 6> kNames = {
      "x", "y", "z", "rotation about x", "rotation about y", "rotation about z"};
  std::string names;
  for (size_t i = 0; i < kNames.size(); ++i) {
    if (!which[i]) continue;
    if (!names.empty()) names += ", ";
    names += kNames[i];
  }
  return names.empty() ? "none" : names;
}

/// The coordinates that carry the miss.
std::array<bool, 6> missed(const Twist& miss) {
  std::array<bool, 6> which{};
  const double largest = miss.cwiseAbs().maxCoeff();
  for (size_t i = 0; i < which.size(); ++i) {
    which[i] = std::abs(miss[static_cast<Eigen::Index>(i)]) >= 0.1 * largest;
  }
  return which;
}

/// The stretched chain from the first joint to the tool, which nothing can be farther than [m].
double length_of_chain(const ForwardKinematics& arm, const JointLimits& limits,
                       const JointVector& start) {
  const ChainFrames frames = arm.frames(start);
  double length = 0.0;
  for (int i = 0; i < arm.joints(); ++i) {
    const auto joint = static_cast<size_t>(i);
    const Eigen::Vector3d& here = frames.origin[joint];
    const Eigen::Vector3d next =
        i + 1 < arm.joints() ? frames.origin[joint + 1] : frames.pose_base_tool.translation();
    length += (next - here).norm();
    if (arm.type(i) == JointType::kPrismatic) {
      length += std::abs(start[i]) +
                std::max(std::abs(limits.position_min[i]), std::abs(limits.position_max[i]));
    }
  }
  return length;
}

Problem too_few_joints(const CurveFollower& follower, const PathPoint& here, const Ahead& ahead,
                       double share) {
  Problem problem;
  problem.code = ErrorCode::kUncontrolled;
  problem.message = format("beyond %.2f %% of the curve the %.0f joints of the arm cannot hold ",
                           100.0 * share, static_cast<double>(follower.free_joints())) +
                    coordinate_names(missed(ahead.miss)) +
                    "; what it can hold there: " + coordinate_names(follower.holds(here.q));
  problem.value = ahead.miss.norm();
  problem.ways_out = {"ask only for the tool position, or keep the orientation the arm can hold",
                      "use a joint move to the goal"};
  return problem;
}

/// How many of the held coordinates' rates are independent of each other.
Eigen::Index independent_rates(const CurveFollower& follower, const JointVector& q) {
  constexpr double kDependent = 1e-9;
  const Eigen::VectorXd values = follower.singular_values(q);
  return (values.array() > kDependent * values[0]).count();
}

/// The most independent rates that the joints have anywhere.
Eigen::Index controlled(const CurveFollower& follower, const JointVector& here) {
  constexpr int kPlaces = 8;
  std::mt19937 random(kProbeSeed);
  std::uniform_real_distribution<double> angle(-kPi, kPi);
  Eigen::Index most = independent_rates(follower, here);
  for (int place = 0; place < kPlaces; ++place) {
    JointVector q = here;
    for (double& value : q) value = angle(random);
    most = std::max(most, independent_rates(follower, q));
  }
  return most;
}

/// Of joints that are many enough, but never independent: those of a shoulder that turn about one
/// point do not change its distance from what hangs on it.
Problem dependent_joints(const CurveFollower& follower, Eigen::Index controlled, double share,
                         const InsertionOptions& options) {
  const bool by_wrist = options.hold == Hold::kWrist;
  Problem problem;
  problem.code = ErrorCode::kUncontrolled;
  problem.value = static_cast<double>(controlled);
  problem.limit = follower.coordinates();
  const char* pattern =
      by_wrist ? "the first %.0f joints of this arm, which are to hold the tool position while the "
                 "others go straight, control only %.0f of its %.0f coordinates"
               : "the %.0f joints of the arm control only %.0f of the %.0f coordinates to be held";
  problem.message = format(pattern, follower.free_joints(), *problem.value, *problem.limit) +
                    format(": beyond %.2f %% of the curve they cannot follow it", 100.0 * share);
  if (by_wrist) {
    problem.ways_out = {"orientation=\"least\", which all joints hold",
                        "orientation=\"free\", where only the tool position counts"};
  } else {
    problem.ways_out = {"ask only for the tool position"};
  }
  problem.ways_out.emplace_back("use a joint move to the goal");
  return problem;
}

Problem out_of_reach(const Ahead& ahead, double share, const InsertionOptions& options) {
  Problem problem;
  problem.code = ErrorCode::kUnreachable;
  problem.message =
      format("the curve leaves the workspace at %.2f %% of its length: %.1f %% farther on the arm ",
             100.0 * share, 100.0 * kProbe) +
      format("misses it by %.3g mm and %.3g°", 1e3 * ahead.miss.head<3>().norm(),
             ahead.miss.tail<3>().norm() / kDegree);
  problem.value = ahead.miss.head<3>().norm();
  problem.limit = options.position_tolerance;
  problem.ways_out = {"move the points nearer to the arm",
                      "use a joint move where the curve is not needed"};
  return problem;
}

Problem singular(const PathPoint& here, double smallest, double share,
                 const InsertionOptions& options) {
  int fastest = 0;
  here.q1.cwiseAbs().maxCoeff(&fastest);
  Problem problem;
  problem.code = ErrorCode::kSingular;
  problem.message = format(
      "at %.2f %% of the curve the arm is singular (smallest singular value %.1g): the rate "
      "of joint %.0f grows without bound",
      100.0 * share, smallest, fastest + 1.0);
  problem.joint = fastest;
  problem.value = smallest;
  problem.ways_out = {"use a joint move for this leg",
                      "move the curve a little aside, or change its orientation"};
  if (options.hold == Hold::kPose) problem.ways_out.emplace_back(kWristWayOut);
  return problem;
}

}  // namespace

void throw_insertion_failure(const CurveFollower& follower, const TaskCurve& curve,
                             const PathPoint& here, double s, const InsertionOptions& options) {
  const double share = s / curve.length();
  const Eigen::VectorXd values = follower.singular_values(here.q);
  const double smallest = values[values.size() - 1];
  const Ahead ahead =
      look_ahead(follower, here, std::min(s + kProbe * curve.length(), curve.length()), options);
  Problem problem;
  if (ahead.reached) {
    problem = singular(here, smallest, share, options);
  } else if (follower.free_joints() < follower.coordinates() &&
             smallest > kClearOfSingularity * values[0]) {
    problem = too_few_joints(follower, here, ahead, share);
  } else if (const Eigen::Index most = controlled(follower, here.q);
             most < std::min(follower.free_joints(), follower.coordinates())) {
    problem = dependent_joints(follower, most, share, options);
  } else {
    problem = out_of_reach(ahead, share, options);
  }
  problem.share = share;
  throw MotionError(std::move(problem));
}

void refuse_far_goal(const ForwardKinematics& arm, const JointLimits& limits,
                     const TaskCurve& curve, const JointVector& start, double factor) {
  const double reach = length_of_chain(arm, limits, start);
  const Eigen::Vector3d base = arm.frames(start).origin[0];
  // The norm that does not overflow; written so that NaN is refused.
  const auto distance = [&](double s) { return (curve.at(s).p - base).stableNorm(); };
  const double goal = distance(curve.length());
  if (goal <= factor * reach) return;
  double within = 0.0;
  double beyond = 1.0;
  for (int halving = 0; halving < kShareHalvings; ++halving) {
    const double middle = 0.5 * (within + beyond);
    (distance(middle * curve.length()) <= reach ? within : beyond) = middle;
  }
  Problem problem;
  problem.code = ErrorCode::kUnreachable;
  problem.message =
      format("the curve leads to %.3g m from the first joint, and the arm reaches %.3g m at most",
             goal, reach);
  problem.share = beyond;
  problem.value = goal;
  problem.limit = reach;
  problem.ways_out = {"give the position in metres, within the reach of the arm"};
  throw MotionError(std::move(problem));
}

void throw_endless_work(size_t pieces, double share, const InsertionOptions& options) {
  Problem problem;
  problem.code = ErrorCode::kBadArgument;
  problem.message = format("the curve is too much work: %.0f pieces lead to %.2f %% of it within ",
                           static_cast<double>(pieces), 100.0 * share) +
                    format("%.3g mm and %.3g°", options.position_tolerance / kMillimetre,
                           options.angle_tolerance / kDegree);
  problem.share = share;
  problem.value = static_cast<double>(pieces);
  problem.ways_out = {"divide the curve into several moves", "give a larger tolerance"};
  throw MotionError(std::move(problem));
}

void throw_limit_crossing(const ForwardKinematics& arm, const LimitCrossing& crossing, double share,
                          const InsertionOptions& options) {
  Problem problem;
  problem.share = share;
  problem.value = crossing.value;
  problem.limit = crossing.limit;
  const double percent = 100.0 * share;
  if (crossing.coupling >= 0) {
    problem.code = ErrorCode::kCouplingLimit;
    problem.message = format("coupled limit %.0f, ", crossing.coupling + 1.0) +
                      format("%.6g, is passed at %.2f %% of the curve; its value would go to %.6g",
                             crossing.limit, percent, crossing.value);
  } else {
    problem.code = ErrorCode::kJointLimit;
    problem.joint = crossing.joint;
    const bool turns = arm.type(crossing.joint) == JointType::kRevolute;
    const double unit = turns ? kDegree : kMillimetre;
    problem.message =
        format("joint %.0f ", crossing.joint + 1.0) +
        format(turns
                   ? "passes its limit of %.6g° at %.2f %% of the curve and would go to %.6g°"
                   : "passes its limit of %.6g mm at %.2f %% of the curve and would go to %.6g mm",
               crossing.limit / unit, percent, crossing.value / unit);
  }
  problem.ways_out = {"use a joint move for this leg"};
  if (options.hold == Hold::kPose) problem.ways_out.emplace_back(kWristWayOut);
  problem.ways_out.emplace_back("start the curve on another branch");
  throw MotionError(std::move(problem));
}

}  // namespace viapoint
