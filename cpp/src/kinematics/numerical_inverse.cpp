#include "kinematics/numerical_inverse.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "viapoint/core/error.hpp"
#include "viapoint/core/units.hpp"

namespace viapoint {
namespace {

constexpr int kIterations = 60;        ///< steps of one descent
constexpr int kPatience = 12;          ///< steps without progress that end a descent
constexpr int kMissIterations = 2000;  ///< of the one that measures how far a pose is out of reach
constexpr int kStarts = 60;            ///< descents before a pose is given up
constexpr int kSearchStarts = 200;     ///< descents when every branch is wanted
constexpr int kIdleStarts = 40;        ///< descents in a row that find nothing new end that search
constexpr int kNearStarts = 24;        ///< descents that look for a nearer branch
constexpr double kNearEnough =
    0.35;                          ///< a change of every joint below this needs no such look [rad]
constexpr double kDamping = 0.02;  ///< λ = this · ‖e‖²
constexpr double kDampingFloor = 1e-15;
constexpr double kMostStep = 0.8;  ///< of one joint in one step [rad or m]
constexpr double kDone = 1e-13;    ///< error below which no step is of use

constexpr std::array<int, kMaxJoints> kPrimes{2,  3,  5,  7,  11, 13, 17, 19,
                                              23, 29, 31, 37, 41, 43, 47, 53};

/// Element `index` of the van der Corput sequence in `base`, in (0, 1) (Halton 1960).
double radical_inverse(int index, int base) {
  double value = 0.0;
  double digit = 1.0;
  for (int rest = index; rest > 0; rest /= base) {
    digit /= base;
    value += digit * (rest % base);
  }
  return value;
}

}  // namespace

NumericalInverse::NumericalInverse(const ForwardKinematics& forward, const JointLimits& limits,
                                   std::string why)
    : LimitedInverse(forward, limits), why_(std::move(why)) {
  JointVector travel = JointVector::Zero(forward_.joints());
  for (int i = 0; i < forward_.joints(); ++i) {
    if (forward_.type(i) != JointType::kPrismatic) continue;
    const double most =
        std::max(std::abs(limits_.position_min[i]), std::abs(limits_.position_max[i]));
    travel[i] = std::isfinite(most) ? most : 1.0;
  }
  const JointVector reach = forward_.reach_bound(travel);
  length_ = std::max(0.5 * std::max(reach.maxCoeff(), travel.maxCoeff()), 1e-3);
  for (int sample = 1; sample <= 8; ++sample) {
    const Jacobian jacobian = forward_.jacobian(forward_.frames(start(sample)));
    for (int row = 0; row < 6; ++row) {
      if (jacobian.row(row).cwiseAbs().maxCoeff() > 1e-9) moves_[static_cast<size_t>(row)] = true;
    }
  }
}

std::string NumericalInverse::family() const { return "numerical: " + why_; }

JointVector NumericalInverse::start(int index) const {
  JointVector q(forward_.joints());
  for (int i = 0; i < q.size(); ++i) {
    const bool turns = forward_.type(i) == JointType::kRevolute;
    const double wide = turns ? kPi : length_;
    const double low = std::isfinite(limits_.position_min[i]) ? limits_.position_min[i] : -wide;
    const double high = std::isfinite(limits_.position_max[i]) ? limits_.position_max[i] : wide;
    q[i] = low + (high - low) * radical_inverse(index, kPrimes[static_cast<size_t>(i)]);
  }
  return q;
}

bool NumericalInverse::redundant(const InverseTask& task) const {
  const auto rows =
      std::count(moves_.begin(), task.position_only ? moves_.begin() + 3 : moves_.end(), true);
  return forward_.joints() > rows;
}

NumericalInverse::Descent NumericalInverse::descend(const InverseTask& task, JointVector q,
                                                    bool bounded, int iterations,
                                                    int patience) const {
  using Square = JointMatrix;
  const int joints = forward_.joints();
  const int rows = task.position_only ? 3 : 6;
  if (bounded) q = q.cwiseMax(limits_.position_min).cwiseMin(limits_.position_max);
  Descent best{q, {1e300, 1e300}};
  double least = 1e300;
  int idle = 0;
  double caution = 1.0;  // more damping while the error grows: a goal out of reach bends the valley
  double before = 1e300;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    const ChainFrames frames = forward_.frames(q);
    Twist miss;
    miss.head<3>() = task.goal.translation() - frames.pose_base_tool.translation();
    miss.tail<3>().setZero();
    if (!task.position_only) {
      miss.tail<3>() =
          rotation_log(task.goal.linear() * frames.pose_base_tool.linear().transpose());
    }
    const PoseError now{miss.head<3>().norm(), miss.tail<3>().norm()};
    miss.head<3>() /= length_;
    const double square = miss.squaredNorm();
    idle = square < 0.7 * least ? 0 : idle + 1;
    if (square < least) {
      least = square;
      best = {q, now};
    }
    const bool solved = best.error.within(kPoseTolerance);
    if (now.within(kDone) || idle >= (solved ? 2 : patience)) break;

    Jacobian jacobian = forward_.jacobian(frames);
    jacobian.topRows<3>() /= length_;
    caution = square > before ? std::min(4.0 * caution, 1e6) : std::max(0.7 * caution, 1.0);
    before = square;
    const double damping = kDamping * caution * square + kDampingFloor;
    JointVector step(joints);
    // A joint on its limit that would go on outwards is held, and the others solve without it.
    for (int pass = 0; pass < joints; ++pass) {
      if (joints <= rows) {
        Square normal = jacobian.topRows(rows).transpose() * jacobian.topRows(rows);
        normal.diagonal().array() += damping;
        step = normal.ldlt().solve(jacobian.topRows(rows).transpose() * miss.head(rows));
      } else {
        Square normal = jacobian.topRows(rows) * jacobian.topRows(rows).transpose();
        normal.diagonal().array() += damping;
        const JointVector force = normal.ldlt().solve(JointVector(miss.head(rows)));
        step = jacobian.topRows(rows).transpose() * force;
      }
      if (!bounded) break;
      bool held = false;
      for (int i = 0; i < joints; ++i) {
        const bool outwards = (q[i] >= limits_.position_max[i] && step[i] > 0.0) ||
                              (q[i] <= limits_.position_min[i] && step[i] < 0.0);
        if (!outwards) continue;
        jacobian.col(i).setZero();
        held = true;
      }
      if (!held) break;
    }
    const double most = step.lpNorm<Eigen::Infinity>();
    if (most > kMostStep) step *= kMostStep / most;
    q += step;
    if (bounded) q = q.cwiseMax(limits_.position_min).cwiseMin(limits_.position_max);
  }
  return best;
}

void NumericalInverse::add(const InverseTask& task, const JointVector& branch,
                           std::vector<JointVector>& branches) const {
  constexpr double kSame = 1e-6;
  constexpr double kMerging = 1e-2;  // two branches that meet, as at a stretched elbow
  for (JointVector& known : branches) {
    const JointVector apart = turns_.unlimited(branch, known) - known;
    const double distance = apart.lpNorm<Eigen::Infinity>();
    if (distance < kSame) return;
    if (distance > kMerging) continue;
    const JointVector middle = known + 0.5 * apart;
    const PoseError there = error(task, middle);
    if (!there.within(kPoseTolerance)) continue;
    const PoseError here = error(task, known);
    if (there.position + there.angle < here.position + here.angle) known = middle;
    return;
  }
  branches.push_back(branch);
}

NumericalInverse::Search NumericalInverse::search(const InverseTask& task,
                                                  const JointVector& reference, int starts,
                                                  size_t enough) const {
  Search found;
  int idle = 0;
  for (int index = 0; index < starts && idle < kIdleStarts; ++index) {
    // The reference itself is tried both ways, then the sequence.
    const bool bounded = index % 2 == 1;
    const Descent end =
        descend(task, index < 2 ? reference : start(index), bounded, kIterations, kPatience);
    if (!end.error.within(kPoseTolerance)) {
      if (end.error.position + length_ * end.error.angle <
          found.least.position + length_ * found.least.angle) {
        found.least = end.error;
        found.nearest = end.q;
      }
      continue;
    }
    const size_t before = found.inside.size() + found.outside.size();
    const auto turned = turns_.nearest(end.q, reference);
    if (turned && confirmed(task, *turned)) {
      add(task, *turned, found.inside);
      if (found.inside.size() >= enough) return found;
    } else {
      add(task, end.q, found.outside);
    }
    idle = found.inside.size() + found.outside.size() > before ? 0 : idle + 1;
  }
  return found;
}

std::vector<JointVector> NumericalInverse::all(const InverseTask& task,
                                               const JointVector& reference) const {
  const Search found = search(task, reference, kSearchStarts, SIZE_MAX);
  if (found.inside.empty()) refuse(task, found);
  std::vector<JointVector> solutions;
  for (const JointVector& branch : found.inside) {
    for (const JointVector& q : turns_.all(branch, reference)) {
      if (confirmed(task, q)) solutions.push_back(q);
    }
  }
  std::sort(solutions.begin(), solutions.end(),
            [&](const auto& a, const auto& b) { return is_nearer(a, b, reference); });
  return solutions;
}

JointVector NumericalInverse::near(const InverseTask& task, const JointVector& reference) const {
  Search found = search(task, reference, kStarts, 1);
  if (found.inside.empty()) refuse(task, found);
  const double change = (found.inside.front() - reference).lpNorm<Eigen::Infinity>();
  if (redundant(task) || change < kNearEnough) return found.inside.front();
  // The descent may have passed over a nearer branch.
  for (const JointVector& q : search(task, reference, kNearStarts, SIZE_MAX).inside) {
    if (is_nearer(q, found.inside.front(), reference)) found.inside.front() = q;
  }
  return found.inside.front();
}

std::optional<JointVector> NumericalInverse::follow(const InverseTask& task,
                                                    const JointVector& reference) const {
  const Descent end = descend(task, reference, true, kIterations, kPatience);
  if (!end.error.within(kPoseTolerance) || !limits_.contains(end.q)) return std::nullopt;
  return end.q;
}

std::optional<JointVector> NumericalInverse::find(const InverseTask& task,
                                                  const JointVector& reference) const {
  const Search found = search(task, reference, kStarts, 1);
  return found.inside.empty() ? std::nullopt : std::optional(found.inside.front());
}

void NumericalInverse::refuse(const InverseTask& task, const Search& search_result) const {
  if (!search_result.outside.empty()) {
    refuse_outside_limits(forward_, turns_, search_result.outside);
  }
  // Beyond the boundary the descent creeps, so the distance gets a long one of its own.
  const InverseTask place_only(Eigen::Vector3d(task.goal.translation()));
  const auto measured = [&](const Search& miss) {
    return descend(place_only, miss.nearest, false, kMissIterations, kMissIterations)
        .error.position;
  };
  if (task.position_only) refuse_unreachable("the position", measured(search_result));
  const Search place = search(place_only, JointVector::Zero(forward_.joints()), kStarts, 1);
  if (place.inside.empty() && place.outside.empty()) {
    refuse_unreachable("the position of the pose", measured(place));
  }
  const PoseError least = search_result.least;
  const std::string miss = "the nearest found is " + std::to_string(least.position) + " m and " +
                           joint_value(JointType::kRevolute, least.angle) + " away";
  Problem problem;
  problem.value = least.angle;
  problem.limit = 0.0;
  if (forward_.joints() >= 6) {
    problem.code = ErrorCode::kUnreachable;
    problem.message =
        "the position is within reach, but not with this orientation within the joint limits: " +
        miss;
    problem.ways_out = {"turn the pose", "move it away from the edge of the arm's working range"};
    throw MotionError(std::move(problem));
  }
  static constexpr std::array kRows{"x", "y", "z", "turn about x", "turn about y", "turn about z"};
  std::string rows;
  for (size_t row = 0; row < kRows.size(); ++row) {
    if (!moves_[row]) continue;
    if (!rows.empty()) rows += ", ";
    rows += kRows[row];
  }
  problem.code = ErrorCode::kUncontrolled;
  problem.message = "an arm of " + std::to_string(forward_.joints()) +
                    " joints cannot hold all six coordinates of this pose: " + miss +
                    "; what it can move, not independently, is: " + rows;
  problem.ways_out = {"ask for the position only",
                      "give a pose this arm can take, such as one from its forward kinematics"};
  throw MotionError(std::move(problem));
}

JointVector NumericalInverse::near_unlimited(const InverseTask& task,
                                             const JointVector& reference) const {
  Search found;
  for (int index = 0; index < kStarts; ++index) {
    const Descent end =
        descend(task, index == 0 ? reference : start(index), false, kIterations, kPatience);
    if (end.error.within(kPoseTolerance)) return turns_.unlimited(end.q, reference);
    if (end.error.position < found.least.position) {
      found.least = end.error;
      found.nearest = end.q;
    }
  }
  refuse(task, found);
}

}  // namespace viapoint
