#include "profile/phase_chain.hpp"

#include <algorithm>
#include <span>

#include "profile/constant_jerk.hpp"

namespace viapoint {
namespace {

/// A place in a chain, from which one goes on or back.
struct Walker {
  const PhaseChain& chain;
  int index;
  AxisState state;
  double left;  ///< of the phase, in the direction of the walk

  [[nodiscard]] double jerk() const noexcept { return link().jerk; }
  [[nodiscard]] const PhaseChain::Link& link() const noexcept {
    return chain.links[static_cast<size_t>(index)];
  }
  void step_on(double seconds) noexcept {
    state = advanced(state, jerk(), seconds);
    left -= seconds;
  }
  void step_back(double seconds) noexcept {
    state = advanced(state, jerk(), -seconds);
    left -= seconds;
    if (left > 0.0) return;
    chain.enter(index, state);
    --index;
    left = index >= 0 ? link().duration : 0.0;
  }
};

AxisMove::Phase blended(double share, double seconds, const Walker& high, const Walker& low,
                        double jerk) noexcept {
  const double rest = 1.0 - share;
  const AxisState &h = high.state, &l = low.state;
  return {
      seconds,
      {share * h.q + rest * l.q, share * h.qd + rest * l.qd, share * h.qdd + rest * l.qdd, jerk}};
}

/// Lets the phases from `first` on follow one another to `target`. What is missing by rounding
/// (two long ways that nearly cancel leave some) goes into the velocity of the longest, where it is
/// rounding as well.
void meet(double target, int first, AxisMove& move) noexcept {
  const std::span<AxisMove::Phase> phases(move.phase.data() + first,
                                          static_cast<size_t>(move.phases - first));
  size_t longest = 1;  // the first begins at the start, to the last bit
  double q = phases[0].from.q;
  for (size_t i = 0; i < phases.size(); ++i) {
    phases[i].from.q = q;
    q = advanced(phases[i].from, phases[i].from.qddd, phases[i].duration).q;
    if (i > longest && phases[i].duration > phases[longest].duration) longest = i;
  }
  phases[longest].from.qd += (target - q) / phases[longest].duration;
  for (size_t i = longest + 1; i < phases.size(); ++i) phases[i].from.q += target - q;
}

}  // namespace

void append(const PhaseChain& chain, AxisMove& move) noexcept {
  if (chain.size == 0) return;
  move.append(chain.links[0].jerk, chain.links[0].duration);  // may prolong the brake's last
  AxisState state = move.end;
  for (int i = 1; i < chain.size; ++i) {
    const PhaseChain::Link& link = chain.links[static_cast<size_t>(i)];
    chain.enter(i, state);
    state.qddd = link.jerk;
    move.phase[static_cast<size_t>(move.phases++)] = {link.duration, state};
    move.total += link.duration;
    state = advanced(state, link.jerk, link.duration);
  }
  move.end = state;
}

void append_blend(double share, const PhaseChain& most, const PhaseChain& least,
                  const AxisState& end, AxisMove& move) noexcept {
  if (most.size == 0 || least.size == 0) return;
  const auto jerk_of = [share](const Walker& high, const Walker& low) {
    return share * high.jerk() + (1.0 - share) * low.jerk();
  };

  // The late half from the end, so that its phases keep their own digits.
  double half = 0.0;
  for (int i = 0; i < most.size; ++i) half += 0.5 * most.links[static_cast<size_t>(i)].duration;
  std::array<AxisMove::Phase, 2 * std::tuple_size_v<decltype(PhaseChain::links)>> late;
  size_t count = 0;
  Walker high_end{most, most.size - 1, end, 0.0}, low_end{least, least.size - 1, end, 0.0};
  high_end.left = high_end.link().duration;
  low_end.left = low_end.link().duration;
  double back = 0.0;
  while (high_end.index >= 0 && low_end.index >= 0) {
    const double step = std::min(high_end.left, low_end.left);
    back += step;
    if (back > half) break;
    const double jerk = jerk_of(high_end, low_end);
    high_end.step_back(step);
    low_end.step_back(step);
    if (step > 0.0) late[count++] = blended(share, step, high_end, low_end, jerk);
  }

  // The early half, up to there.
  const int first = move.phases;
  const auto begin = [&](Walker& walker, const Walker& limit) {
    walker.left = walker.index == limit.index ? limit.left : walker.link().duration;
  };
  Walker high{most, 0, move.end, 0.0}, low{least, 0, move.end, 0.0};
  begin(high, high_end);
  begin(low, low_end);
  const auto enter_next = [&](Walker& walker, const Walker& limit) {
    if (walker.left > 0.0) return true;
    if (++walker.index > limit.index) return false;
    walker.chain.enter(walker.index, walker.state);
    begin(walker, limit);
    return true;
  };
  while (high.index <= high_end.index && low.index <= low_end.index) {
    const double step = std::min(high.left, low.left);
    if (step > 0.0) {
      const auto at = static_cast<size_t>(move.phases++);
      move.phase[at] = blended(share, step, high, low, jerk_of(high, low));
    }
    high.step_on(step);
    low.step_on(step);
    if (!enter_next(high, high_end) || !enter_next(low, low_end)) break;
  }

  while (count > 0) move.phase[static_cast<size_t>(move.phases++)] = late[--count];
  if (move.phases == first) return;
  AxisState& begun = move.phase[static_cast<size_t>(first)].from;  // to the last bit
  begun = {move.end.q, move.end.qd, move.end.qdd, begun.qddd};
  if (move.phases > first + 1) meet(end.q, first, move);
}

}  // namespace viapoint
