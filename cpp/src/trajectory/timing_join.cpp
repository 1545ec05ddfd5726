#include "viapoint/trajectory/timing_join.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "trajectory/path_timing_newton.hpp"
#include "trajectory/path_timing_places.hpp"
#include "trajectory/path_timing_span.hpp"

namespace viapoint {
namespace {

using path_timing::RateState;

/// Spans that a bridge has, and how many places are tried for each.
constexpr std::array<std::size_t, 4> kSpans{6, 14, 30, 60};
constexpr std::size_t kTries = 3;
/// Timings that differ by more than this have nothing to do with each other.
constexpr double kAlike = 0.2;

/// u, u̇, ü of a piece at a share of its time.
RateState state_at(const TrajectoryPiece& piece, double x) {
  const auto& c = piece.timing;
  const double per_second = 1.0 / piece.duration;
  return {c[0] + x * (c[1] + x * (c[2] + x * (c[3] + x * (c[4] + x * c[5])))),
          per_second * (c[1] + x * (2 * c[2] + x * (3 * c[3] + x * (4 * c[4] + x * 5 * c[5])))),
          per_second * per_second * (2 * c[2] + x * (6 * c[3] + x * (12 * c[4] + x * 20 * c[5])))};
}

/// The share of a piece's time at which it is at u; u never falls with time.
double share_at(const TrajectoryPiece& piece, double u) {
  // Newton's method, kept between what is known to lie before and after by bisection.
  double low = 0.0, high = 1.0, x = 0.5;
  constexpr double kRounding = 0x1p-53;
  constexpr int kMost = 100;
  for (int i = 0; i < kMost && high - low > kRounding; ++i) {
    const RateState state = state_at(piece, x);
    (state.s < u ? low : high) = x;
    const double newton = x + (u - state.s) / (state.rate * piece.duration);
    const double next = newton > low && newton < high ? newton : 0.5 * (low + high);
    if (std::abs(next - x) <= kRounding) return next;
    x = next;
  }
  return x;
}

/// Where the earlier timing passes, asked for in the order of the path.
class Passing {
 public:
  explicit Passing(const NumberedTiming& timing) : timing_(timing) {}

  struct Found {
    RateState state;
    double time = 0.0;
  };
  /// @param of a piece that lies there
  std::optional<Found> at(const TrajectoryPiece& of, std::size_t number, double u) {
    while (index_ < timing_.pieces.size() && !reaches(number, u)) {
      start_ += timing_.pieces[index_++].duration;
    }
    if (index_ == timing_.pieces.size() || timing_.number[index_] != number) return std::nullopt;
    const TrajectoryPiece& piece = timing_.pieces[index_];
    if (u < piece.timing[0] || piece.path != of.path) return std::nullopt;
    const double x = share_at(piece, u);
    RateState state = state_at(piece, x);
    state.s = u;
    return Found{state, start_ + x * piece.duration};
  }

 private:
  [[nodiscard]] bool reaches(std::size_t number, double u) const {
    if (timing_.number[index_] != number) return timing_.number[index_] > number;
    return state_at(timing_.pieces[index_], 1.0).s >= u;
  }

  const NumberedTiming& timing_;
  std::size_t index_ = 0;
  double start_ = 0.0;
};

/// Both timings over one piece of the later one.
struct Cell {
  bool common = false;
  double leave = 0.0;  ///< when the earlier one is at its start [s]
  RateState from, to;  ///< of the earlier one
  double ratio = 0.0;  ///< b_B / b_A at its start
};

class Joiner {
 public:
  Joiner(const NumberedTiming& earlier, const NumberedTiming& later, double not_before,
         const TimingProof& holds)
      : later_(later), holds_(holds) {
    Passing passing(earlier);
    for (std::size_t k = 0; k < later.pieces.size(); ++k) {
      Cell cell;
      const RateState from = state_at(later.pieces[k], 0.0), to = state_at(later.pieces[k], 1.0);
      const auto a = passing.at(later.pieces[k], later.number[k], from.s);
      const auto b = a ? passing.at(later.pieces[k], later.number[k], to.s) : std::nullopt;
      if (a && b && a->time >= not_before && a->state.rate > 0.0 && b->state.rate > 0.0 &&
          from.rate > 0.0 && to.rate > 0.0) {
        cell = {true, a->time, a->state, b->state,
                (from.rate / a->state.rate) * (from.rate / a->state.rate)};
      }
      cells_.push_back(cell);
    }
  }

  std::optional<TimingJoin> run() {
    // First as it is; then slowed down to what the arm does, where the later one is quicker.
    for (const bool slowed : {false, true}) {
      for (const std::size_t spans : kSpans) {
        if (auto join = best_of(spans, slowed)) return join;
      }
    }
    return std::nullopt;
  }

 private:
  struct Candidate {
    std::size_t first = 0;
    double mismatch = 0.0, slowing = 1.0;
  };

  std::optional<TimingJoin> best_of(std::size_t spans, bool slowed) const {
    std::vector<Candidate> candidates;
    for (std::size_t k = 0; k + spans < cells_.size(); ++k) {
      double low = std::numeric_limits<double>::infinity(), high = 0.0;
      for (std::size_t i = k; i < k + spans; ++i) {
        const double ratio = cells_[i].common ? cells_[i].ratio : 0.0;
        low = std::min(low, ratio);
        high = std::max(high, ratio);
      }
      const double factor = slowed ? std::max(1.0, std::sqrt(low * high)) : 1.0;
      if (slowed && factor == 1.0) continue;
      const double mismatch = std::max(std::abs(low / factor - 1.0), std::abs(high / factor - 1.0));
      if (low > 0.0 && mismatch < kAlike) candidates.push_back({k, mismatch, std::sqrt(factor)});
    }
    const std::size_t tries = std::min(kTries, candidates.size());
    const auto better = [](const Candidate& a, const Candidate& b) {
      return a.mismatch < b.mismatch;
    };
    std::partial_sort(candidates.begin(), candidates.begin() + static_cast<std::ptrdiff_t>(tries),
                      candidates.end(), better);
    for (std::size_t i = 0; i < tries; ++i) {
      if (auto join = bridge(candidates[i], spans)) return join;
    }
    return std::nullopt;
  }

  std::optional<TimingJoin> bridge(const Candidate& from, std::size_t spans) const {
    TimingJoin join;
    join.leave = cells_[from.first].leave;
    double whole = 0.0, done = 0.0;
    for (std::size_t i = 0; i < spans; ++i) whole += later_.pieces[from.first + i].duration;
    for (std::size_t i = 0; i < spans; ++i) {
      const std::size_t k = from.first + i;
      const TrajectoryPiece& piece = later_.pieces[k];
      const double next = i + 1 == spans ? whole : done + piece.duration;
      const RateState start =
          between(cells_[k].from, state_at(piece, 0.0), done / whole, whole, from.slowing);
      const RateState end =
          between(cells_[k].to, state_at(piece, 1.0), next / whole, whole, from.slowing);
      const auto led = led_piece(piece, start, end);
      if (!led) return std::nullopt;
      join.timing.pieces.push_back(*led);
      join.timing.number.push_back(later_.number[k]);
      done = next;
    }
    if (!all_hold(join.timing)) return std::nullopt;
    join.bridge = spans;
    for (std::size_t k = from.first + spans; k < later_.pieces.size(); ++k) {
      join.timing.pieces.push_back(later_.pieces[k]);
      join.timing.pieces.back().duration *= from.slowing;
      join.timing.number.push_back(later_.number[k]);
    }
    return join;
  }

  [[nodiscard]] bool all_hold(const NumberedTiming& timing) const {
    const std::span<const TrajectoryPiece> pieces = timing.pieces;
    for (std::size_t begin = 0, end = 0; begin < pieces.size(); begin = end) {
      while (end < pieces.size() && timing.number[end] == timing.number[begin]) ++end;
      if (!holds_(pieces.subspan(begin, end - begin), timing.number[begin])) return false;
    }
    return true;
  }

  /// The state on the way from a to b, w being the smoothstep of `share`, a share of `whole` time
  /// of the later timing: dw/du = ẇ / u̇_B.
  static RateState between(const RateState& a, const RateState& b, double share, double whole,
                           double slowing) {
    const double w = share * share * (3.0 - 2.0 * share);
    const double slope = 6.0 * share * (1.0 - share) / whole / b.rate;
    const double square_a = a.rate * a.rate;
    const double square_b = b.rate * b.rate / (slowing * slowing);
    const double change_b = b.change / (slowing * slowing);
    return {b.s, std::sqrt((1.0 - w) * square_a + w * square_b),
            (1.0 - w) * a.change + w * change_b + 0.5 * slope * (square_b - square_a)};
  }

  /// The piece of path from one state to the other, b being about a cubic in u.
  static std::optional<TrajectoryPiece> led_piece(const TrajectoryPiece& piece,
                                                  const RateState& from, const RateState& to) {
    const double h = to.s - from.s;
    const path_timing::Four x{from.rate * from.rate, 2.0 * h * from.change, to.rate * to.rate,
                              2.0 * h * to.change};
    double time = 0.0;
    for (const path_timing::Quadrature& q : path_timing::kGauss5) {
      time += h * q.weight / std::sqrt(path_timing::dot(q.value, x));
    }
    if (!(time > 0.0) || !std::isfinite(time)) return std::nullopt;
    const auto span = path_timing::TimedSpan::between(0, 1.0, from, to, time);
    if (!goes_forward(span)) return std::nullopt;
    TrajectoryPiece led = piece;
    led.duration = time;
    led.timing = span.u;
    return led;
  }

  const NumberedTiming& later_;
  const TimingProof& holds_;
  std::vector<Cell> cells_;
};

}  // namespace

std::optional<TimingJoin> join_timings(const NumberedTiming& earlier, const NumberedTiming& later,
                                       double not_before, const TimingProof& holds) {
  return Joiner(earlier, later, not_before, holds).run();
}

}  // namespace viapoint
