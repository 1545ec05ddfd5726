/// @file
/// Plays the chunks of a stream one after the other, and compares paths whatever their timing.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "planning/path_timer.hpp"
#include "viapoint/planning/stream_planner.hpp"

namespace viapoint::testing_planner {

/// What an arm does that always goes over to the next chunk in time.
struct Played {
  explicit Played(JointLimits of) : limits(std::move(of)) {}

  void add(const MotionChunk& chunk) {
    if (last) {
      const JointState left = last->at(chunk.begin), begun = chunk.motion.at(0.0);
      note(chunk.begin >= 0.0 && chunk.begin <= last->duration(), "left at a time that is none");
      for (int i = 0; i < limits.joints(); ++i) {
        note(std::abs(begun.q[i] - left.q[i]) <= 1e-12, "a step of position");
        note(std::abs(begun.qd[i] - left.qd[i]) <= 1e-9 * limits.velocity[i], "a step of velocity");
        note(std::abs(begun.qdd[i] - left.qdd[i]) <= 1e-8 * limits.acceleration[i],
             "a step of acceleration");
      }
      planning::append_until(pieces, last->pieces(), chunk.begin);
    }
    note(chunk.motion.certificate().holds(), "a chunk that is not proven");
    const JointState end = chunk.motion.at(chunk.motion.duration());
    note(end.qd.cwiseAbs().maxCoeff() <= 1e-9, "a chunk that does not end at rest");
    corners.insert(corners.end(), chunk.corners.begin(), chunk.corners.end());
    warnings += chunk.warnings.size();
    last = chunk.motion;
  }
  void finish() {
    if (last) planning::append_until(pieces, last->pieces(), last->duration());
    last.reset();
  }
  void note(bool good, const char* what) {
    if (!good && problem.empty()) problem = what;
  }

  JointLimits limits;
  std::vector<TrajectoryPiece> pieces;
  std::vector<CornerOutcome> corners;
  size_t warnings = 0;
  int stops = 0;
  std::string problem;  ///< the first thing wrong

 private:
  std::optional<Trajectory> last;
};

inline JointVector place(const TrajectoryPiece& piece, double u) {
  JointVector q(piece.joints);
  for (int i = 0; i < piece.joints; ++i) {
    double sum = 0.0;
    for (size_t k = 6; k-- > 0;) sum = sum * u + piece.path[k][static_cast<size_t>(i)];
    q[i] = sum;
  }
  return q;
}

/// The u of a piece that is nearest to q: by samples, then by Gauss and Newton.
inline double nearest(const TrajectoryPiece& piece, const JointVector& q) {
  const auto distance = [&](double u) { return (place(piece, u) - q).norm(); };
  double best = 0.0;
  constexpr int kSamples = 64;
  for (int k = 1; k <= kSamples; ++k) {
    const double u = static_cast<double>(k) / kSamples;
    if (distance(u) < distance(best)) best = u;
  }
  constexpr double kStep = 1e-4;
  for (int k = 0; k < 40; ++k) {
    const JointVector slope =
        (place(piece, best + kStep) - place(piece, best - kStep)) / (2 * kStep);
    const double square = slope.squaredNorm();
    if (square == 0.0) break;
    best = std::clamp(best + slope.dot(q - place(piece, best)) / square, 0.0, 1.0);
  }
  return best;
}

/// How far places of `pieces` are from those of `whole` [rad or m]; both pass them in this order.
inline double off_path(const std::vector<TrajectoryPiece>& pieces,
                       const std::vector<TrajectoryPiece>& whole) {
  double worst = 0.0;
  size_t at = 0;
  for (const TrajectoryPiece& piece : pieces) {
    // The same coefficients are the same curve; others may be a part of one.
    const auto same = std::find_if(whole.begin() + static_cast<std::ptrdiff_t>(at), whole.end(),
                                   [&](const auto& other) { return other.path == piece.path; });
    if (same != whole.end()) {
      at = static_cast<size_t>(same - whole.begin());
      continue;
    }
    const double end = std::min(1.0, [&] {
      double sum = 0.0;
      for (const double c : piece.timing) sum += c;
      return sum;
    }());
    for (const double share : {0.0, 0.3, 0.7, 1.0}) {
      const JointVector q = place(piece, piece.timing[0] + share * (end - piece.timing[0]));
      // The first piece from here on that passes the place; none does: the nearest.
      double least = 1e300;
      for (size_t k = at; k < whole.size() && k < at + 60; ++k) {
        if (k > at && whole[k].path == whole[k - 1].path) continue;
        const double distance = (place(whole[k], nearest(whole[k], q)) - q).cwiseAbs().maxCoeff();
        if (distance < least) least = distance;
        if (distance <= 1e-12) {
          at = k;
          break;
        }
      }
      worst = std::max(worst, least);
    }
  }
  return worst;
}

/// All changes of outputs, in order.
inline std::vector<std::pair<int, bool>> changes_of(const std::vector<TrajectoryPiece>& pieces) {
  std::vector<std::pair<int, bool>> changes;
  for (const TrajectoryPiece& piece : pieces) {
    for (int k = 0; k < piece.outputs; ++k) {
      const OutputChange& change = piece.output[static_cast<size_t>(k)];
      changes.emplace_back(change.index, change.value);
    }
  }
  return changes;
}

}  // namespace viapoint::testing_planner
