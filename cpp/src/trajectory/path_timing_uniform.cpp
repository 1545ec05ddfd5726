#include "trajectory/path_timing_uniform.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "trajectory/path_timing_tool.hpp"
#include "viapoint/core/bernstein_bounds.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/profile/jerk_profile.hpp"

namespace viapoint::path_timing {
namespace {

/// Largest |d^Order q / ds^Order| of one joint along a piece.
template <int Order>
double largest_derivative(const JointPiece& piece, int joint) {
  constexpr int kSize = 6 - Order;
  std::array<double, kSize> c{};
  for (int k = 0; k < kSize; ++k) {
    double factor = 1.0;
    for (int m = 0; m < Order; ++m) factor *= static_cast<double>(k + Order - m);
    c[static_cast<size_t>(k)] = factor * piece.coefficients(k + Order, joint);
  }
  return largest_magnitude(c) / std::pow(piece.length, Order);
}

/// Where a monotone constant-jerk motion reaches `distance`: bisection safeguards Newton.
double time_to_reach(const RateState& from, double jerk, double distance, double duration) {
  double low = 0.0, high = duration, t = 0.5 * duration;
  for (int i = 0; i < 100 && high - low > 1e-16 * duration; ++i) {
    const double s = t * (from.rate + t * (0.5 * from.change + t * jerk / 6.0));
    const double rate = from.rate + t * (from.change + 0.5 * t * jerk);
    (s < distance ? low : high) = t;
    const double newton = rate > 0.0 ? t + (distance - s) / rate : -1.0;
    t = newton > low && newton < high ? newton : 0.5 * (low + high);
  }
  return t;
}

RateState advanced(const RateState& from, double jerk, double t) {
  return {from.s + t * (from.rate + t * (0.5 * from.change + t * jerk / 6.0)),
          from.rate + t * (from.change + 0.5 * t * jerk), from.change + t * jerk};
}

}  // namespace

UniformCeilings uniform_ceilings(const JointPath& path, const JointLimits& limits,
                                 std::span<const ToolRates> tool) {
  const int n = limits.joints();
  // Bounds of |q'|, |q''|, |q'''| in shares: over the limit and over the piece's scale.
  JointVector first_v = JointVector::Zero(n), first_a = first_v, first_j = first_v;
  JointVector second_a = first_v, second_j = first_v, third_j = first_v;
  double rate = std::numeric_limits<double>::infinity(), change = rate, jerk = rate;
  ToolCeilings most;
  for (size_t k = 0; k < path.pieces().size(); ++k) {
    const JointPiece& piece = path.pieces()[k];
    if (!tool.empty() && tool[k].limits.any()) {
      const ToolCeilings here = tool_ceilings(tool[k], piece.length);
      most.velocity = std::max(most.velocity, here.velocity);
      most.acceleration1 = std::max(most.acceleration1, here.acceleration1);
      most.acceleration2 = std::max(most.acceleration2, here.acceleration2);
    }
    for (int i = 0; i < n; ++i) {
      const double d1 = largest_derivative<1>(piece, i) / piece.scale;
      const double d2 = largest_derivative<2>(piece, i) / piece.scale;
      const double d3 = largest_derivative<3>(piece, i) / piece.scale;
      first_v[i] = std::max(first_v[i], d1 / limits.velocity[i]);
      first_a[i] = std::max(first_a[i], d1 / limits.acceleration[i]);
      first_j[i] = std::max(first_j[i], d1 / limits.jerk[i]);
      second_a[i] = std::max(second_a[i], d2 / limits.acceleration[i]);
      second_j[i] = std::max(second_j[i], d2 / limits.jerk[i]);
      third_j[i] = std::max(third_j[i], d3 / limits.jerk[i]);
    }
  }
  if (!(first_v.maxCoeff() > 0.0)) {
    throw MotionError(ErrorCode::kZeroLength, "No joint moves along this section of path.",
                      {"Leave the move out, or give it a goal that differs from its start."});
  }
  // q̈ = q''ṡ² + q's̈ and q⃛ = q'''ṡ³ + 3q''ṡs̈ + q's⃛: the speed may use half of an acceleration and
  // a third of a jerk, the change of speed another third, and its jerk what is left.
  for (int i = 0; i < n; ++i) {
    if (first_v[i] > 0.0) rate = std::min(rate, 1.0 / first_v[i]);
    if (second_a[i] > 0.0) rate = std::min(rate, std::sqrt(0.5 / second_a[i]));
    if (third_j[i] > 0.0) rate = std::min(rate, std::cbrt(1.0 / 3.0 / third_j[i]));
  }
  if (most.velocity > 0.0) rate = std::min(rate, 1.0 / most.velocity);
  if (most.acceleration2 > 0.0) rate = std::min(rate, std::sqrt(0.5 / most.acceleration2));
  if (most.acceleration1 > 0.0) {
    change = std::min(change, (1.0 - most.acceleration2 * rate * rate) / most.acceleration1);
  }
  for (int i = 0; i < n; ++i) {
    if (first_a[i] > 0.0) {
      change = std::min(change, (1.0 - second_a[i] * rate * rate) / first_a[i]);
    }
    if (second_j[i] > 0.0) change = std::min(change, 1.0 / (9.0 * second_j[i] * rate));
  }
  for (int i = 0; i < n; ++i) {
    if (!(first_j[i] > 0.0)) continue;
    const double spent = third_j[i] * rate * rate * rate + 3.0 * second_j[i] * rate * change;
    jerk = std::min(jerk, (1.0 - spent) / first_j[i]);
  }
  return {rate, change, jerk};
}

std::optional<UniformCeilings> straight_ceilings(const JointPath& path, const JointLimits& limits) {
  constexpr double kRounding = 1e-12;
  const JointPiece& first = path.pieces().front();
  const JointVector direction = first.coefficients.row(1).transpose() / first.length;
  const double size = direction.cwiseAbs().maxCoeff();
  for (const JointPiece& piece : path.pieces()) {
    const double bend = piece.coefficients.bottomRows<4>().cwiseAbs().maxCoeff();
    const JointVector turn = piece.coefficients.row(1).transpose() / piece.length - direction;
    if (!(bend <= kRounding * size * piece.length) ||
        !(turn.cwiseAbs().maxCoeff() <= kRounding * size) || piece.scale != first.scale) {
      return std::nullopt;
    }
  }
  if (!(size > 0.0)) return std::nullopt;
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  UniformCeilings ceilings{kInfinite, kInfinite, kInfinite};
  for (int i = 0; i < limits.joints(); ++i) {
    const double rate = std::abs(direction[i]) / first.scale;
    if (rate == 0.0) continue;
    ceilings.rate = std::min(ceilings.rate, limits.velocity[i] / rate);
    ceilings.change = std::min(ceilings.change, limits.acceleration[i] / rate);
    ceilings.jerk = std::min(ceilings.jerk, limits.jerk[i] / rate);
  }
  return ceilings;
}

std::vector<TimedSpan> seven_phases(const JointPath& path, const UniformCeilings& ceilings) {
  const JerkProfile profile =
      rest_to_rest(path.length(), ceilings.rate, ceilings.change, ceilings.jerk);
  // Shorter than this share of its phase, a cut is rounding and not a span of its own.
  constexpr double kSliver = 1e-14;
  // A phase without jerk that lasts less than this share of its neighbours is left out: rounding
  // makes them where two limits meet, time cannot tell where they begin, and nothing changes in
  // them. One with jerk stays, however short: acceleration may change from nothing to all in it.
  constexpr double kShortest = 1e-12;
  std::vector<TimedSpan> spans;
  RateState state;  // s within the piece
  size_t piece = 0;
  const size_t last = path.pieces().size() - 1;
  for (int k = 0; k < profile.phases; ++k) {
    const double jerk = profile.jerk[static_cast<size_t>(k)];
    double left = profile.duration[static_cast<size_t>(k)];
    if (jerk == 0.0) {  // never the first or the last phase
      const auto here = static_cast<size_t>(k);
      const double around = profile.duration[here - 1] + profile.duration[here + 1];
      if (left < kShortest * around) continue;
    }
    const double sliver = kSliver * left;
    while (left > sliver) {
      const double length = path.pieces()[piece].length;
      const bool crosses = piece < last && advanced(state, jerk, left).s >= length;
      double step = crosses ? time_to_reach(state, jerk, length - state.s, left) : left;
      if (left - step <= sliver) step = left;
      RateState end = advanced(state, jerk, step);
      if (crosses || (piece == last && k + 1 == profile.phases)) end.s = length;
      if (step > sliver) {
        spans.push_back(TimedSpan::constant_jerk(piece, length, state, jerk, end.s, step));
      }
      left -= step;
      state = end;
      if (crosses) {
        state.s = 0.0;
        ++piece;
      }
    }
  }
  return spans;
}

}  // namespace viapoint::path_timing
