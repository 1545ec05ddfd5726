#include "viapoint/realtime/lookahead.hpp"

#include <algorithm>
#include <cmath>

namespace viapoint {
namespace {

/// A parabola exceeds the hull of three equidistant samples by at most 1/8 of their second
/// difference; twice that is allowed for.
constexpr double kCurvatureMargin = 0.25;
/// And this much of the hull and of the limit for what is no parabola.
constexpr double kHullMargin = 0.02;
constexpr double kLimitMargin = 1e-3;

constexpr Range kNothing{1e300, -1e300};

void include(Range& range, const Range& other) noexcept {
  range.low = std::min(range.low, other.low);
  range.high = std::max(range.high, other.high);
}

/// Bound on a smooth quantity with samples f at the start, in the middle and at the end.
Range bound(double start, double middle, double end, double limit, double limit_margin) noexcept {
  const double low = std::min({start, middle, end});
  const double high = std::max({start, middle, end});
  const double margin = kCurvatureMargin * std::abs(start - 2.0 * middle + end) +
                        kHullMargin * (high - low) + limit_margin * limit;
  return {std::max(low - margin, -limit), std::min(high + margin, limit)};
}

}  // namespace

Lookahead::Lookahead(const JointLimits& limits, double cell)
    : joints_(limits.joints()), limits_(limits), width_(cell), cells_(kCells) {}

void Lookahead::begin(const Trajectory& trajectory) noexcept VIAPOINT_NONBLOCKING {
  trajectory_ = &trajectory;
  piece_ = 0;
  first_ = 0;
  end_ = 0;
}

void Lookahead::advance(double tau, int cells) noexcept VIAPOINT_NONBLOCKING {
  first_ = std::max(first_, static_cast<std::int64_t>(std::floor(tau / width_)));
  for (int i = 0; i < cells && end_ < first_ + kCells; ++i) compute_next_cell();
}

bool Lookahead::ranges(double from, double to,
                       DerivativeRanges& out) const noexcept VIAPOINT_NONBLOCKING {
  const auto begin = static_cast<std::int64_t>(std::floor(from / width_));
  const auto last = static_cast<std::int64_t>(std::floor(to / width_));
  if (begin < first_ || last >= end_) return false;
  out = cells_[static_cast<std::size_t>(begin % kCells)];
  for (std::int64_t c = begin + 1; c <= last; ++c) {
    const DerivativeRanges& cell = cells_[static_cast<std::size_t>(c % kCells)];
    for (std::size_t i = 0; i < static_cast<std::size_t>(joints_); ++i) {
      include(out.first[i], cell.first[i]);
      include(out.second[i], cell.second[i]);
      include(out.third[i], cell.third[i]);
    }
  }
  return true;
}

void Lookahead::compute_next_cell() noexcept VIAPOINT_NONBLOCKING {
  const double from = static_cast<double>(end_) * width_;
  const double to = static_cast<double>(end_ + 1) * width_;
  DerivativeRanges& cell = cells_[static_cast<std::size_t>(end_ % kCells)];
  for (std::size_t i = 0; i < static_cast<std::size_t>(joints_); ++i) {
    cell.first[i] = cell.second[i] = cell.third[i] = kNothing;
  }
  const auto& pieces = trajectory_->pieces();
  for (; piece_ < pieces.size(); ++piece_) {
    const double start = trajectory_->start_of(piece_);
    const TrajectoryPiece& piece = pieces[piece_];
    add_piece(piece, std::clamp(from - start, 0.0, piece.duration),
              std::clamp(to - start, 0.0, piece.duration), cell);
    if (start + piece.duration > to) break;
  }
  if (piece_ == pieces.size()) add_rest(cell);
  ++end_;
}

void Lookahead::add_piece(const TrajectoryPiece& piece, double from, double to,
                          DerivativeRanges& cell) const noexcept VIAPOINT_NONBLOCKING {
  const JointState start = piece.at(from);
  const JointState middle = piece.at(0.5 * (from + to));
  const JointState end = piece.at(to);
  for (int j = 0; j < joints_; ++j) {
    const auto i = static_cast<std::size_t>(j);
    include(cell.first[i], bound(start.qd[j], middle.qd[j], end.qd[j], limits_.velocity[j], 0.0));
    include(cell.second[i],
            bound(start.qdd[j], middle.qdd[j], end.qdd[j], limits_.acceleration[j], 0.0));
    include(cell.third[i],
            bound(start.qddd[j], middle.qddd[j], end.qddd[j], limits_.jerk[j], kLimitMargin));
  }
}

void Lookahead::add_rest(DerivativeRanges& cell) const noexcept VIAPOINT_NONBLOCKING {
  for (std::size_t i = 0; i < static_cast<std::size_t>(joints_); ++i) {
    include(cell.first[i], Range{});
    include(cell.second[i], Range{});
    include(cell.third[i], Range{});
  }
}

}  // namespace viapoint
