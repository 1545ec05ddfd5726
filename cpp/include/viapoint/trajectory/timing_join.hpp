/// @file
/// Leaves one timing of a path for another while the arm moves.
///
/// Let both keep the limits along the same path, with b = ṡ² being b_A in the one and b_B in the
/// other. Far from where either begins or ends they hardly differ: how an arm best takes a corner
/// does not hang on what comes many corners later. There b is led from one to the other,
///     b = (1 − w) b_A + w b_B / κ²,   w from 0 to 1 with w' = 0 at both ends,
/// over some spans, so that q, q̇ and q̈ are continuous; κ >= 1 slows the later timing down as a
/// whole, which keeps its limits. The spans in between are proven like any others.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "viapoint/trajectory/trajectory_piece.hpp"

namespace viapoint {

/// Pieces in time order, each with the number of the piece of path that it lies in. Numbers rise
/// along the path; the same number means the same coefficients of u.
struct NumberedTiming {
  std::vector<TrajectoryPiece> pieces;
  std::vector<std::size_t> number;
};

struct TimingJoin {
  double leave = 0.0;      ///< when the earlier timing is left [s from its beginning]
  NumberedTiming timing;   ///< from there to the end of the later one
  std::size_t bridge = 0;  ///< how many of its first pieces lead over
};

using TimingProof = std::function<bool(std::span<const TrajectoryPiece>, std::size_t number)>;

/// @param earlier, later both within the limits, with a stretch of path in common
/// @param holds whether pieces, all in the piece of path of that number, keep every limit
/// @param not_before when the earlier one may be left [s]
/// @returns nothing where no way over was found that holds
/// Real-time: not. Cost: linear in the pieces of both, and some dozen calls of `holds`.
[[nodiscard]] std::optional<TimingJoin> join_timings(const NumberedTiming& earlier,
                                                     const NumberedTiming& later, double not_before,
                                                     const TimingProof& holds);

}  // namespace viapoint
