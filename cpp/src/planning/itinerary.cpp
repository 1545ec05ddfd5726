#include "planning/itinerary.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "planning/leg_builder.hpp"
#include "planning/leg_merger.hpp"
#include "planning/speed_keeping.hpp"
#include "planning/tool_changes.hpp"
#include "planning/ways_out.hpp"
#include "viapoint/core/number_text.hpp"
#include "viapoint/core/units.hpp"
#include "viapoint/trajectory/trajectory.hpp"

namespace viapoint::planning {
namespace {

/// Speeds [m/s, rad/s], accelerations [m/s², rad/s²] and scale: below this a move takes for ever,
/// above nothing is limited.
constexpr double kLeastWish = 1e-6;
constexpr double kMostWish = 1e9;

}  // namespace

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
    if (!(wait.seconds >= 0.0 && wait.seconds <= Trajectory::kMostDuration)) {
      add(ErrorCode::kBadArgument,
          "a wait of " + number_text(wait.seconds) + " s; allowed are 0 to " +
              number_text(Trajectory::kMostDuration) + " s",
          {"give the wait in seconds, or leave it out"});
      return;
    }
    if (wait.seconds >= kShortestWait) outputs_here_ = 0;
    merger_.flush();
    itinerary_.items.emplace_back(Dwell{step_, wait.seconds});
  }

  void operator()(const WaitInput& wait) {
    if (wait.index < 0 || wait.index >= kDigitalInputs) {
      add(ErrorCode::kBadArgument, "digital input " + std::to_string(wait.index) +
                                       "; inputs are 0 to " + std::to_string(kDigitalInputs - 1));
      return;
    }
    InputWait awaited{static_cast<std::int16_t>(wait.index), wait.value};
    if (wait.timeout) {
      awaited.timeout = *wait.timeout;
      if (!(awaited.timeout > 0.0) || !std::isfinite(awaited.timeout)) {
        add(ErrorCode::kBadArgument,
            "a time-out of " + number_text(awaited.timeout) + " s; it must be above 0 and finite",
            {"leave the time-out out to wait for ever"});
        return;
      }
    }
    outputs_here_ = 0;
    merger_.flush();
    itinerary_.items.emplace_back(Dwell{step_, kRestAtInput, awaited});
  }

  void operator()(const SetOutput& output) {
    if (output.index < 0 || output.index >= kDigitalOutputs) {
      add(ErrorCode::kBadArgument, "digital output " + std::to_string(output.index) +
                                       "; outputs are 0 to " + std::to_string(kDigitalOutputs - 1));
      return;
    }
    if (!(std::abs(output.time) <= kMostOutputTime)) {
      add(ErrorCode::kBadArgument,
          "an output " + number_text(output.time) + " s from its point; allowed are " +
              number_text(kMostOutputTime) + " s before or after it",
          {"put the output at a nearer point, or a wait before it"});
      return;
    }
    if (!std::isfinite(output.distance)) {
      add(ErrorCode::kBadArgument, "the distance of an output from its point is not finite");
      return;
    }
    if (output.distance != 0.0 && !robot_->has_kinematics()) {
      add(ErrorCode::kBadArgument,
          robot_->name() + " has no kinematics, so a distance at the tool means nothing to it",
          {"tell the output a time instead"});
      return;
    }
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
    const double finest = std::min(tolerance_.position, tolerance_.angle);
    if (!(finest >= kFinestTolerance) || !std::isfinite(tolerance_.position + tolerance_.angle)) {
      char text[160];
      std::snprintf(
          text, sizeof text,
          "tolerance of lines and curves: %g m and %g rad; each must be at least %g and finite",
          tolerance_.position, tolerance_.angle, kFinestTolerance);
      add(ErrorCode::kBadArgument, text);
      return false;
    }
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
    if (!options_are_sound(options)) return;
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

  bool options_are_sound(const MoveOptions& options) {
    const size_t before = itinerary_.report.problems.size();
    const auto within = [&](const std::optional<double>& wish, const char* name, double most) {
      if (!wish || (*wish >= kLeastWish && *wish <= most)) return;
      add(ErrorCode::kBadArgument,
          std::string(name) + " is " + number_text(*wish) + "; it must be at least " +
              number_text(kLeastWish) + " and at most " + number_text(most),
          {std::string("give ") + name + " within that range, or leave it out"});
    };
    within(options.speed, "speed", kMostWish);
    within(options.acceleration, "acceleration", kMostWish);
    within(options.process_speed, "process_speed", kMostWish);
    within(options.angular_speed, "angular_speed", kMostWish);
    within(options.angular_acceleration, "angular_acceleration", kMostWish);
    within(options.scale, "scale", 1.0);
    if (!(options.zone.size >= 0.0) || !std::isfinite(options.zone.size)) {
      add(ErrorCode::kBadArgument,
          "zone is " + number_text(options.zone.size) + "; it must be zero or more and finite",
          {"leave the zone out to stop at the point"});
    }
    if (options.zone.bounds_angle() && !(options.zone.angle > 0.0 && options.zone.angle <= kPi)) {
      add(ErrorCode::kBadArgument,
          "the angle of the zone is " + number_text(options.zone.angle) +
              "; it must be above zero and at most pi",
          {"leave the angle out to bound the position alone"});
    }
    const bool at_tool = options.zone.kind == ZoneKind::kRadius ||
                         options.zone.kind == ZoneKind::kDeviation || options.zone.bounds_angle();
    if (at_tool && !robot_->has_kinematics()) {
      add(ErrorCode::kBadArgument,
          robot_->name() + " has no kinematics, so a zone at the tool means nothing to it",
          {"zone=joint_deviation(rad)"});
    }
    return itinerary_.report.problems.size() == before;
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
