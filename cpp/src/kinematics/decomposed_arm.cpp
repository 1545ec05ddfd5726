#include "kinematics/decomposed_arm.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "viapoint/core/units.hpp"

namespace viapoint {
namespace {

constexpr int kTrials = 24;      ///< joint vectors that a decomposition must find again
constexpr double kFound = 1e-6;  ///< how exactly [rad or m]

/// Seeded joints in general position: what is recognised depends on the arm alone.
JointVector trial_joints(std::span<const Screw> joints, std::mt19937_64& generator) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  JointVector q(static_cast<Eigen::Index>(joints.size()));
  for (int i = 0; i < q.size(); ++i) {
    const bool turns = joints[static_cast<size_t>(i)].type == JointType::kRevolute;
    q[i] = (turns ? 0.95 * kPi : 1.0) * unit(generator);
  }
  return q;
}

Pose motion_of(std::span<const Screw> joints, const JointVector& q) {
  Pose motion = Pose::Identity();
  for (size_t i = 0; i < joints.size(); ++i) {
    motion = motion * joints[i].motion(q[static_cast<Eigen::Index>(i)]);
  }
  return motion;
}

bool on_axis(const Screw& joint, const Eigen::Vector3d& point) {
  return joint.type == JointType::kRevolute &&
         joint.axis.cross(point - joint.origin).norm() < kExactAxes;
}

/// Points that all these axes pass through; of one axis, two of its points; of none, the tool.
std::vector<Eigen::Vector3d> common_points(std::span<const Screw> joints,
                                           const Eigen::Vector3d& tool) {
  if (joints.empty()) return {tool};
  if (joints.size() == 1) return {joints[0].origin, joints[0].origin + 0.1 * joints[0].axis};
  const auto meeting =
      nearest_point(joints[0].origin, joints[0].axis, joints[1].origin, joints[1].axis);
  if (!meeting) return {};
  return {*meeting};
}

/// Angles modulo whole turns, lengths as they are.
bool same_joints(std::span<const Screw> joints, const JointVector& a, const JointVector& b,
                 int count) {
  for (int i = 0; i < count; ++i) {
    const bool turns = joints[static_cast<size_t>(i)].type == JointType::kRevolute;
    const double apart = turns ? std::remainder(a[i] - b[i], 2.0 * kPi) : a[i] - b[i];
    if (!(std::abs(apart) < kFound)) return false;
  }
  return true;
}

/// The turning joint before or after `joint` with a parallel axis.
std::optional<size_t> parallel_turn(std::span<const Screw> joints, size_t joint) {
  for (size_t other = 0; other < joints.size(); ++other) {
    if (other == joint || joints[other].type != JointType::kRevolute ||
        joints[joint].type != JointType::kRevolute) {
      continue;
    }
    if (joints[other].axis.cross(joints[joint].axis).norm() < kExactAxes) return other;
  }
  return std::nullopt;
}

}  // namespace

std::optional<Decomposition> Decomposition::find(std::span<const Screw> joints,
                                                 const Eigen::Vector3d& tool) {
  const size_t n = joints.size();
  if (n == 0 || n > 6) return std::nullopt;
  for (const bool inverted : {false, true}) {
    Decomposition arm;
    arm.inverted_ = inverted;
    arm.joints_.assign(joints.begin(), joints.end());
    if (inverted) std::reverse(arm.joints_.begin(), arm.joints_.end());
    const std::span<const Screw> chain(arm.joints_);
    const size_t fewest = n > 3 ? n - 3 : 1;
    for (size_t placing = std::min<size_t>(3, n); placing >= fewest; --placing) {
      const auto turning = chain.subspan(placing);
      if (inverted && turning.empty()) continue;
      arm.orientation_ = OrientationProblem::plan(turning);
      if (!arm.orientation_) continue;
      for (const Eigen::Vector3d& point : common_points(turning, tool)) {
        if (!std::all_of(turning.begin(), turning.end(),
                         [&](const Screw& joint) { return on_axis(joint, point); })) {
          continue;
        }
        arm.point_ = point;
        arm.position_ = PositionProblem::plan(chain.first(placing), point);
        if (!arm.position_) continue;
        arm.name_choices();
        if (arm.finds_joints_again()) return arm;
      }
    }
  }
  return std::nullopt;
}

void Decomposition::name_choices() {
  const size_t placing = joints_.size() - static_cast<size_t>(orientation_->joints());
  const auto choices = position_->choices();
  // From the base: shoulder, elbow, wrist. The placing joints come last when the chain is inverted.
  std::vector<size_t> chosen;
  for (size_t i = 0; i < placing; ++i) {
    if (choices[i]) chosen.push_back(i);
  }
  if (inverted_) std::reverse(chosen.begin(), chosen.end());
  turning_side_ = inverted_ ? &ArmSides::shoulder : &ArmSides::wrist;
  placing_side_ = {};
  if (chosen.size() == 2) {
    placing_side_[chosen[0]] = inverted_ ? &ArmSides::elbow : &ArmSides::shoulder;
    placing_side_[chosen[1]] = inverted_ ? &ArmSides::wrist : &ArmSides::elbow;
  } else if (chosen.size() == 1) {
    const bool elbow = inverted_ || parallel_turn(std::span(joints_).first(placing), chosen[0]);
    placing_side_[chosen[0]] = elbow ? &ArmSides::elbow : &ArmSides::shoulder;
  }
  // Up is the side of a positive turn about the first of the two parallel axes; where these two are
  // the first to turn (planar arms, SCARA), of a negative one: left, as seen from above.
  elbow_sign_ = inverted_ ? -1.0 : 1.0;
  for (const size_t joint : chosen) {
    if (placing_side_[joint] != &ArmSides::elbow) continue;
    const auto partner = parallel_turn(std::span(joints_).first(placing), joint);
    if (!partner) continue;
    if (joints_[*partner].axis.dot(joints_[joint].axis) < 0.0) elbow_sign_ = -elbow_sign_;
    const auto first = std::find_if(joints_.begin(), joints_.end(), [](const Screw& each) {
      return each.type == JointType::kRevolute;
    });
    const auto other = joints_.begin() + static_cast<std::ptrdiff_t>(*partner);
    if (!inverted_ && other == first) elbow_sign_ = -elbow_sign_;
  }
}

bool Decomposition::finds_joints_again() const {
  std::vector<Screw> chain = joints_;
  if (inverted_) std::reverse(chain.begin(), chain.end());
  std::mt19937_64 generator(1);
  for (int trial = 0; trial < kTrials; ++trial) {
    const JointVector q = trial_joints(chain, generator);
    ClosedSolutions found;
    solve(motion_of(chain, q), JointVector::Zero(q.size()), found);
    const bool again =
        std::any_of(found.branches.begin(), found.branches.end(), [&](const ClosedBranch& branch) {
          return same_joints(chain, branch.q, q, static_cast<int>(q.size()));
        });
    if (!again) return false;
  }
  return true;
}

void Decomposition::solve(const Pose& motion, const JointVector& held, ClosedSolutions& solutions,
                          const JointSieve& sieve, double before) const {
  const auto n = static_cast<int>(joints_.size());
  const auto turning = orientation_->joints();
  const int placing = n - turning;
  // From the tool, the joints come in the other order and turn the other way.
  const auto joint_of = [&](int step) { return inverted_ ? n - 1 - step : step; };
  const double way = inverted_ ? -1.0 : 1.0;
  const Pose task = inverted_ ? motion.inverse(Eigen::Isometry) : motion;
  std::array<double, 6> kept{};
  for (int step = 0; step < n; ++step) {
    kept[static_cast<size_t>(step)] = way * held[joint_of(step)];
  }
  const std::span<const double> all(kept);

  PositionRoots places;
  position_->solve(task * point_, all, places);
  solutions.held = solutions.held || places.held;
  solutions.near_miss = places.near_miss;
  if (places.count == 0) solutions.out_of_reach = places.missing;
  for (int i = 0; i < places.count; ++i) {
    const PositionRoot& place = places.roots[static_cast<size_t>(i)];
    double squares = before;
    for (int step = 0; step < placing; ++step) {
      squares += sieve.square(joint_of(step), way * place.q[static_cast<size_t>(step)]);
    }
    if (!sieve.passes(squares)) continue;
    Eigen::Matrix3d rest = task.linear();
    for (int step = 0; step < placing; ++step) {
      const auto k = static_cast<size_t>(step);
      if (joints_[k].type == JointType::kRevolute) {
        rest = joints_[k].rotation(-place.q[k]) * rest;
      }
    }
    OrientationRoots turns;
    orientation_->solve(rest, all.subspan(static_cast<size_t>(placing)), turns);
    for (int k = 0; k < turns.count; ++k) {
      const OrientationRoot& turn = turns.roots[static_cast<size_t>(k)];
      ClosedBranch& branch = solutions.branches.add();
      branch.q.resize(n);
      branch.sides = ArmSides();
      for (int step = 0; step < n; ++step) {
        const bool places_it = step < placing;
        const auto here = static_cast<size_t>(places_it ? step : step - placing);
        branch.q[joint_of(step)] = way * (places_it ? place.q[here] : turn.q[here]);
        if (places_it && placing_side_[here] != nullptr) {
          const bool elbow = placing_side_[here] == &ArmSides::elbow;
          branch.sides.*placing_side_[here] = place.side[here] * (elbow ? elbow_sign_ : 1.0);
        }
      }
      if (turning < 3) continue;
      branch.sides.*turning_side_ = turn.side;
      branch.wrist_free = turn.free;
      branch.first = joint_of(placing);
      branch.second = joint_of(placing + 2);
      branch.wrist_sign = turn.sign;
      branch.wrist_sum = branch.q[branch.first] + turn.sign * branch.q[branch.second];
    }
  }
}

std::string Decomposition::describe() const {
  const int n = static_cast<int>(joints_.size());
  const int turning = orientation_->joints();
  const auto list = [&](int from, int to) {
    std::vector<int> numbers;
    for (int step = from; step < to; ++step)
      numbers.push_back((inverted_ ? n - 1 - step : step) + 1);
    std::sort(numbers.begin(), numbers.end());
    std::string text = numbers.size() == 1 ? "joint " : "joints ";
    for (size_t i = 0; i < numbers.size(); ++i) {
      text += (i == 0 ? "" : ", ") + std::to_string(numbers[i]);
    }
    return text;
  };
  std::string text;
  for (int i = 0; i < n; ++i) {
    const auto k = static_cast<size_t>(inverted_ ? n - 1 - i : i);
    text += joints_[k].type == JointType::kRevolute ? 'R' : 'P';
  }
  text += ": " + list(0, n - turning) + (n - turning == 1 ? " places" : " place");
  if (turning == 0) return text + " the tool";
  text += " a point, " + list(n - turning, n);
  return text + (turning == 1 ? " turns about it" : ", whose axes meet there, turn about it");
}

std::vector<Screw> screws_of(const ForwardKinematics& forward) {
  const ChainFrames zero = forward.frames(JointVector::Zero(forward.joints()));
  std::vector<Screw> joints;
  for (int i = 0; i < forward.joints(); ++i) {
    const auto k = static_cast<size_t>(i);
    joints.push_back({forward.type(i), zero.axis[k], zero.origin[k]});
  }
  return joints;
}

DecomposedArm::DecomposedArm(ForwardKinematics forward, Decomposition decomposition)
    : forward_(std::move(forward)), decomposition_(std::move(decomposition)) {
  const Pose zero = forward_.pose(JointVector::Zero(forward_.joints()));
  tool_ = zero.translation();
  tool_inverse_ = zero.inverse(Eigen::Isometry);
  const std::vector<Screw> joints = screws_of(forward_);
  // Joints at the end whose axes pass through the tool's point leave it where it is.
  size_t moving = joints.size();
  while (moving > 0 && on_axis(joints[moving - 1], tool_)) --moving;
  if (moving == 0 || moving > 3) return;
  placing_ = PositionProblem::plan(std::span(joints).first(moving), tool_);
  placing_joints_ = static_cast<int>(moving);
  std::mt19937_64 generator(2);
  for (int trial = 0; trial < kTrials && placing_; ++trial) {
    const JointVector q = trial_joints(joints, generator);
    ClosedSolutions found;
    solve(InverseTask(Eigen::Vector3d(forward_.pose(q).translation())), q, found);
    const bool again =
        std::any_of(found.branches.begin(), found.branches.end(), [&](const ClosedBranch& branch) {
          return same_joints(joints, branch.q, q, placing_joints_);
        });
    if (!again) placing_.reset();
  }
}

std::optional<DecomposedArm> DecomposedArm::recognise(const ForwardKinematics& forward) {
  const std::vector<Screw> joints = screws_of(forward);
  const Pose zero = forward.pose(JointVector::Zero(forward.joints()));
  auto decomposition = Decomposition::find(joints, zero.translation());
  if (!decomposition) return std::nullopt;
  return DecomposedArm(forward, *std::move(decomposition));
}

std::string DecomposedArm::family() const { return "closed form, " + decomposition_.describe(); }

bool DecomposedArm::answers(const InverseTask& task) const {
  return !task.position_only || placing_.has_value();
}

void DecomposedArm::solve(const InverseTask& task, const JointVector& held,
                          ClosedSolutions& solutions) const {
  if (!task.position_only) {
    decomposition_.solve(task.goal * tool_inverse_, held, solutions);
    return;
  }
  PositionRoots places;
  placing_->solve(task.goal.translation(), std::span<const double>(held.data(), 3), places);
  // The joints that turn about the point stay where they are, and may have to leave for limits.
  solutions.held = places.held || placing_joints_ < forward_.joints();
  if (places.count == 0) {
    solutions.out_of_reach = places.missing;
    solutions.held = false;
  }
  for (int i = 0; i < places.count; ++i) {
    ClosedBranch& branch = solutions.branches.add();
    branch.q = held;
    for (int k = 0; k < placing_joints_; ++k) {
      branch.q[k] = places.roots[static_cast<size_t>(i)].q[static_cast<size_t>(k)];
    }
  }
}

ArmSides DecomposedArm::sides(const JointVector& q) const {
  ClosedSolutions found;
  decomposition_.solve(forward_.pose(q) * tool_inverse_, q, found);
  ArmSides sides;
  double nearest = 1e300;
  for (const ClosedBranch& branch : found.branches) {
    double apart = 0.0;
    for (int i = 0; i < q.size(); ++i) {
      const bool turns = forward_.type(i) == JointType::kRevolute;
      const double change =
          turns ? std::remainder(branch.q[i] - q[i], 2.0 * kPi) : branch.q[i] - q[i];
      apart = std::max(apart, std::abs(change));
    }
    if (apart >= nearest) continue;
    nearest = apart;
    sides = branch.sides;
  }
  return sides;
}

}  // namespace viapoint
