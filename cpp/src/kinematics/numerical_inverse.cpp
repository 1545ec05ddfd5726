#include "kinematics/numerical_inverse.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "viapoint/core/error.hpp"
#include "viapoint/core/units.hpp"

namespace viapoint {
namespace {

constexpr int kMissIterations = 2000;  ///< of the one that measures how far a pose is out of reach
constexpr int kStarts = 60;            ///< descents before a pose is given up
constexpr int kSearchStarts = 200;     ///< descents when every branch is wanted
constexpr int kIdleStarts = 40;        ///< descents in a row that find nothing new end that search
constexpr int kNearStarts = 16;        ///< descents that look for a nearer branch
constexpr double kNearEnough =
    0.35;  ///< a change of every joint below this needs no such look [rad]

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

/// Half of what the arm reaches [m].
double length_of(const ForwardKinematics& forward, const JointLimits& limits) {
  JointVector travel = JointVector::Zero(forward.joints());
  for (int i = 0; i < forward.joints(); ++i) {
    if (forward.type(i) != JointType::kPrismatic) continue;
    const double most =
        std::max(std::abs(limits.position_min[i]), std::abs(limits.position_max[i]));
    travel[i] = std::isfinite(most) ? most : 1.0;
  }
  const JointVector reach = forward.reach_bound(travel);
  return std::max(0.5 * std::max(reach.maxCoeff(), travel.maxCoeff()), 1e-3);
}

}  // namespace

NumericalInverse::NumericalInverse(const ForwardKinematics& forward, const JointLimits& limits,
                                   std::string why)
    : LimitedInverse(forward, limits),
      why_(std::move(why)),
      length_(length_of(forward, limits)),
      descent_(forward, limits, length_) {
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
    const Descent::End end =
        descent_.run(task, index < 2 ? reference : start(index), {.bounded = index % 2 == 1});
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
  for (const JointVector& branch : found.inside) add_turns(task, branch, reference, solutions);
  sort_nearest_first(solutions, reference);
  return solutions;
}

JointVector NumericalInverse::near(const InverseTask& task, const JointVector& reference) const {
  const Search found = search(task, reference, kStarts, 1);
  if (found.inside.empty()) refuse(task, found);
  const double change = (found.inside.front() - reference).lpNorm<Eigen::Infinity>();
  if (redundant(task) || change < kNearEnough) return found.inside.front();
  // The descent may have passed over a nearer branch.
  JointVector best = found.inside.front();
  for (int index = 1; index <= kNearStarts; ++index) {
    const Descent::End end = descent_.run(task, start(index), {});
    if (!end.error.within(kPoseTolerance)) continue;
    const auto turned = turns_.nearest(end.q, reference);
    if (turned && is_nearer(*turned, best, reference) && confirmed(task, *turned)) best = *turned;
  }
  return best;
}

std::optional<JointVector> NumericalInverse::follow(const InverseTask& task,
                                                    const JointVector& reference,
                                                    double leash) const {
  const Descent::End end = descent_.run(task, reference, {.bounded = true, .leash = leash});
  if (!end.error.within(kPoseTolerance) || !limits_.contains(end.q)) return std::nullopt;
  return end.q;
}

std::optional<JointVector> NumericalInverse::find(const InverseTask& task,
                                                  const JointVector& reference) const {
  const Search found = search(task, reference, kStarts, 1);
  return found.inside.empty() ? std::nullopt : std::optional(found.inside.front());
}

std::vector<JointVector> NumericalInverse::find_all(const InverseTask& task,
                                                    const JointVector& reference) const {
  return search(task, reference, kSearchStarts, SIZE_MAX).inside;
}

void NumericalInverse::refuse(const InverseTask& task, const Search& search_result) const {
  if (!search_result.outside.empty()) {
    refuse_outside_limits(forward_, turns_, search_result.outside);
  }
  // Beyond the boundary the descent creeps, so the distance gets a long one of its own.
  const InverseTask place_only(Eigen::Vector3d(task.goal.translation()));
  const auto measured = [&](const Search& miss) {
    return descent_
        .run(place_only, miss.nearest, {.iterations = kMissIterations, .patience = kMissIterations})
        .error.position;
  };
  if (task.position_only) refuse_unreachable("the position", measured(search_result));
  const Search place = search(place_only, JointVector::Zero(forward_.joints()), kStarts, 1);
  if (place.inside.empty() && place.outside.empty()) {
    refuse_unreachable("the position of the pose", measured(place));
  }
  const PoseError least = search_result.least;
  const std::string miss = "the nearest found is " +
                           joint_value(JointType::kPrismatic, least.position) + " and " +
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
    const Descent::End end = descent_.run(task, index == 0 ? reference : start(index), {});
    if (end.error.within(kPoseTolerance)) return turns_.unlimited(end.q, reference);
    if (end.error.position < found.least.position) {
      found.least = end.error;
      found.nearest = end.q;
    }
  }
  refuse(task, found);
}

}  // namespace viapoint
