#include "kinematics/joint_turns.hpp"

#include <algorithm>
#include <cmath>

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
constexpr size_t kMostTurns = 4096;

double distance_to(double value, double low, double high) {
  return std::max({0.0, low - value, value - high});
}

}  // namespace

bool is_nearer(const JointVector& a, const JointVector& b, const JointVector& reference) {
  const double change_a = (a - reference).lpNorm<Eigen::Infinity>();
  const double change_b = (b - reference).lpNorm<Eigen::Infinity>();
  if (change_a != change_b) return change_a < change_b;
  return (a - reference).squaredNorm() < (b - reference).squaredNorm();
}

double wrap_near(double angle, double reference) {
  return reference + std::remainder(angle - reference, kTurn);
}

JointTurns::JointTurns(const ForwardKinematics& forward, const JointLimits& limits)
    : joints_(forward.joints()), limits_(limits) {
  for (int i = 0; i < joints_; ++i) types_.push_back(forward.type(i));
}

bool JointTurns::coupled(const JointVector& q) const {
  if (limits_.couplings() == 0) return true;
  const CouplingVector value = limits_.coupling * q;
  return ((value - limits_.coupling_lower).array() >= -kCouplingSlack).all() &&
         ((limits_.coupling_upper - value).array() >= -kCouplingSlack).all();
}

JointVector JointTurns::unlimited(const JointVector& branch, const JointVector& reference) const {
  JointVector q = branch;
  for (int i = 0; i < joints_; ++i) {
    if (types_[static_cast<size_t>(i)] == JointType::kRevolute) {
      q[i] = wrap_near(branch[i], reference[i]);
    }
  }
  return q;
}

std::optional<JointVector> JointTurns::nearest(const JointVector& branch,
                                               const JointVector& reference) const {
  JointVector q = unlimited(branch, reference);
  for (int i = 0; i < joints_; ++i) {
    const double low = limits_.position_min[i];
    const double high = limits_.position_max[i];
    if (types_[static_cast<size_t>(i)] == JointType::kRevolute) {
      if (q[i] > high + kSnap) q[i] -= kTurn * std::ceil((q[i] - high - kSnap) / kTurn);
      if (q[i] < low - kSnap) q[i] += kTurn * std::ceil((low - kSnap - q[i]) / kTurn);
    }
    if (distance_to(q[i], low, high) > kSnap) return std::nullopt;
    q[i] = std::clamp(q[i], low, high);
  }
  if (coupled(q)) return q;

  // Coupled joints: another turn of some joint may be within the limits.
  std::optional<JointVector> best;
  for (const JointVector& candidate : all(branch)) {
    if (!best || is_nearer(candidate, *best, reference)) best = candidate;
  }
  return best;
}

std::vector<double> JointTurns::values(int joint, double angle) const {
  const double low = limits_.position_min[joint];
  const double high = limits_.position_max[joint];
  std::vector<double> out;
  const bool turns = types_[static_cast<size_t>(joint)] == JointType::kRevolute;
  if (!turns || !std::isfinite(low) || !std::isfinite(high)) {
    double value = turns ? wrap_near(angle, 0.0) : angle;
    if (turns && value > high + kSnap) value -= kTurn * std::ceil((value - high - kSnap) / kTurn);
    if (turns && value < low - kSnap) value += kTurn * std::ceil((low - kSnap - value) / kTurn);
    if (distance_to(value, low, high) <= kSnap) out.push_back(std::clamp(value, low, high));
    return out;
  }
  const double first = angle + kTurn * std::ceil((low - kSnap - angle) / kTurn);
  for (double value = first; value <= high + kSnap && out.size() < kMostTurns; value += kTurn) {
    out.push_back(std::clamp(value, low, high));
  }
  std::sort(out.begin(), out.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  return out;
}

std::vector<JointVector> JointTurns::all(const JointVector& branch) const {
  std::vector<std::vector<double>> options;
  size_t count = 1;
  for (int i = 0; i < joints_; ++i) {
    options.push_back(values(i, branch[i]));
    count *= std::min(options.back().size(), kMostTurns + 1);
    count = std::min(count, kMostTurns + 1);
    if (options.back().empty()) return {};
  }
  while (count > kMostTurns) {
    auto most = std::max_element(options.begin(), options.end(),
                                 [](const auto& a, const auto& b) { return a.size() < b.size(); });
    most->pop_back();
    count = 1;
    for (const auto& list : options) count = std::min(count * list.size(), kMostTurns + 1);
  }

  std::vector<JointVector> out;
  std::vector<size_t> digit(static_cast<size_t>(joints_), 0);
  while (true) {
    JointVector q(joints_);
    for (int i = 0; i < joints_; ++i) {
      const auto k = static_cast<size_t>(i);
      q[i] = options[k][digit[k]];
    }
    if (coupled(q)) out.push_back(q);
    size_t place = 0;
    while (place < digit.size() && ++digit[place] == options[place].size()) digit[place++] = 0;
    if (place == digit.size()) return out;
  }
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
