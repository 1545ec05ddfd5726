#include "planning/motion_parts.hpp"

#include <algorithm>
#include <limits>

#include "planning/corner_words.hpp"

namespace viapoint::planning {

TrajectoryPiece rest_at(const JointVector& q, double seconds, int step) {
  TrajectoryPiece piece;
  piece.duration = seconds;
  piece.joints = static_cast<int>(q.size());
  piece.move = step;
  for (int i = 0; i < q.size(); ++i) piece.path[0][static_cast<size_t>(i)] = q[i];
  piece.timing[1] = 1.0;
  return piece;
}

TrajectoryPiece rest_at(const JointVector& q, const Dwell& dwell) {
  TrajectoryPiece piece = rest_at(q, dwell.seconds, dwell.step);
  piece.wait = dwell.wait;
  return piece;
}

Problem warning_of(const CornerOutcome& corner) {
  Problem problem;
  problem.severity = Severity::kWarning;
  problem.code = corner.stopped ? ErrorCode::kZoneIsStop : ErrorCode::kZoneShrunk;
  problem.value = corner.used;
  problem.limit = corner.asked.size;
  problem.message = corner.stopped ? "the zone became a stop: " : "the zone was shrunk: ";
  problem.message += corner.reason;
  problem.ways_out = ways_out_of(corner);
  return problem;
}

CornerOutcome stop_for_tool(int move, const Zone& asked) {
  CornerOutcome stop;
  stop.move = move;
  stop.asked = asked;
  stop.stopped = true;
  stop.reason = "the tool changes at this point";
  return stop;
}

double least_manipulability(const RobotModel& robot, std::span<const TrajectoryPiece> pieces) {
  if (!robot.has_kinematics()) return 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (const TrajectoryPiece& piece : pieces) {
    for (const double share : {0.0, 0.5, 1.0}) {
      least = std::min(least, robot.manipulability(piece.at(share * piece.duration).q));
    }
  }
  return least;
}

}  // namespace viapoint::planning
