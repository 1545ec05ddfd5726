#include "planning/itinerary.hpp"

#include <cstdio>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "planning/leg_builder.hpp"
#include "planning/leg_merger.hpp"
#include "planning/speed_keeping.hpp"
#include "planning/step_flaws.hpp"
#include "planning/tool_changes.hpp"
#include "planning/ways_out.hpp"

namespace viapoint::planning {

class ItineraryWalk::Walk {
 public:
  Walk(RobotPtr robot, const MotionProgram& program)
      : tools_(robot), robot_(std::move(robot)), tolerance_(program.tolerance) {
    builder_.emplace(*robot_, tolerance_);
    begun_ = begin(program);
  }

  void end() { merger_.flush(); }
  void merge_nothing() { merger_.merge_nothing(); }

  [[nodiscard]] bool begun() const { return begun_; }

  void take(const Step& step, int index) {
    given_ = &step;
    step_ = index;
    std::visit(*this, in_base(step, frame_).what);
    given_ = nullptr;
  }

  Itinerary found() { return std::exchange(itinerary_, {}); }

  void operator()(const PtpMove& move) {
    warn_of_correction(move.target);
    if (has_no_process()) {
      build(move.target, [&] { return builder_->ptp(move, at_); }, nullptr);
    }
  }

  void operator()(const LinMove& move) {
    warn_of_correction(move.target);
    build_curve(move, move.target, [this](const LinMove& m) { return builder_->lin(m, at_); });
  }

  void operator()(const CircMove& move) {
    warn_of_correction(move.via);
    warn_of_correction(move.target);
    build_curve(move, move.target, [this](const CircMove& m) { return builder_->circ(m, at_); });
  }

  void operator()(const TurnMove& move) {
    build_curve(move, goal_of(move), [this](const TurnMove& m) { return builder_->turn(m, at_); });
  }

  void operator()(const SplineMove& move) {
    for (const Target& point : move.points) warn_of_correction(point);
    std::optional<Target> goal;
    if (!move.points.empty()) goal = move.points.back();
    const auto leg = [this](const SplineMove& m) { return builder_->spline(m, at_); };
    if (move.space == SplineSpace::kJoint) {
      if (has_no_process()) build(goal, [&] { return leg(move); }, nullptr);
    } else {
      build_curve(move, goal, leg);
    }
  }

  void operator()(const Wait& wait) {
    if (!is_sound(flaw_of(wait))) return;
    if (wait.seconds >= kShortestWait) outputs_here_ = 0;
    merger_.flush();
    itinerary_.items.emplace_back(Dwell{step_, wait.seconds});
  }

  void operator()(const WaitInput& wait) {
    if (!is_sound(flaw_of(wait))) return;
    InputWait awaited{static_cast<std::int16_t>(wait.index), wait.value};
    if (wait.timeout) awaited.timeout = *wait.timeout;
    outputs_here_ = 0;
    merger_.flush();
    itinerary_.items.emplace_back(Dwell{step_, kRestAtInput, awaited});
  }

  void operator()(const SetOutput& output) {
    if (!is_sound(flaw_of(output, *robot_))) return;
    if (output.distance == 0.0 && ++outputs_here_ > kMaxOutputsAPiece) {
      add(ErrorCode::kBadArgument,
          "more than " + std::to_string(kMaxOutputsAPiece) + " outputs change at one point",
          {"put a short wait(0.01) between them"});
      return;
    }
    merger_.flush();
    itinerary_.items.emplace_back(
        Output{step_,
               {static_cast<std::int16_t>(output.index), output.value, output.time},
               output.distance,
               at_,
               leg_,
               robot_});
  }

  void operator()(const SetFrame& step) { frame_ = step.pose_base_frame; }

  void operator()(const SetTool& step) {
    try {
      robot_ = tools_.with(step);
    } catch (const MotionError& error) {
      add(error.problem());
      return;
    }
    builder_.emplace(*robot_, tolerance_);
  }

  void operator()(const TimedMove&) {
    add(ErrorCode::kBadProgram,
        "a timed motion must be the only step of its program, but for its frame and tool",
        {"make a program of its own for it"});
  }

 private:
  bool begin(const MotionProgram& program) {
    if (!program.robot_fingerprint.empty() && program.robot_fingerprint != robot_->fingerprint()) {
      add(ErrorCode::kBadProgram,
          "the program was written for robot \"" + program.robot + "\" (fingerprint " +
              program.robot_fingerprint + "), this is \"" + robot_->name() + "\" (" +
              robot_->fingerprint() + "): chain, tool or limits differ",
          {"load the robot that the program was written for",
           "write the program anew for this robot"});
      return false;
    }
    if (!is_sound(flaw_of(tolerance_))) return false;
    try {
      require_within_limits(*robot_, program.start, "the start");
    } catch (const MotionError& error) {
      itinerary_.report.problems.push_back(error.problem());
      return false;
    }
    at_ = program.start;
    return true;
  }

  /// The end of a turn hangs on its start: nothing where that is not known.
  std::optional<Target> goal_of(const TurnMove& move) const {
    if (lost_) return std::nullopt;
    try {
      return builder_->goal_of(move, at_);
    } catch (const MotionError&) {
      return std::nullopt;  // building the leg says why
    }
  }

  template <typename Move, typename Build>
  void build_curve(const Move& move, const std::optional<Target>& goal, const Build& leg_of) {
    const bool by_wrist = move.orientation == Orientation::kWrist;
    Move other = move;
    other.orientation = by_wrist ? Orientation::kLeast : Orientation::kWrist;
    const OtherWay another{[&] { return leg_of(other); }, by_wrist ? kByAllJoints : kByWrist};
    const std::function<std::vector<std::string>()> ways = [&]() -> std::vector<std::string> {
      if (!goal) return {};
      return ways_out_of(*goal, at_, *builder_, another);
    };
    build(goal, [&] { return leg_of(move); }, ways);
  }

  /// Builds one leg; where that fails says why, and goes on from the goal.
  /// @param ways finds what would work instead; null where nothing is tried
  template <typename Build>
  void build(const std::optional<Target>& goal, const Build& build_leg,
             const std::function<std::vector<std::string>()>& ways) {
    const MoveOptions& options = given_->options;
    std::vector<Problem> flaws = flaws_of(options, *robot_);
    for (Problem& flaw : flaws) add(std::move(flaw));
    if (!flaws.empty()) return;
    try {
      if (lost_) {  // where this leg begins is not known: only its end can be looked at
        if (!goal) return;
        at_ = builder_->resolve(*goal, at_);
        lost_ = false;
        return;
      }
      Leg leg = build_leg();
      builder_->apply(leg, options, step_);
      leg.robot = robot_;
      at_ = leg.goal;
      leg_ = step_;
      outputs_here_ = 0;
      if (std::optional<Problem> problem = speed_not_kept(*robot_, leg)) add(std::move(*problem));
      merger_.add(std::move(leg));
    } catch (const MotionError& error) {
      Problem problem = error.problem();
      if (problem.code == ErrorCode::kZeroLength) {
        problem.severity = Severity::kWarning;
        add(std::move(problem));
        return;
      }
      if (ways && !lost_) {
        // Only what was tried and works is offered; the follower's general hints stand where
        // nothing does, and what is wrong with the curve itself is mended otherwise.
        std::vector<std::string> found;
        if (problem.code != ErrorCode::kDegenerateCurve &&
            problem.code != ErrorCode::kDiscontinuous && problem.code != ErrorCode::kBadArgument) {
          found = ways();
        }
        if (!found.empty()) problem.ways_out = std::move(found);
      }
      add(std::move(problem));
      go_on_from(goal);
    }
  }

  void go_on_from(const std::optional<Target>& goal) {
    lost_ = !goal;
    if (lost_) return;
    try {
      at_ = builder_->resolve(*goal, at_);
    } catch (const MotionError&) {
      lost_ = true;  // the target's own problem is in the report already
    }
  }

  /// A move of the joints has no speed of the tool to hold.
  bool has_no_process() {
    if (!given_->options.process_speed) return true;
    add(ErrorCode::kBadArgument,
        "process_speed is a speed of the tool to be held, and this move is one of the joints",
        {"a move of the tool: movel, movec, or spline(..., space=\"tool\")",
         "leave process_speed out; scale= slows the joints down"});
    return false;
  }

  void warn_of_correction(const Target& target) {
    const auto* pose = std::get_if<PoseTarget>(&target);
    if (pose == nullptr || pose->correction <= 0.0) return;
    char text[160];
    std::snprintf(
        text, sizeof text,
        "the pose was not exactly a rotation: projected on the nearest one, which differs "
        "by %.2g in an element",
        pose->correction);
    Problem problem;
    problem.severity = Severity::kWarning;
    problem.code = ErrorCode::kPoseCorrected;
    problem.message = text;
    problem.value = pose->correction;
    problem.limit = kRotationRounding;
    add(std::move(problem));
  }

  bool is_sound(std::optional<Problem> flaw) {
    if (!flaw) return true;
    add(std::move(*flaw));
    return false;
  }

  void add(Problem problem) {
    if (given_ != nullptr) locate(problem, given_->source, step_);
    itinerary_.report.problems.push_back(std::move(problem));
  }
  void add(ErrorCode code, std::string message, std::vector<std::string> ways_out = {}) {
    Problem problem;
    problem.code = code;
    problem.message = std::move(message);
    problem.ways_out = std::move(ways_out);
    add(std::move(problem));
  }

  ToolChanges tools_;
  RobotPtr robot_;  ///< with the tool of the present step
  std::optional<LegBuilder> builder_;
  Pose frame_ = Pose::Identity();  ///< of the present step
  LineTolerance tolerance_;
  const Step* given_ = nullptr;  ///< the present step
  Itinerary itinerary_;
  LegMerger merger_{tolerance_, [this](Leg leg) { itinerary_.items.emplace_back(std::move(leg)); }};
  bool begun_ = false;
  JointVector at_;     ///< where the arm is, or was to be
  bool lost_ = false;  ///< at_ is not where the step before was to end
  int step_ = 0;
  int leg_ = -1;          ///< step of the last move
  int outputs_here_ = 0;  ///< changes since the last motion or wait
};

ItineraryWalk::ItineraryWalk(RobotPtr robot, const MotionProgram& program)
    : walk_(std::make_unique<Walk>(std::move(robot), program)) {}
ItineraryWalk::~ItineraryWalk() = default;
bool ItineraryWalk::begun() const { return walk_->begun(); }
void ItineraryWalk::take(const Step& step, int index) { walk_->take(step, index); }
void ItineraryWalk::end() { walk_->end(); }
void ItineraryWalk::merge_nothing() { walk_->merge_nothing(); }
Itinerary ItineraryWalk::found() { return walk_->found(); }

Itinerary make_itinerary(RobotPtr robot, const MotionProgram& program) {
  ItineraryWalk walk(std::move(robot), program);
  if (!walk.begun()) return walk.found();
  int step = 0;
  for (const Step& given : program.steps) walk.take(given, step++);
  walk.end();
  Itinerary itinerary = walk.found();
  if (program.steps.empty()) {
    Problem problem;
    problem.code = ErrorCode::kEmptyProgram;
    problem.message = "the program does nothing: it has no move, wait or output";
    problem.ways_out = {"add a move, e.g. movej(q)"};
    itinerary.report.problems.push_back(std::move(problem));
  } else if (itinerary.items.empty() && itinerary.report.ok()) {
    itinerary.items.emplace_back(Dwell{step - 1, kRestInstead});
  }
  return itinerary;
}

void locate(Problem& problem, const SourceLine& source, int step) {
  if (!problem.move) problem.move = step;
  if (problem.file.empty()) problem.file = source.file;
  if (!problem.line && source.line > 0) problem.line = source.line;
}

void locate(Problem& problem, const MotionProgram& program, int step) {
  if (step < 0 || step >= static_cast<int>(program.steps.size())) return;
  locate(problem, program.steps[static_cast<size_t>(step)].source, step);
}

}  // namespace viapoint::planning
