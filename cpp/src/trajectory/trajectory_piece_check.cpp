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

}  // namespace

std::optional<std::string> find_fault(const TrajectoryPiece& piece, int joints) {
  std::ostringstream text;
  if (piece.joints < 1 || piece.joints > kMaxJoints) {
    text << "has " << piece.joints << " joints; allowed are 1 to " << kMaxJoints;
  } else if (piece.joints != joints) {
    text << "has " << piece.joints << " joints; the motion has " << joints;
  } else if (!(piece.duration > 0.0) || !std::isfinite(piece.duration)) {
    text << "lasts " << piece.duration << " s; it must be more than 0 and finite";
  } else if (!all_finite(piece)) {
    text << "has a coefficient that is not a finite number";
  } else if (piece.outputs < 0 || piece.outputs > kMaxOutputsAPiece) {
    text << "changes " << piece.outputs << " outputs; allowed are 0 to " << kMaxOutputsAPiece;
  } else {
    return std::nullopt;
  }
  return text.str();
}

}  // namespace viapoint
