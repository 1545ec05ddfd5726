#include "viapoint/realtime/lookahead.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace viapoint {
namespace {

/// Rounding in what a polynomial gives, relative to the limit: far more than it takes, and far
/// below the governor's own slack.
constexpr double kRounding = 1e-10;
/// Shares of the limits below which velocities and accelerations are none, but for rounding.
constexpr double kRest = 1e-9;

/// Range of a quantity that has the values a, b at the ends of `time` and changes no faster than
/// `speed` between them. Where it does so all the way, that is [a, b].
Range between(double a, double b, double speed, double time, double limit) noexcept {
  const double middle = 0.5 * (a + b);
  const double reach = 0.5 * std::max(speed * time, std::abs(b - a)) + kRounding * limit;
  return {std::max(middle - reach, -limit), std::min(middle + reach, limit)};
}

Range mirrored(const Range& range) noexcept { return {-range.high, -range.low}; }

double magnitude(const Range& range) noexcept { return std::max(-range.low, range.high); }

/// Bounds |P^(k)| for k = 0 … 5 of the quintic with coefficients c within `radius` of `centre`: the
/// Taylor series there ends, so its terms' magnitudes are all there is.
std::array<double, 6> derivative_bounds(const std::array<double, 6>& c, double centre,
                                        double radius) noexcept {
  std::array<double, 6> bounds = c;
  for (std::size_t k = 0; k < 5; ++k) {  // Horner's rule, again and again: P^(k)/k! at the centre
    for (std::size_t i = 5; i-- > k;) bounds[i] += centre * bounds[i + 1];
  }
  for (double& term : bounds) term = std::abs(term);
  for (std::size_t k = 0; k < 5; ++k) {  // the same by the radius, with magnitudes
    for (std::size_t i = 5; i-- > k;) bounds[i] += radius * bounds[i + 1];
  }
  constexpr std::array<double, 6> kFactorial = {1, 1, 2, 6, 24, 120};
  for (std::size_t k = 0; k < 6; ++k) bounds[k] *= kFactorial[k];
  return bounds;
}

/// Where u lies, and bounds on its derivatives by τ, within a stretch of a piece.
struct TimingBounds {
  double centre = 0.0, radius = 0.0;
  std::array<double, 5> u{};  ///< [k]: |d^k u/dτ^k|, k >= 1
};

TimingBounds timing_bounds(const TrajectoryPiece& piece, double from, double to) noexcept {
  const double per_second = 1.0 / piece.duration;
  const double x = 0.5 * (from + to) * per_second;
  const double radius = 0.5 * (to - from) * per_second;
  const auto& c = piece.timing;
  TimingBounds bounds;
  const std::array<double, 6> by_x = derivative_bounds(c, x, radius);
  bounds.centre = c[0] + x * (c[1] + x * (c[2] + x * (c[3] + x * (c[4] + x * c[5]))));
  bounds.radius = radius * by_x[1];
  double scale = 1.0;
  for (std::size_t k = 1; k < 5; ++k) bounds.u[k] = by_x[k] * (scale *= per_second);
  return bounds;
}

/// Bounds |d⁴q/dτ⁴| of joint i (Faà di Bruno, fourth order).
double snap_bound(const TrajectoryPiece& piece, const TimingBounds& timing,
                  std::size_t i) noexcept {
  std::array<double, 6> c;
  for (std::size_t k = 0; k < 6; ++k) c[k] = piece.path[k][i];
  const std::array<double, 6> p = derivative_bounds(c, timing.centre, timing.radius);
  const auto& u = timing.u;
  return p[4] * u[1] * u[1] * u[1] * u[1] + 6.0 * p[3] * u[1] * u[1] * u[2] +
         p[2] * (3.0 * u[2] * u[2] + 4.0 * u[1] * u[3]) + p[1] * u[4];
}

}  // namespace

Lookahead::Lookahead(const JointLimits& limits, double cell)
    : joints_(limits.joints()),
      pairs_(static_cast<std::size_t>((joints_ + 1) / 2)),
      limits_(limits),
      width_(cell),
      cells_(kCells) {}

void Lookahead::begin(const Trajectory& trajectory,
                      Direction direction) noexcept VIAPOINT_NONBLOCKING {
  trajectory_ = &trajectory;
  direction_ = direction;
  origin_ = 0.0;
  piece_ = 0;
  begun_ = false;
  first_ = 0;
  end_ = 0;
  rest_count_ = 0;
}

void Lookahead::lengthen(const Trajectory& trajectory, double same_until, double shift,
                         std::size_t dropped) noexcept VIAPOINT_NONBLOCKING {
  const std::int64_t changed = cell_of(same_until);
  trajectory_ = &trajectory;
  origin_ += shift;
  piece_ -= std::min(dropped, piece_);
  // A cell that is being computed may hold some of what is no more.
  if (begun_ || changed < end_) look_from(std::min(end_, changed));
}

std::int64_t Lookahead::cell_of(double tau) const noexcept VIAPOINT_NONBLOCKING {
  return static_cast<std::int64_t>(std::floor((tau + origin_) / width_));
}

void Lookahead::look_from(std::int64_t cell) noexcept VIAPOINT_NONBLOCKING {
  end_ = cell;
  begun_ = false;
  while (rest_count_ > 0 &&
         rests_[static_cast<std::size_t>(rest_count_ - 1)] >= static_cast<double>(cell) * width_)
    --rest_count_;
  const double t = static_cast<double>(cell) * width_ - origin_;
  piece_ = index_of(
      trajectory_->piece_at(direction_ == Direction::kForward ? t : trajectory_->duration() - t));
}

int Lookahead::advance(double tau, int cells, int pieces) noexcept VIAPOINT_NONBLOCKING {
  first_ = std::max(first_, cell_of(tau));
  // Where the motion has overtaken its future, what lies between is given up.
  if (end_ < first_) look_from(first_);
  int left = pieces;
  for (int i = 0; i < cells && end_ < first_ + kCells; ++i) {
    if (!begun_) begin_cell();
    if (!end_cell(left)) break;
  }
  return pieces - left;
}

/// Over [from, to] of the cell's width. With t the range of q''' and q', q'' the values at the
/// cell's beginning, q''(δ) is in q'' + t δ, and q'(δ) in q' + q'' δ + t δ²/2 (Taylor).
[[gnu::always_inline]] inline Lookahead::PairStretch Lookahead::Cell::between(
    std::size_t p, double from, double to) const noexcept {
  PairRange x = ranges.first.pair[p], y = ranges.second.pair[p];
  const PairRange& t = ranges.third.pair[p];
  if (!is_smooth) return {x, y, t, x, y};
  const double time = to - from, bend = 0.5 * from * from;
  const PairRange y_there{y.low.max(second[p] + t.low * from),
                          y.high.min(second[p] + t.high * from)};
  y.low = y.low.max(y_there.low + (t.low * time).min(0.0));
  y.high = y.high.min(y_there.high + (t.high * time).max(0.0));
  const Eigen::Array2d straight = first[p] + second[p] * from;
  const PairRange x_there{x.low.max(straight + t.low * bend), x.high.min(straight + t.high * bend)};
  x.low = x.low.max(x_there.low + (y.low * time).min(0.0));
  x.high = x.high.min(x_there.high + (y.high * time).max(0.0));
  return {x, y, t, x_there, y_there};
}

bool Lookahead::ranges(double from, double to,
                       PathStretch& out) const noexcept VIAPOINT_NONBLOCKING {
  const std::int64_t begin = cell_of(from);
  const std::int64_t last = cell_of(to);
  if (begin < first_ || last >= end_) return false;
  const auto within = [this](std::int64_t cell, double tau) noexcept {
    return std::clamp(tau + origin_ - static_cast<double>(cell) * width_, 0.0, width_);
  };
  DerivativeRanges& all = out.ranges;
  const Cell& start = cells_[static_cast<std::size_t>(begin % kCells)];
  for (std::size_t p = 0; p < pairs_; ++p) {
    const PairStretch pair =
        start.between(p, within(begin, from), begin == last ? within(begin, to) : width_);
    all.first.pair[p] = pair.first;
    all.second.pair[p] = pair.second;
    all.third.pair[p] = pair.third;
    out.first_there.pair[p] = pair.first_there;
    out.second_there.pair[p] = pair.second_there;
  }
  for (std::int64_t c = begin + 1; c < last; ++c) {
    const DerivativeRanges& whole = cells_[static_cast<std::size_t>(c % kCells)].ranges;
    for (std::size_t p = 0; p < pairs_; ++p) {
      all.first.pair[p].include(whole.first.pair[p]);
      all.second.pair[p].include(whole.second.pair[p]);
      all.third.pair[p].include(whole.third.pair[p]);
    }
  }
  if (last == begin) return true;
  const Cell& end = cells_[static_cast<std::size_t>(last % kCells)];
  for (std::size_t p = 0; p < pairs_; ++p) {
    const PairStretch pair = end.between(p, 0.0, within(last, to));
    all.first.pair[p].include(pair.first);
    all.second.pair[p].include(pair.second);
    all.third.pair[p].include(pair.third);
  }
  return true;
}

/// From a piece's index to its place on the way, and back.
std::size_t Lookahead::index_of(std::size_t piece) const noexcept VIAPOINT_NONBLOCKING {
  return direction_ == Direction::kForward ? piece : trajectory_->pieces().size() - 1 - piece;
}

double Lookahead::start_of(std::size_t piece) const noexcept VIAPOINT_NONBLOCKING {
  const std::size_t index = index_of(piece);
  const double start = trajectory_->start_of(index);
  if (direction_ == Direction::kForward) return start;
  return trajectory_->duration() - (start + trajectory_->pieces()[index].duration);
}

void Lookahead::begin_cell() noexcept VIAPOINT_NONBLOCKING {
  Cell& cell = cells_[static_cast<std::size_t>(end_ % kCells)];
  constexpr Range kNowhere{1e300, -1e300};
  cell.is_smooth = false;
  for (JointRanges* ranges : {&cell.ranges.first, &cell.ranges.second, &cell.ranges.third}) {
    for (int j = 0; j < joints_; ++j) ranges->set(j, kNowhere);
  }
  begun_ = true;
}

bool Lookahead::end_cell(int& pieces) noexcept VIAPOINT_NONBLOCKING {
  const double from = static_cast<double>(end_) * width_ - origin_;
  const double to = static_cast<double>(end_ + 1) * width_ - origin_;
  Cell& cell = cells_[static_cast<std::size_t>(end_ % kCells)];
  const auto& all = trajectory_->pieces();
  for (; piece_ < all.size(); ++piece_) {
    if (pieces == 0) return false;
    --pieces;
    const double start = start_of(piece_);
    const TrajectoryPiece& piece = all[index_of(piece_)];
    const double begin = std::clamp(from - start, 0.0, piece.duration);
    const double end = std::clamp(to - start, 0.0, piece.duration);
    cell.is_smooth = from >= start && to <= start + piece.duration;
    if (direction_ == Direction::kForward) {
      add_piece(piece, begin, end, cell);
    } else {
      add_piece(piece, piece.duration - end, piece.duration - begin, cell);
    }
    if (start >= from && is_rest(cell)) note_rest(start);
    if (start + piece.duration > to) break;
  }
  if (piece_ == all.size()) {
    add_rest(cell.ranges);
    note_rest(trajectory_->duration());
  }
  begun_ = false;
  ++end_;
  return true;
}

/// Whether the piece added last begins at rest.
bool Lookahead::is_rest(const Cell& cell) const noexcept VIAPOINT_NONBLOCKING {
  for (int j = 0; j < joints_; ++j) {
    const auto pair = static_cast<std::size_t>(j / 2);
    if (std::abs(cell.first[pair][j % 2]) > kRest * limits_.velocity[j]) return false;
    if (std::abs(cell.second[pair][j % 2]) > kRest * limits_.acceleration[j]) return false;
  }
  return true;
}

void Lookahead::note_rest(double tau) noexcept VIAPOINT_NONBLOCKING {
  const double place = tau + origin_;
  const double passed = static_cast<double>(first_) * width_;
  int kept = 0;
  for (int i = 0; i < rest_count_; ++i) {
    const double rest = rests_[static_cast<std::size_t>(i)];
    if (rest >= passed) rests_[static_cast<std::size_t>(kept++)] = rest;
  }
  rest_count_ = kept;
  if (kept == kRests || (kept > 0 && place <= rests_[static_cast<std::size_t>(kept - 1)])) return;
  rests_[static_cast<std::size_t>(rest_count_++)] = place;
}

double Lookahead::next_rest(double tau) const noexcept VIAPOINT_NONBLOCKING {
  for (int i = 0; i < rest_count_; ++i) {
    const double rest = rests_[static_cast<std::size_t>(i)] - origin_;
    if (rest > tau) return rest;
  }
  return std::numeric_limits<double>::infinity();
}

void Lookahead::add_piece(const TrajectoryPiece& piece, double from, double to,
                          Cell& cell) const noexcept VIAPOINT_NONBLOCKING {
  const double half = 0.5 * (to - from);
  const std::array<JointState, 3> state = {piece.at(from), piece.at(from + half), piece.at(to)};
  const TimingBounds timing = timing_bounds(piece, from, to);
  const bool forward = direction_ == Direction::kForward;
  for (int j = 0; j < joints_; ++j) {
    const auto i = static_cast<std::size_t>(j);
    const double snap = snap_bound(piece, timing, i);
    for (std::size_t s = 0; s < 2; ++s) {
      const JointState &a = state[s], &b = state[s + 1];
      const Range third = between(a.qddd[j], b.qddd[j], snap, half, limits_.jerk[j]);
      const Range second =
          between(a.qdd[j], b.qdd[j], magnitude(third), half, limits_.acceleration[j]);
      const Range first = between(a.qd[j], b.qd[j], magnitude(second), half, limits_.velocity[j]);
      cell.ranges.first.include(j, forward ? first : mirrored(first));
      cell.ranges.second.include(j, second);
      cell.ranges.third.include(j, forward ? third : mirrored(third));
    }
    const JointState& start = forward ? state.front() : state.back();
    cell.first[i / 2][j % 2] = forward ? start.qd[j] : -start.qd[j];
    cell.second[i / 2][j % 2] = start.qdd[j];
  }
}

void Lookahead::add_rest(DerivativeRanges& cell) const noexcept VIAPOINT_NONBLOCKING {
  for (JointRanges* ranges : {&cell.first, &cell.second, &cell.third}) {
    for (int j = 0; j < joints_; ++j) ranges->include(j, Range{});
  }
}

}  // namespace viapoint
