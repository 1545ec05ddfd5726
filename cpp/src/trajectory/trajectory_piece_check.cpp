#include "trajectory/trajectory_piece_check.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace viapoint {
namespace {

bool all_finite(const TrajectoryPiece& piece) {
  const auto finite = [](double c) { return std::isfinite(c); };
  return std::ranges::all_of(piece.timing, finite) &&
         std::ranges::all_of(piece.path, [&](const auto& row) {
           return std::all_of(row.begin(), row.begin() + piece.joints, finite);
         });
}

/// The first output of the piece that there is none of.
std::optional<int> unknown_output(const TrajectoryPiece& piece) {
  for (size_t i = 0; i < static_cast<size_t>(piece.outputs); ++i) {
    const int index = piece.output[i].index;
    if (index < 0 || index >= kDigitalOutputs) return index;
  }
  return std::nullopt;
}

bool is_count(int outputs) { return outputs >= 0 && outputs <= kMaxOutputsAPiece; }

bool is_duration(double seconds) { return seconds > 0.0 && std::isfinite(seconds); }

std::string describe_fault(const TrajectoryPiece& piece, int joints) {
  std::ostringstream text;
  if (piece.joints < 1 || piece.joints > kMaxJoints) {
    text << "has " << piece.joints << " joints; allowed are 1 to " << kMaxJoints;
  } else if (piece.joints != joints) {
    text << "has " << piece.joints << " joints; the motion has " << joints;
  } else if (!is_duration(piece.duration)) {
    text << "lasts " << piece.duration << " s; it must be more than 0 and finite";
  } else if (!all_finite(piece)) {
    text << "has a coefficient that is not a finite number";
  } else if (!is_count(piece.outputs)) {
    text << "changes " << piece.outputs << " outputs; allowed are 0 to " << kMaxOutputsAPiece;
  } else if (const std::optional<int> output = unknown_output(piece)) {
    text << "changes output " << *output << "; outputs are 0 to " << kDigitalOutputs - 1;
  }
  return text.str();
}

}  // namespace

std::optional<std::string> find_fault(const TrajectoryPiece& piece, int joints) {
  const bool sound = piece.joints >= 1 && piece.joints <= kMaxJoints && piece.joints == joints &&
                     is_duration(piece.duration) && all_finite(piece) && is_count(piece.outputs) &&
                     !unknown_output(piece);
  if (sound) return std::nullopt;
  return describe_fault(piece, joints);
}

}  // namespace viapoint
