/// @file
/// What the path will ask of each joint in the nominal time to come, as ranges.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "viapoint/core/joint_limits.hpp"
#include "viapoint/core/nonblocking.hpp"
#include "viapoint/trajectory/trajectory.hpp"

namespace viapoint {

/// A closed range of a quantity.
struct Range {
  double low = 0.0;
  double high = 0.0;
};

/// The same for two joints at once: as many as every processor has lanes for.
struct PairRange {
  Eigen::Array2d low = {0.0, 0.0};
  Eigen::Array2d high = {0.0, 0.0};

  /// Widens to hold `other` too.
  void include(const PairRange& other) noexcept {
    low = low.min(other.low);
    high = high.max(other.high);
  }
};

/// The same for every joint; of an odd number the last pair's second is 0.
struct JointRanges {
  std::array<PairRange, kMaxJoints / 2> pair;

  [[nodiscard]] double low(int joint) const noexcept { return of(joint).low[joint % 2]; }
  [[nodiscard]] double high(int joint) const noexcept { return of(joint).high[joint % 2]; }
  void set(int joint, const Range& range) noexcept {
    PairRange& both = pair[static_cast<std::size_t>(joint / 2)];
    both.low[joint % 2] = range.low;
    both.high[joint % 2] = range.high;
  }
  /// Widens a joint's range to hold `range` too.
  void include(int joint, const Range& range) noexcept {
    set(joint, {std::min(low(joint), range.low), std::max(high(joint), range.high)});
  }

 private:
  [[nodiscard]] const PairRange& of(int joint) const noexcept {
    return pair[static_cast<std::size_t>(joint / 2)];
  }
};

/// Ranges of dq/dτ, d²q/dτ², d³q/dτ³ of every joint over a stretch of nominal time τ
/// [rad or m per s, s², s³].
struct DerivativeRanges {
  JointRanges first, second, third;
};

/// The same, and the narrower ones of the first two where the stretch begins.
struct PathStretch {
  DerivativeRanges ranges;
  JointRanges first_there, second_there;
};

/// Which way along a motion.
enum class Direction : std::uint8_t { kForward, kBackward };

/// A window of cells, equally wide in nominal time, that slides along a trajectory. Each cell holds
/// the ranges of the derivatives in it; every cell is computed once, a few a cycle, so that a
/// question about the future costs no polynomial at all.
///
/// A cell's ranges are bounds, not samples: in each piece d⁴q/dτ⁴ is bounded term by term from its
/// Taylor expansion about the middle, and from the values at the ends of each half that bounds
/// d³q/dτ³, which bounds d²q/dτ², which bounds dq/dτ (Lipschitz). All are clipped to the joint's
/// limits, which the motion's certificate proves up to its slack, so that no bound takes away room
/// at a limit that is reached. Of a part of a cell that lies within one piece they are narrower:
/// what dq/dτ and d²q/dτ² are at its beginning, and d³q/dτ³ changes from there.
class Lookahead {
 public:
  /// @param cell width of a cell [s of nominal time]. Allocates. @pre limits valid, cell > 0
  Lookahead(const JointLimits& limits, double cell);

  /// Starts anew with `trajectory`, which must outlive its use here. Backward it is the motion that
  /// runs from the end to the beginning: times are those since the end then, and the first and the
  /// third derivative change their sign. Real-time: safe.
  void begin(const Trajectory& trajectory,
             Direction direction = Direction::kForward) noexcept VIAPOINT_NONBLOCKING;
  /// Goes on with a motion of which `shift` [s] and `dropped` pieces at the beginning have been
  /// left out, and that is another from `same_until` [s of the one before] on. What is known of the
  /// rest is kept. @pre the direction is forward. Real-time: safe.
  void lengthen(const Trajectory& trajectory, double same_until, double shift,
                std::size_t dropped) noexcept VIAPOINT_NONBLOCKING;
  /// Forgets what lies before τ [s] and computes at most `cells` new cells, looking at no more than
  /// `pieces` pieces: a cell that has more is gone on with by the next call, and unknown until
  /// then. Returns the number of pieces looked at. Real-time: safe.
  int advance(double tau, int cells, int pieces) noexcept VIAPOINT_NONBLOCKING;
  /// Ranges over [from, to] [s]; false where that is not known yet. After the end of the
  /// trajectory the arm rests. Real-time: safe.
  [[nodiscard]] bool ranges(double from, double to,
                            PathStretch& out) const noexcept VIAPOINT_NONBLOCKING;

  /// First of the places known ahead at which the motion rests, after τ [s], its end among them;
  /// infinity where none is known. There any rate is as good as any other. Real-time: safe.
  [[nodiscard]] double next_rest(double tau) const noexcept VIAPOINT_NONBLOCKING;

  [[nodiscard]] int joints() const noexcept { return joints_; }
  /// Cells that the window holds.
  static constexpr int kCells = 256;

 private:
  /// Of one pair of joints, as PathStretch has them.
  struct PairStretch {
    PairRange first, second, third, first_there, second_there;
  };
  struct Cell {
    DerivativeRanges ranges;
    /// Within one piece; then dq/dτ and d²q/dτ² at the cell's beginning.
    bool is_smooth = false;
    std::array<Eigen::Array2d, kMaxJoints / 2> first, second;

    [[nodiscard]] PairStretch between(std::size_t p, double from, double to) const noexcept;
  };

  [[nodiscard]] std::size_t index_of(std::size_t piece) const noexcept VIAPOINT_NONBLOCKING;
  [[nodiscard]] double start_of(std::size_t piece) const noexcept VIAPOINT_NONBLOCKING;
  [[nodiscard]] std::int64_t cell_of(double tau) const noexcept VIAPOINT_NONBLOCKING;
  void look_from(std::int64_t cell) noexcept VIAPOINT_NONBLOCKING;
  [[nodiscard]] bool is_rest(const Cell& cell) const noexcept VIAPOINT_NONBLOCKING;
  void note_rest(double tau) noexcept VIAPOINT_NONBLOCKING;
  void begin_cell() noexcept VIAPOINT_NONBLOCKING;
  [[nodiscard]] bool end_cell(int& pieces) noexcept VIAPOINT_NONBLOCKING;
  void add_piece(const TrajectoryPiece& piece, double from, double to,
                 Cell& cell) const noexcept VIAPOINT_NONBLOCKING;
  void add_rest(DerivativeRanges& cell) const noexcept VIAPOINT_NONBLOCKING;

  int joints_;
  std::size_t pairs_;
  JointLimits limits_;
  double width_;
  const Trajectory* trajectory_ = nullptr;
  Direction direction_ = Direction::kForward;
  double origin_ = 0.0;      ///< of the trajectory's time on that of the cells [s]
  std::size_t piece_ = 0;    ///< next to look at, counted along the way
  bool begun_ = false;       ///< cell `end_` holds some of its pieces
  std::int64_t first_ = 0;   ///< first cell still held
  std::int64_t end_ = 0;     ///< first cell not computed yet
  std::vector<Cell> cells_;  ///< ring, kCells long

  /// Of more than these within the window the later ones stay unknown.
  static constexpr int kRests = 16;
  std::array<double, kRests> rests_{};  ///< in order; on the time of the cells [s]
  int rest_count_ = 0;
};

}  // namespace viapoint
