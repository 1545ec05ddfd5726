#include "viapoint/planning/motion_planner.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "planning/itinerary.hpp"
#include "planning/section.hpp"
#include "planning/tool_changes.hpp"
#include "planning/tool_proof.hpp"
#include "viapoint/planning/timed_plan.hpp"

namespace viapoint {
namespace {

using planning::Dwell;
using planning::Item;
using planning::Itinerary;
using planning::Leg;
using planning::Output;
using planning::Section;

/// How long the arm rests after its last move when outputs are still to change [s].
constexpr double kLastOutputs = 0.002;

TrajectoryPiece rest_at(const JointVector& q, double seconds, int step) {
  TrajectoryPiece piece;
  piece.duration = seconds;
  piece.joints = static_cast<int>(q.size());
  piece.move = step;
  for (int i = 0; i < q.size(); ++i) piece.path[0][static_cast<size_t>(i)] = q[i];
  piece.timing[1] = 1.0;
  return piece;
}

/// Puts each change of output on the first piece of a later step: in the middle of the corner
/// where the point is passed, at the end of the stop where the arm rests there.
void attach_outputs(std::vector<TrajectoryPiece>& pieces, const std::vector<Output>& outputs,
                    const JointVector& end) {
  size_t next = 0;
  for (TrajectoryPiece& piece : pieces) {
    while (next < outputs.size() && outputs[next].step < piece.move &&
           piece.outputs < kMaxOutputsAPiece) {
      piece.output[static_cast<size_t>(piece.outputs++)] = outputs[next++].change;
    }
  }
  if (next == outputs.size()) return;
  TrajectoryPiece last = rest_at(end, kLastOutputs, outputs.back().step);
  while (next < outputs.size() && last.outputs < kMaxOutputsAPiece) {
    last.output[static_cast<size_t>(last.outputs++)] = outputs[next++].change;
  }
  pieces.push_back(last);
}

Problem warning_of(const CornerOutcome& corner) {
  Problem problem;
  problem.severity = Severity::kWarning;
  problem.code = corner.stopped ? ErrorCode::kZoneIsStop : ErrorCode::kZoneShrunk;
  problem.value = corner.used;
  problem.limit = corner.asked.size;
  problem.message = corner.stopped ? "the zone became a stop: " : "the zone was shrunk: ";
  problem.message += corner.reason;
  return problem;
}

/// Smallest manipulability at the pieces' ends and middles.
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

class Composer {
 public:
  Composer(RobotPtr robot, const MotionProgram& program, const Itinerary& itinerary)
      : arm_(std::move(robot)), program_(program), itinerary_(itinerary) {}

  PlannedMotion compose() {
    JointVector at = program_.start;
    for (const Item& item : itinerary_.items) {
      if (const auto* leg = std::get_if<Leg>(&item)) {
        if (leg->robot != arm_) change_tool(leg->robot);
        legs_.push_back(*leg);
        at = leg->goal;
      } else if (const auto* dwell = std::get_if<Dwell>(&item)) {
        flush_legs();
        if (dwell->seconds >= planning::kShortestWait)
          pieces_.push_back(rest_at(at, dwell->seconds, dwell->step));
      } else {
        outputs_.push_back(std::get<Output>(item));
      }
    }
    flush_legs();
    attach_outputs(pieces_, outputs_, at);
    return finish();
  }

 private:
  /// A fault of the timing says at least where its stretch of motion begins.
  std::vector<Section> sections() const {
    try {
      return planning::build_sections(*arm_, legs_);
    } catch (const MotionError& error) {
      Problem problem = error.problem();
      planning::locate(problem, program_, legs_.front().step);
      throw MotionError(std::move(problem));
    }
  }

  /// A zone is a promise about one tool point, so the arm rests where the tool changes.
  void change_tool(const RobotPtr& arm) {
    const bool blended = !legs_.empty() && legs_.back().options.zone.kind != ZoneKind::kFine;
    CornerOutcome stop;
    if (blended) {
      stop.move = legs_.back().step;
      stop.asked = legs_.back().options.zone;
      stop.stopped = true;
      stop.reason = "the tool changes at this point";
    }
    flush_legs();
    if (blended) motion_.corners.push_back(std::move(stop));
    look_at_manipulability();
    arm_ = arm;
  }

  /// Of the pieces since the tool changed last.
  void look_at_manipulability() {
    const auto fresh = std::span(pieces_).subspan(looked_at_);
    if (!fresh.empty()) {
      manipulability_ = std::min(manipulability_, least_manipulability(*arm_, fresh));
    }
    looked_at_ = pieces_.size();
  }

  /// When the next piece begins [s].
  double time_so_far() {
    for (; timed_ < pieces_.size(); ++timed_) time_ += pieces_[timed_].duration;
    return time_;
  }

  void flush_legs() {
    if (legs_.empty()) return;
    for (const Section& section : sections()) {
      if (!section.tool.empty()) {
        tool_.add(arm_->forward(), section.pieces, section.tool, time_so_far());
      }
      pieces_.insert(pieces_.end(), section.pieces.begin(), section.pieces.end());
      motion_.corners.insert(motion_.corners.end(), section.corners.begin(), section.corners.end());
    }
    for (const Leg& leg : legs_) {
      position_deviation_ = std::max(position_deviation_, leg.position_deviation);
      angle_deviation_ = std::max(angle_deviation_, leg.angle_deviation);
    }
    legs_.clear();
  }

  PlannedMotion finish() {
    motion_.report = itinerary_.report;
    for (const CornerOutcome& corner : motion_.corners) {
      if (corner.reason.empty()) continue;
      Problem problem = warning_of(corner);
      planning::locate(problem, program_, corner.move);
      motion_.report.problems.push_back(std::move(problem));
    }
    if (pieces_.empty()) {
      Problem problem;
      problem.code = ErrorCode::kEmptyProgram;
      problem.message = "the program does nothing: its only steps are waits of no length";
      motion_.report.problems.push_back(std::move(problem));
      return std::move(motion_);
    }
    look_at_manipulability();
    motion_.trajectory = Trajectory(std::move(pieces_), arm_->limits());
    Certificate& certificate = motion_.trajectory.certificate();
    certificate.tool = tool_.extrema();
    certificate.path_deviation = position_deviation_;
    certificate.angle_deviation = angle_deviation_;
    certificate.manipulability = manipulability_;
    for (const CornerOutcome& corner : motion_.corners) {
      certificate.zone_deviation = std::max(certificate.zone_deviation, corner.cut);
    }
    motion_.tool_spans = tool_.take_spans();
    for (Problem& problem : planning::problems_of(certificate.tool)) {
      certificate.problems.push_back(std::move(problem));
    }
    for (Problem problem : certificate.problems) {
      planning::locate(problem, program_, problem.move.value_or(-1));
      motion_.report.problems.push_back(std::move(problem));
    }
    return std::move(motion_);
  }

  RobotPtr arm_;  ///< with the tool of legs_
  const MotionProgram& program_;
  const Itinerary& itinerary_;
  PlannedMotion motion_;
  std::vector<Leg> legs_;  ///< since the last stop that the program asks for
  std::vector<TrajectoryPiece> pieces_;
  std::vector<Output> outputs_;
  planning::ToolProof tool_;
  double time_ = 0.0;  ///< of the first timed_ pieces [s]
  size_t timed_ = 0;
  double position_deviation_ = 0.0;
  double angle_deviation_ = 0.0;
  double manipulability_ = std::numeric_limits<double>::infinity();
  size_t looked_at_ = 0;  ///< pieces that manipulability_ counts
};

/// Everything but raising: the motion is empty where the report has errors.
PlannedMotion draft(const RobotPtr& robot, const MotionProgram& program) {
  const Itinerary itinerary = planning::make_itinerary(robot, program);
  if (!itinerary.report.ok()) {
    PlannedMotion motion;
    motion.report = itinerary.report;
    return motion;
  }
  return Composer(robot, program, itinerary).compose();
}

}  // namespace

bool Report::ok() const {
  return std::none_of(problems.begin(), problems.end(),
                      [](const Problem& problem) { return problem.severity == Severity::kError; });
}

std::string Report::describe() const {
  if (problems.empty()) return "no problems";
  std::string text;
  for (const Problem& problem : problems) {
    text += problem.severity == Severity::kError ? "error: " : "warning: ";
    text += problem.describe() + "\n";
  }
  text.pop_back();
  return text;
}

MotionPlanner::MotionPlanner(RobotPtr robot) : robot_(std::move(robot)) {}

Report MotionPlanner::check(const MotionProgram& program) const {
  try {
    if (const auto timed = planning::timed_alone(robot_, program)) {
      return plan_timed(*timed->robot, program, timed->move, timed->step).report;
    }
    return draft(robot_, program).report;
  } catch (const MotionError& error) {
    Report report;
    report.problems.push_back(error.problem());
    return report;
  }
}

PlannedMotion MotionPlanner::plan(const MotionProgram& program) const {
  const auto timed = planning::timed_alone(robot_, program);
  PlannedMotion motion =
      timed ? plan_timed(*timed->robot, program, timed->move, timed->step) : draft(robot_, program);
  // A timed motion is for study: broken limits stay in its report, and only a drive refuses them.
  if (timed && !motion.trajectory.pieces().empty()) return motion;
  for (const Problem& problem : motion.report.problems) {
    if (problem.severity == Severity::kError) throw MotionError(problem);
  }
  return motion;
}

}  // namespace viapoint
