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

/// The first output of the piece whose time nothing can keep.
std::optional<double> odd_time(const TrajectoryPiece& piece) {
  for (size_t i = 0; i < static_cast<size_t>(piece.outputs); ++i) {
    const double time = piece.output[i].time;
    if (!(std::abs(time) <= kMostOutputTime)) return time;
  }
  return std::nullopt;
}

/// The arm can wait only where it rests, so where no input that fails to come makes it stop.
bool is_wait(const TrajectoryPiece& piece) {
  const InputWait& wait = piece.wait;
  if (!wait.any()) return wait.input == -1;
  const bool rests = std::all_of(piece.path.begin() + 1, piece.path.end(), [&](const auto& row) {
    return std::all_of(row.begin(), row.begin() + piece.joints, [](double c) { return c == 0.0; });
  });
  return wait.input < kDigitalInputs && wait.timeout > 0.0 && rests;
}

bool is_count(int outputs) { return outputs >= 0 && outputs <= kMaxOutputsAPiece; }

/// Below it 1/duration³ may leave the range of numbers, and the derivatives are none.
constexpr double kShortest = 1e-30;

bool is_duration(double seconds) { return seconds >= kShortest && std::isfinite(seconds); }

std::string describe_fault(const TrajectoryPiece& piece, int joints) {
  std::ostringstream text;
  if (piece.joints < 1 || piece.joints > kMaxJoints) {
    text << "has " << piece.joints << " joints; allowed are 1 to " << kMaxJoints;
  } else if (piece.joints != joints) {
    text << "has " << piece.joints << " joints; the motion has " << joints;
  } else if (!is_duration(piece.duration)) {
    text << "lasts " << piece.duration << " s; it must be at least " << kShortest
         << " s and finite";
  } else if (!all_finite(piece)) {
    text << "has a coefficient that is not a finite number";
  } else if (!is_count(piece.outputs)) {
    text << "changes " << piece.outputs << " outputs; allowed are 0 to " << kMaxOutputsAPiece;
  } else if (const std::optional<int> output = unknown_output(piece)) {
    text << "changes output " << *output << "; outputs are 0 to " << kDigitalOutputs - 1;
  } else if (const std::optional<double> time = odd_time(piece)) {
    text << "changes an output " << *time << " s after its beginning; allowed are up to "
         << kMostOutputTime << " s before or after it";
  } else if (!is_wait(piece)) {
    text << "waits for input " << piece.wait.input << " for " << piece.wait.timeout
         << " s; inputs are 0 to " << kDigitalInputs - 1
         << ", a time-out is above 0, and a piece that waits must rest";
  }
  return text.str();
}

}  // namespace

std::optional<std::string> find_fault(const TrajectoryPiece& piece, int joints) {
  const bool sound = piece.joints >= 1 && piece.joints <= kMaxJoints && piece.joints == joints &&
                     is_duration(piece.duration) && all_finite(piece) && is_count(piece.outputs) &&
                     !unknown_output(piece) && !odd_time(piece) && is_wait(piece);
  if (sound) return std::nullopt;
  return describe_fault(piece, joints);
}

}  // namespace viapoint
