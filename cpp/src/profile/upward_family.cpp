#include "profile/upward_family.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace viapoint {
namespace {

/// Share of the velocities at hand within which two of them are the same but for rounding.
constexpr double kRounding = 1e-14;
/// Newton's steps converge long before; bisection alone would need as many.
constexpr int kMostSteps = 100;
constexpr double kConverged = 4e-16;
/// As above, where a step costs square roots and the start is nearly the root.
constexpr double kPolished = 1e-15;
constexpr int kPolishingSteps = 3;

double square(double x) { return x * x; }

double snapped(double x, double slack) { return std::abs(x) <= slack ? 0.0 : x; }

/// Roots of c2 x² + c1 x + c0 in ascending order; false where there is none.
bool roots(double c2, double c1, double c0, std::array<double, 2>& x) {
  const double under = c1 * c1 - 4.0 * c2 * c0;
  if (!(under > 0.0) || c2 == 0.0) return false;
  const double q = -0.5 * (c1 + std::copysign(std::sqrt(under), c1));
  if (q == 0.0) return false;
  x = {q / c2, c0 / q};
  if (x[0] > x[1]) std::swap(x[0], x[1]);
  return true;
}

}  // namespace

UpwardFamily::UpwardFamily(double v0, double a0, double v1, double a1,
                           const UpwardLimits& limits) noexcept {
  per_up_ = 1.0 / limits.jerk_up;
  per_down_ = 1.0 / limits.jerk_down;
  half_ = 0.5 * (per_up_ + per_down_);
  cubic_ = half_ * (per_up_ + 2.0 * per_down_) / 3.0;
  outer_ = {v0 - 0.5 * a0 * a0 * per_up_, a0, limits.rise, v0};
  inner_ = {v1 - 0.5 * a1 * a1 * per_up_, -a1, limits.fall, v1};
  time_offset_ = (a1 - a0) * per_up_;
  gain_offset_ = 0.0;
  for (const Side& side : {outer_, inner_}) {
    const double lead = side.lead * per_up_;
    gain_offset_ -= lead * (side.v + square(side.lead) * per_up_ / 6.0);
  }

  // What the velocity changes beyond the way at full jerk up, and beyond that at full jerk down.
  // Mirrored, they change places and signs to the last bit, so that a family and its mirror image
  // take the same decisions.
  const double slack = kRounding * (std::abs(v0) + std::abs(v1) + half_ * (a0 * a0 + a1 * a1));
  const double bend = 0.5 * (a1 - a0) * (a1 + a0);
  const double beyond_up = snapped(v1 - v0 - bend * per_up_, slack);
  const double beyond_down = snapped(v1 - v0 + bend * per_down_, slack);
  if (beyond_up == 0.0) {
    // Alike: the inner is the one that can be monotone, or else needs less.
    first_is_outer_ = a1 > 0.0 || (a0 > 0.0 && a0 >= -a1);
  } else {
    first_is_outer_ = beyond_up > 0.0;
  }
  if (!first_is_outer_) std::swap(outer_, inner_);
  k_ = std::abs(beyond_up) / half_;

  // The lowest top, counted from inner_.v: the higher of what the two sides need.
  const double inner_least = square(std::max(inner_.lead, 0.0));
  double outer_least = -k_;
  if (outer_.lead > 0.0) {
    const double more = (outer_.lead - inner_.lead) * (outer_.lead + inner_.lead);
    const bool is_falling = beyond_down == 0.0 && more >= 0.0;
    if (is_falling) k_ = more;
    outer_least = is_falling ? square(inner_.lead) : square(outer_.lead) - k_;
  }
  crest_start_ = {};
  if (outer_least > inner_least) {
    crest_start_.outer = outer_.lead;
    crest_start_.inner = std::sqrt(outer_least);
  } else {
    crest_start_.inner = std::max(inner_.lead, 0.0);
    crest_start_.outer = std::sqrt(k_ + inner_least);
  }
  crest_start_.sum = crest_start_.outer + crest_start_.inner;
  lowest_ = half_ * std::max(outer_least, inner_least);
  highest_ = std::max(limits.velocity - inner_.v, lowest_);
  top_ = limits.velocity;
  settle(crest_start_);

  has_monotone_ = inner_.lead < 0.0 && square(inner_.lead) >= outer_least;
  has_gap_ = has_monotone_ && outer_least > 0.0;
  monotone_end_ = has_gap_ ? std::max(inner_.lead, -std::sqrt(outer_least)) : 0.0;
  gap_begin_ = has_gap_ ? of_inner(monotone_end_).duration : 0.0;
}

/// Holds, duration and gain of a member whose peaks without holds are given; a side above its cap
/// is cut to it, and holds it until the same top is reached. Phase by phase: the closed form above
/// would take large terms from one another where one jerk is much smaller than the other.
void UpwardFamily::settle(UpwardMember& m) const noexcept {
  m.duration = m.gain = 0.0;
  bool is_cut = false;
  // From the given state to the end of the hold, for the inner side backwards.
  const auto add = [&](const Side& side, double& peak, double& hold) {
    hold = 0.0;
    if (peak < side.lead) {
      peak = side.lead;
      is_cut = true;
    }
    if (peak > side.cap) {
      hold = half_ * (peak - side.cap) * (peak + side.cap) / side.cap;
      peak = side.cap;
      is_cut = true;
    }
    const double t = (peak - side.lead) * per_up_;
    const double velocity = side.given + 0.5 * t * (side.lead + peak);
    m.duration += t + hold;
    m.gain += t * (side.given + t * (0.5 * side.lead + (peak - side.lead) / 6.0)) +
              hold * (velocity + 0.5 * hold * peak);
    return velocity + hold * peak;
  };
  const double velocity = add(outer_, m.outer, m.outer_hold);
  add(inner_, m.inner, m.inner_hold);
  if (is_cut) m.sum = std::max(m.outer + m.inner, 0.0);
  const double t = m.sum * per_down_;
  m.duration += t;
  m.gain += t * (velocity + t * (0.5 * m.outer - m.sum / 6.0));
}

UpwardMember UpwardFamily::of_inner(double inner) const noexcept {
  UpwardMember m{};
  m.inner = inner;
  m.outer = std::sqrt(k_ + inner * inner);
  // Where they nearly cancel, their sum is better known from K.
  m.sum = inner < 0.0 ? k_ / (m.outer - inner) : m.outer + inner;
  settle(m);
  return m;
}

UpwardMember UpwardFamily::of_sum(double sum) const noexcept {
  UpwardMember m{};
  m.sum = sum;
  const double difference = sum > 0.0 ? k_ / sum : 0.0;
  m.outer = 0.5 * (sum + difference);
  m.inner = 0.5 * (sum - difference);
  settle(m);
  return m;
}

UpwardMember UpwardFamily::of_excess(double excess) const noexcept {
  const double squared = std::max(0.0, excess) / half_;
  UpwardMember m{};
  m.inner = std::sqrt(squared);
  m.outer = std::sqrt(k_ + squared);
  m.sum = m.outer + m.inner;
  settle(m);
  return m;
}

UpwardMember UpwardFamily::lasting(double duration) const noexcept {
  // A gap's ends come from two families that differ by rounding: what is nearer counts.
  const double border =
      has_gap_ ? 0.5 * (gap_begin_ + crest_start_.duration) : crest_start_.duration;
  const bool crested = duration >= border;
  if (crested) {
    UpwardMember m = of_excess(highest_);
    if (duration >= m.duration) {
      m.cruise = duration - m.duration;
      m.gain += m.cruise * top_;
      m.duration = duration;
      return m;
    }
  }
  const double share = std::max(duration - time_offset_, 0.0) / half_;
  const double sum = 0.5 * share;
  const double difference = sum > 0.0 ? k_ / sum : 0.0;
  const double outer = 0.5 * (sum + difference), inner = 0.5 * (sum - difference);
  if (outer <= outer_.cap && inner <= inner_.cap) return of_sum(sum);
  if (!crested || square(outer_.cap) - k_ <= square(inner_.cap)) {
    // The outer side holds first: x² + 2 cap x + K + cap² − cap·time/H = 0 for the inner peak.
    const double peak = std::sqrt(std::max(0.0, outer_.cap * share - k_)) - outer_.cap;
    if (!crested || peak <= inner_.cap) return of_inner(peak);
  } else {
    // The inner side holds: the same with K negative, for what the outer peak has over √K.
    const double root = std::sqrt(k_);
    const double b = inner_.cap + root;
    const double rest = inner_.cap * (share - 2.0 * root - inner_.cap);
    const double over = rest / (b + std::sqrt(std::max(0.0, b * b + rest)));
    if (root + over <= outer_.cap) return of_excess(half_ * over * (over + 2.0 * root));
  }
  // Both hold: the time is linear in the top velocity.
  const double excess = half_ * (share - outer_.cap - inner_.cap - k_ / outer_.cap) /
                        (1.0 / outer_.cap + 1.0 / inner_.cap);
  return of_excess(excess);
}

bool UpwardFamily::reach(double gain, const UpwardMember& from,
                         UpwardMember& found) const noexcept {
  if (has_monotone_ && from.inner < monotone_end_) {
    if (reach_monotone(gain, from, found)) return true;
    if (has_gap_) return false;
  } else if (has_gap_ && from.inner < 0.0) {
    return false;
  }
  found = reach_from(gain, from.duration > crest_start_.duration ? from : crest_start_);
  return true;
}

bool UpwardFamily::reach_monotone(double gain, const UpwardMember& from,
                                  UpwardMember& found) const noexcept {
  // The gain over the duration is monotone between the zeros of its slope w.
  std::array<double, 6> stops{};
  size_t count = 0;
  std::array<double, 2> zeros{};
  const double cap = outer_.cap;
  const double held_until = cap * cap > k_ ? -std::sqrt(cap * cap - k_) : 0.0;
  const double end = monotone_end_;
  if (from.inner < held_until) {
    const double until = std::min(held_until, end);
    if (roots(half_, 0.5 * cap * per_down_, inner_.v, zeros)) {
      for (const double x : zeros) {
        if (x > from.inner && x < until) stops[count++] = x;
      }
    }
    stops[count++] = until;
  }
  if (held_until < end) {
    const double begin = std::max(from.inner, held_until);
    const double beta = 0.75 * cubic_;
    const double gamma = (half_ * half_ - beta) * k_ * k_;
    if (roots(beta, half_ * (outer_.v + inner_.v), gamma, zeros)) {
      for (const double squared : zeros) {
        if (!(squared > 0.0)) continue;
        const double sum = std::sqrt(squared);
        const double x = 0.5 * (sum - k_ / sum);
        if (x > begin && x < end) stops[count++] = x;
      }
    }
    stops[count++] = end;
  }

  double low = from.inner, low_gain = from.gain;
  for (size_t i = 0; i < count; ++i) {
    double high = stops[i];
    UpwardMember m = of_inner(high);
    if (m.gain < gain) {
      low = high;
      low_gain = m.gain;
      continue;
    }
    double x = low + (high - low) * (gain - low_gain) / (m.gain - low_gain);
    if (!(x >= low && x <= high)) x = 0.5 * (low + high);
    for (int step = 0; step < kMostSteps; ++step) {
      m = of_inner(x);
      const double error = gain - m.gain;
      if (std::abs(error) <= kPolished * std::abs(gain)) break;
      (error > 0.0 ? low : high) = x;
      const double slope = 2.0 * half_ * (1.0 + x / m.outer) *
                           (inner_.v + half_ * x * x + 0.5 * per_down_ * m.outer * x);
      double next = slope > 0.0 ? x + error / slope : low;
      if (!(next > low && next < high)) next = 0.5 * (low + high);
      if (std::abs(next - x) <= kConverged * std::abs(x)) break;
      x = next;
    }
    found = m;
    return true;
  }
  return false;
}

/// Root x in [low, high] of G(x) − G(low) = wanted on the side with zero-acceleration velocity v
/// while the other side holds `cap`: dG/dx = 2H (1 + x/cap) (v + H x² + cap x/2j_down), which rises
/// where it is positive, so that Newton's steps from the right never leave the bracket.
double UpwardFamily::reach_held(double wanted, double v, double cap, double low,
                                double high) const noexcept {
  const double c1 = v;
  const double c2 = 0.5 * (0.5 * cap * per_down_ + v / cap);
  const double c3 = (half_ + 0.5 * per_down_) / 3.0;
  const double c4 = 0.25 * half_ / cap;
  const auto value = [&](double x) { return x * (c1 + x * (c2 + x * (c3 + x * c4))); };
  const double target = wanted / (2.0 * half_) + value(low);
  double x = high;
  for (int step = 0; step < kMostSteps; ++step) {
    const double error = value(x) - target;
    const double slope = c1 + x * (2.0 * c2 + x * (3.0 * c3 + x * 4.0 * c4));
    if (!(error > 0.0) || !(slope > 0.0)) break;
    const double change = error / slope;
    x -= change;
    if (change <= kConverged * x) break;
  }
  return std::clamp(x, low, high);
}

/// Neither side holds: α S + β S³/3 − γ/S = gain − const.
UpwardMember UpwardFamily::reach_free(double gain, const UpwardMember& from,
                                      double high) const noexcept {
  const double low = from.outer + from.inner;
  if (!(high > low)) return from;
  const double alpha = half_ * (outer_.v + inner_.v);
  const double beta = 0.75 * cubic_;
  const double gamma = (half_ * half_ - beta) * k_ * k_;
  const double wanted = gain - gain_offset_;
  // An upper bound of the root: drop what only makes the gain larger.
  const double most = std::max(0.0, wanted + (low > 0.0 ? gamma / low : 0.0));
  double sum = std::cbrt(3.0 * most / beta);
  if (alpha < 0.0) sum += std::sqrt(-3.0 * alpha / beta);
  sum = std::min(sum, high);
  // The gain is convex from `low` on, so that the steps come down from the right.
  for (int step = 0; step < kMostSteps; ++step) {
    if (!(sum > low)) return from;
    const double inverse = 1.0 / sum;
    const double bend = gamma * inverse;
    const double error = sum * (alpha + beta * sum * sum / 3.0) - bend - wanted;
    const double slope = alpha + beta * sum * sum + bend * inverse;
    if (!(error > 0.0) || !(slope > 0.0)) break;
    const double change = error / slope;
    sum -= change;
    if (change <= kConverged * sum) break;
  }
  sum = std::max(sum, low);
  UpwardMember m = of_sum(sum);
  // The closed form has lost digits where its terms are much larger than the gain.
  for (int step = 0; step < kPolishingSteps; ++step) {
    const double error = m.gain - gain;
    if (std::abs(error) <= kPolished * std::abs(gain)) break;
    const double top = inner_.v + half_ * m.inner * m.inner;
    const double slope = 2.0 * half_ * (top + 0.5 * per_down_ * m.outer * m.inner);
    const double next = std::clamp(sum - error / slope, low, high);
    const UpwardMember other = of_sum(next);
    if (!(std::abs(other.gain - gain) < std::abs(error))) break;
    sum = next;
    m = other;
  }
  return m;
}

/// The inner side holds, the outer does not, between the excesses of `low` and `high`.
UpwardMember UpwardFamily::reach_inner_held(double gain, const UpwardMember& low, double low_excess,
                                            double high_excess) const noexcept {
  const double high_peak = std::sqrt(k_ + high_excess / half_);
  const double peak = reach_held(gain - low.gain, outer_.v, inner_.cap, low.outer, high_peak);
  // Where K is large, the outer peak hardly tells one top from another: the rest in the excess.
  double left = low_excess, right = high_excess;
  double excess = std::clamp(half_ * (peak * peak - k_), left, right);
  UpwardMember m = of_excess(excess);
  for (int step = 0; step < kMostSteps; ++step) {
    const double error = gain - m.gain;
    (error > 0.0 ? left : right) = excess;
    const double slope = (1.0 / m.outer + 1.0 / inner_.cap) *
                         (inner_.v + excess + 0.5 * per_down_ * m.outer * inner_.cap);
    double next = slope > 0.0 ? excess + error / slope : left;
    if (!(next >= left && next <= right)) next = 0.5 * (left + right);
    if (std::abs(next - excess) <= kPolished * excess) break;
    excess = next;
    m = of_excess(excess);
  }
  return m;
}

UpwardMember UpwardFamily::reach_from(double gain, const UpwardMember& from) const noexcept {
  const double lowest = std::max(lowest_, from.inner * (half_ * from.inner + from.inner_hold));
  UpwardMember m = of_excess(highest_);
  if (m.gain <= gain) {
    m.cruise = (gain - m.gain) / top_;
    m.duration += m.cruise;
    m.gain = gain;
    return m;
  }
  const double outer_holds = half_ * (square(outer_.cap) - k_);
  const double inner_holds = half_ * square(inner_.cap);
  double high = highest_;
  double high_sum = m.outer + m.inner;
  const double both = std::max({outer_holds, inner_holds, lowest});
  if (both < high) {
    m = of_excess(both);
    if (m.gain <= gain) {
      // d gain / d top = w (1/cap + 1/cap), w = top + cap cap/2j_down: a quadratic.
      const double w = inner_.v + both + 0.5 * per_down_ * outer_.cap * inner_.cap;
      const double rest = 2.0 * (gain - m.gain) / (1.0 / outer_.cap + 1.0 / inner_.cap);
      const double root = std::sqrt(w * w + rest);
      const double raise = w > 0.0 ? rest / (w + root) : root - w;
      return of_excess(std::min(both + raise, highest_));
    }
    high = both;
    high_sum = m.outer + m.inner;
  }
  const double one = std::max(std::min(outer_holds, inner_holds), lowest);
  if (one < high) {
    m = of_excess(one);
    if (m.gain <= gain) {
      if (outer_holds > inner_holds) return reach_inner_held(gain, m, one, high);
      const double high_peak = std::sqrt(high / half_);
      return of_inner(reach_held(gain - m.gain, inner_.v, outer_.cap, m.inner, high_peak));
    }
    high_sum = m.outer + m.inner;
  }
  return reach_free(gain, from, high_sum);
}

}  // namespace viapoint
