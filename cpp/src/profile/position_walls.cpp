#include "profile/position_walls.hpp"

#include <algorithm>
#include <cmath>

#include "profile/constant_jerk.hpp"

namespace viapoint {
namespace {

/// Calls `visit` with the position at the end of each stretch on which it is monotone: at the end
/// of a phase, and where the velocity is zero within it. Stops where `visit` returns false.
template <typename Visit>
bool visit_turns(const AxisMove& move, int first, Visit visit) noexcept {
  const auto phases = static_cast<size_t>(move.phases);
  for (auto i = static_cast<size_t>(first); i < phases; ++i) {
    const auto& [duration, from] = move.phase[i];
    const AxisState& next = i + 1 < phases ? move.phase[i + 1].from : move.end;
    // v(t) = v + a t + j t²/2: its zeros, whichever way they are best known.
    const double under = from.qdd * from.qdd - 2.0 * from.qddd * from.qd;
    const double half = -(from.qdd + std::copysign(std::sqrt(std::max(under, 0.0)), from.qdd));
    double early = from.qddd != 0.0 ? half / from.qddd : -1.0;
    double late = half != 0.0 ? 2.0 * from.qd / half : -1.0;
    if (early > late) std::swap(early, late);
    for (const double t : {early, late}) {
      const bool turns = under > 0.0 && t > 0.0 && t < duration;
      if (turns && !visit(advanced(from, from.qddd, t).q)) return false;
    }
    if (!visit(next.q)) return false;
  }
  return true;
}

}  // namespace

AxisMove::Extent AxisMove::extent() const noexcept VIAPOINT_NONBLOCKING {
  const double start = phases > 0 ? phase[0].from.q : end.q;
  Extent extent{start, start};
  visit_turns(*this, 0, [&](double turn) {
    extent = {std::min(extent.low, turn), std::max(extent.high, turn)};
    return true;
  });
  return extent;
}

bool Walls::hold(const AxisMove& move, int first) const noexcept {
  const double q = first < move.phases ? move.phase[static_cast<size_t>(first)].from.q : move.end.q;
  bool outside = q > high + slack || q < low - slack;
  return visit_turns(move, first, [&](double turn) {
    if (turn <= high + slack && turn >= low - slack) {
      outside = false;
      return true;
    }
    return outside && turn <= start_high + slack && turn >= start_low - slack;
  });
}

Walls mirrored(const Walls& walls) noexcept {
  return {-walls.high, -walls.low, walls.slack, -walls.start_high, -walls.start_low};
}

}  // namespace viapoint
