#include "kinematics/joint_turns.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "viapoint/core/units.hpp"

namespace viapoint {
namespace {

constexpr double kTurn = 2.0 * kPi;
/// Near a singular pose a joint is known only to the root of rounding, so a joint on its limit may
/// be found this much outside [rad]. The forward kinematics decides whether the limit will do.
constexpr double kSnap = 1e-7;
/// Coupled limits are sums of several roundings.
constexpr double kCouplingSlack = 1e-12;
/// More turns than this of one branch are of use to nobody: the ones with the least turning stay.
constexpr int kMostTurns = 4096;

/// So few turns are taken off without a division's loss; many keep their digits with the remainder.
constexpr double kFewTurns = 4.0;

double distance_to(double value, double low, double high) {
  return std::max({0.0, low - value, value - high});
}

/// Below zero for values below zero: in a form that is gathered over joints without a branch.
std::int64_t negative(double value) { return std::bit_cast<std::int64_t>(value); }

}  // namespace

bool is_nearer(const JointVector& a, const JointVector& b, const JointVector& reference) {
  const double change_a = (a - reference).lpNorm<Eigen::Infinity>();
  const double change_b = (b - reference).lpNorm<Eigen::Infinity>();
  if (change_a != change_b) return change_a < change_b;
  return (a - reference).squaredNorm() < (b - reference).squaredNorm();
}

double wrap_near(double angle, double reference) {
  const double apart = angle - reference;
  if (std::abs(apart) <= kPi) return angle;
  if (std::abs(apart) < kFewTurns * kTurn) return angle - kTurn * std::round(apart / kTurn);
  return reference + std::remainder(apart, kTurn);
}

JointTurns::JointTurns(const ForwardKinematics& forward, const JointLimits& limits)
    : joints_(forward.joints()), limits_(limits) {
  for (int i = 0; i < joints_; ++i) {
    const auto k = static_cast<size_t>(i);
    types_[k] = forward.type(i);
    low_[k] = limits.position_min[i];
    high_[k] = limits.position_max[i];
    lowest_[k] = limits.position_min[i] - kSnap;
    highest_[k] = limits.position_max[i] + kSnap;
    if (types_[k] == JointType::kPrismatic) continue;
    turn_[k] = kTurn;
    per_turn_[k] = 1.0 / kTurn;
  }
}

bool JointTurns::coupled(const JointVector& q) const {
  if (limits_.couplings() == 0) return true;
  const CouplingVector value = limits_.coupling * q;
  return ((value - limits_.coupling_lower).array() >= -kCouplingSlack).all() &&
         ((limits_.coupling_upper - value).array() >= -kCouplingSlack).all();
}

JointVector JointTurns::unlimited(const JointVector& branch, const JointVector& reference) const {
  JointVector q = branch;
  wrap(q, reference);
  return q;
}

void JointTurns::wrap(JointVector& q, const JointVector& reference) const {
  for (int i = 0; i < joints_; ++i) {
    if (types_[static_cast<size_t>(i)] != JointType::kRevolute) continue;
    q[i] = wrap_near(q[i], reference[i]);
  }
}

std::optional<JointVector> JointTurns::nearest(const JointVector& branch,
                                               const JointVector& reference, bool* moved) const {
  std::optional<JointVector> q(branch);
  if (!bring_near(*q, reference, moved)) q.reset();
  return q;
}

bool JointTurns::shift_inside(JointVector& q, bool* moved) const {
  for (int i = 0; i < joints_; ++i) {
    const double low = limits_.position_min[i];
    const double high = limits_.position_max[i];
    if (types_[static_cast<size_t>(i)] == JointType::kRevolute) {
      if (q[i] > high + kSnap) q[i] -= kTurn * std::ceil((q[i] - high - kSnap) / kTurn);
      if (q[i] < low - kSnap) q[i] += kTurn * std::ceil((low - kSnap - q[i]) / kTurn);
    }
    const double outside = distance_to(q[i], low, high);
    if (outside == 0.0) continue;
    if (outside > kSnap) return false;
    q[i] = std::clamp(q[i], low, high);
    if (moved != nullptr) *moved = true;
  }
  return true;
}

template <int Count>
JointTurns::OneTurn JointTurns::try_one_turn(JointVector& q, const JointVector& reference) const {
  constexpr auto kMost = static_cast<size_t>(Count > 0 ? Count : kMaxJoints);
  const auto count = Count > 0 ? kMost : static_cast<size_t>(joints_);
  // Adding and taking off 1.5 · 2⁵² rounds to a whole number, to the even one of two.
  constexpr double kRound = 6755399441055744.0;
  std::array<double, kMost> value;
  std::array<double, kMost> near;
  std::copy_n(q.data(), count, value.begin());
  std::copy_n(reference.data(), count, near.begin());
  std::int64_t refused = 0;
  std::int64_t open = 0;
  for (size_t k = 0; k < count; ++k) {
    const double turn = turn_[k];
    const double turns = ((value[k] - near[k]) * per_turn_[k] + kRound) - kRound;
    const double wrapped = value[k] - turn * turns;
    const double down = wrapped > highest_[k] ? turn : 0.0;
    const double up = wrapped < lowest_[k] ? turn : 0.0;
    const double shifted = wrapped - down + up;
    refused |= negative(highest_[k] - wrapped) & negative(shifted - lowest_[k]);
    refused |= negative(wrapped - lowest_[k]) & negative(highest_[k] - shifted);
    open |= negative(shifted - low_[k]) | negative(high_[k] - shifted);
    open |= negative(kFewTurns - std::abs(turns));
    value[k] = shifted;
  }
  if (refused < 0) return OneTurn::kRefused;
  if (open < 0) return OneTurn::kOpen;
  std::copy_n(value.begin(), count, q.data());
  return OneTurn::kInside;
}

bool JointTurns::bring_near(JointVector& q, const JointVector& reference, bool* moved) const {
  const OneTurn done = joints_ == 6   ? try_one_turn<6>(q, reference)
                       : joints_ == 7 ? try_one_turn<7>(q, reference)
                                      : try_one_turn<0>(q, reference);
  if (done == OneTurn::kRefused) return false;
  if (done == OneTurn::kOpen) {
    wrap(q, reference);
    if (!shift_inside(q, moved)) return false;
  }
  if (coupled(q)) return true;

  // Coupled joints: another turn of some joint may be within the limits.
  if (moved != nullptr) *moved = true;  // any of the turns may have been set on a limit
  const JointVector branch = q;
  bool any = false;
  each(branch, reference, [&](const JointVector& candidate) {
    if (any && !is_nearer(candidate, q, reference)) return;
    q = candidate;
    any = true;
  });
  return any;
}

JointTurns::Range JointTurns::range(int joint, double angle, double reference) const {
  const double low = limits_.position_min[joint];
  const double high = limits_.position_max[joint];
  const bool turns = types_[static_cast<size_t>(joint)] == JointType::kRevolute;
  if (!turns || !std::isfinite(low) || !std::isfinite(high)) {
    double value = turns ? wrap_near(angle, reference) : angle;
    if (turns && value > high + kSnap) value -= kTurn * std::ceil((value - high - kSnap) / kTurn);
    if (turns && value < low - kSnap) value += kTurn * std::ceil((low - kSnap - value) / kTurn);
    return {value, 0, distance_to(value, low, high) <= kSnap ? 1 : 0};
  }
  double first = angle + kTurn * std::ceil((low - kSnap - angle) / kTurn);
  double count = std::floor((high + kSnap - first) / kTurn) + 1.0;
  if (count > kMostTurns) {
    // Those about the reference, counted from there: far out an angle loses digits.
    constexpr int kKept = kMostTurns - 4;
    constexpr double kHalf = 0.5 * kKept * kTurn + kPi;
    return {wrap_near(angle, std::clamp(reference, low + kHalf, high - kHalf)), -kKept / 2, kKept};
  }
  return {first, 0, std::max(0, static_cast<int>(count))};
}

template <typename Visit>
void JointTurns::each(const JointVector& branch, const JointVector& reference,
                      Visit&& visit) const {
  std::array<Range, kMaxJoints> ranges;
  const auto end = ranges.begin() + joints_;
  const auto combinations = [&] {
    double product = 1.0;
    for (auto range = ranges.begin(); range != end; ++range) product *= range->count;
    return product;
  };
  for (int i = 0; i < joints_; ++i) {
    ranges[static_cast<size_t>(i)] = range(i, branch[i], reference[i]);
  }
  if (combinations() == 0.0) return;
  while (combinations() > kMostTurns) {
    const auto most = std::max_element(
        ranges.begin(), end, [](const Range& a, const Range& b) { return a.count < b.count; });
    const double middle = most->base + kTurn * (most->begin + 0.5 * (most->count - 1));
    if (middle < reference[static_cast<int>(most - ranges.begin())]) ++most->begin;
    --most->count;
  }

  std::array<int, kMaxJoints> digit{};
  while (true) {
    JointVector q(joints_);
    for (int i = 0; i < joints_; ++i) {
      const auto k = static_cast<size_t>(i);
      q[i] = std::clamp(ranges[k].base + kTurn * (ranges[k].begin + digit[k]),
                        limits_.position_min[i], limits_.position_max[i]);
    }
    if (coupled(q)) visit(q);
    int place = 0;
    while (place < joints_ &&
           ++digit[static_cast<size_t>(place)] == ranges[static_cast<size_t>(place)].count) {
      digit[static_cast<size_t>(place++)] = 0;
    }
    if (place == joints_) return;
  }
}

std::vector<JointVector> JointTurns::all(const JointVector& branch,
                                         const JointVector& reference) const {
  std::vector<JointVector> out;
  each(branch, reference, [&](const JointVector& q) { out.push_back(q); });
  return out;
}

double JointTurns::least_change(int joint, double angle, double reference) const {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const auto k = static_cast<size_t>(joint);
  const double turn = turn_[k];
  double value = angle - turn * std::nearbyint((angle - reference) * per_turn_[k]);
  if (value > highest_[k]) {
    value -= turn;  // more turns would bring it farther from the reference still
    if (turn == 0.0 || value < lowest_[k]) return kNever;
  } else if (value < lowest_[k]) {
    value += turn;
    if (turn == 0.0 || value > highest_[k]) return kNever;
  }
  return std::abs(value - reference);
}

LimitExcess JointTurns::excess(const JointVector& branch) const {
  LimitExcess worst;
  JointVector q = branch;
  for (int i = 0; i < joints_; ++i) {
    const double low = limits_.position_min[i];
    const double high = limits_.position_max[i];
    if (types_[static_cast<size_t>(i)] == JointType::kRevolute) {
      const double middle = std::isfinite(low) && std::isfinite(high) ? 0.5 * (low + high) : 0.0;
      q[i] = wrap_near(branch[i], middle);
    }
    const double outside = distance_to(q[i], low, high);
    if (outside <= worst.excess) continue;
    worst = {i, -1, q[i], q[i] < low ? low : high, outside};
  }
  if (worst.joint >= 0) return worst;
  const CouplingVector value = limits_.coupling * q;
  for (int row = 0; row < limits_.couplings(); ++row) {
    const double low = limits_.coupling_lower[row];
    const double high = limits_.coupling_upper[row];
    const double outside = distance_to(value[row], low, high);
    if (outside <= worst.excess) continue;
    worst = {-1, row, value[row], value[row] < low ? low : high, outside};
  }
  return worst;
}

}  // namespace viapoint
