#include "viapoint/planning/motion_planner.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "planning/itinerary.hpp"
#include "planning/motion_parts.hpp"
#include "planning/output_places.hpp"
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

/// The outputs of all pieces, and a rest at the end for those that nothing follows and for those
/// that come after it.
void attach_all(std::vector<TrajectoryPiece>& pieces, const std::vector<Output>& outputs,
                const JointVector& end) {
  if (outputs.empty()) return;
  const int last = outputs.back().step;
  const bool is_last = pieces.empty() || pieces.back().move <= last;
  if (is_last) pieces.push_back(planning::rest_at(end, planning::kLastOutputs, last + 1));
  std::vector<ToolLimits> none;
  const auto attached = planning::attach_outputs(pieces, none, outputs, {});
  if (is_last) pieces.back().move = last;
  std::vector<double> starts = {0.0};
  for (const TrajectoryPiece& piece : pieces) starts.push_back(starts.back() + piece.duration);
  double late = 0.0;  // after the end
  for (size_t i = 0; i < outputs.size(); ++i) {
    late = std::max(late, starts[*attached[i]] + outputs[i].change.time - starts.back());
  }
  if (late > 0.0) {
    pieces.push_back(planning::rest_at(end, late, std::max(last, pieces.back().move)));
  }
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
          pieces_.push_back(planning::rest_at(at, *dwell));
      } else {
        outputs_.push_back(std::get<Output>(item));
      }
    }
    flush_legs();
    try {
      attach_all(pieces_, outputs_, at);
    } catch (const MotionError& error) {
      Problem problem = error.problem();
      planning::locate(problem, program_, problem.move.value_or(-1));
      throw MotionError(std::move(problem));
    }
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
    std::optional<CornerOutcome> stop;
    if (!legs_.empty() && legs_.back().options.zone.kind != ZoneKind::kFine) {
      stop = planning::stop_for_tool(legs_.back().step, legs_.back().options.zone);
    }
    flush_legs();
    if (stop) motion_.corners.push_back(std::move(*stop));
    look_at_manipulability();
    arm_ = arm;
  }

  /// Of the pieces since the tool changed last.
  void look_at_manipulability() {
    const auto fresh = std::span(pieces_).subspan(looked_at_);
    if (!fresh.empty()) {
      manipulability_ = std::min(manipulability_, planning::least_manipulability(*arm_, fresh));
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
        tool_.add(*arm_, section.pieces, section.tool, time_so_far());
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
      Problem problem = planning::warning_of(corner);
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
    motion_.process_stretches = tool_.take_stretches();
    for (const ProcessStretch& stretch : motion_.process_stretches) {
      Problem problem = planning::warning_of(stretch);
      planning::locate(problem, program_, stretch.move);
      motion_.report.problems.push_back(std::move(problem));
    }
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
