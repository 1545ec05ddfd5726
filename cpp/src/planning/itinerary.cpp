#include "planning/itinerary.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "planning/leg_builder.hpp"
#include "planning/ways_out.hpp"

namespace viapoint::planning {
namespace {

constexpr int kOutputs = 64;
/// Speed [m/s], acceleration [m/s²] and scale: below this a move takes for ever, above nothing is
/// limited.
constexpr double kLeastWish = 1e-6;
constexpr double kMostWish = 1e9;

class Walk {
 public:
  Walk(const RobotModel& robot, const MotionProgram& program)
      : robot_(robot), builder_(robot, program.tolerance), program_(program) {}

  Itinerary run() {
    if (!begin()) return std::move(itinerary_);
    for (step_ = 0; step_ < static_cast<int>(program_.steps.size()); ++step_) {
      std::visit(*this, program_.steps[static_cast<size_t>(step_)].what);
    }
    if (itinerary_.items.empty() && itinerary_.report.ok()) {
      Problem problem;
      problem.code = ErrorCode::kEmptyProgram;
      problem.message =
          program_.steps.empty()
              ? "the program does nothing: it has no move, wait or output"
              : "the program does nothing: its moves go nowhere, the arm is there already";
      problem.ways_out = {"add a move, e.g. movej(q)"};
      itinerary_.report.problems.push_back(std::move(problem));
    }
    return std::move(itinerary_);
  }

  void operator()(const PtpMove& move) {
    warn_of_correction(move.target);
    build(move.target, [&] { return builder_.ptp(move, at_); }, nullptr);
  }

  void operator()(const LinMove& move) {
    warn_of_correction(move.target);
    build(move.target, [&] { return builder_.lin(move, at_); }, &move);
  }

  void operator()(const Wait& wait) {
    if (!(wait.seconds >= 0.0) || !std::isfinite(wait.seconds)) {
      add(ErrorCode::kBadArgument,
          "a wait of " + std::to_string(wait.seconds) + " s; it must be zero or more and finite");
      return;
    }
    if (wait.seconds >= kShortestWait) outputs_here_ = 0;
    itinerary_.items.emplace_back(Dwell{step_, wait.seconds});
  }

  void operator()(const SetOutput& output) {
    if (output.index < 0 || output.index >= kOutputs) {
      add(ErrorCode::kBadArgument, "digital output " + std::to_string(output.index) +
                                       "; outputs are 0 to " + std::to_string(kOutputs - 1));
      return;
    }
    if (++outputs_here_ > kMaxOutputsAPiece) {
      add(ErrorCode::kBadArgument,
          "more than " + std::to_string(kMaxOutputsAPiece) + " outputs change at one point",
          {"put a short wait(0.01) between them"});
      return;
    }
    itinerary_.items.emplace_back(
        Output{step_, {static_cast<std::int16_t>(output.index), output.value}});
  }

  void operator()(const TimedMove&) {
    add(ErrorCode::kBadProgram, "a timed motion must be the only step of its program",
        {"make a program of its own for it"});
  }

 private:
  bool begin() {
    if (!program_.robot_fingerprint.empty() && program_.robot_fingerprint != robot_.fingerprint()) {
      add(ErrorCode::kBadProgram,
          "the program was written for robot \"" + program_.robot + "\" (fingerprint " +
              program_.robot_fingerprint + "), this is \"" + robot_.name() + "\" (" +
              robot_.fingerprint() + "): chain, tool or limits differ",
          {"load the robot that the program was written for",
           "write the program anew for this robot"});
      return false;
    }
    const LineTolerance& tolerance = program_.tolerance;
    const double finest = std::min(tolerance.position, tolerance.angle);
    if (!(finest >= kFinestTolerance) || !std::isfinite(tolerance.position + tolerance.angle)) {
      char text[160];
      std::snprintf(
          text, sizeof text,
          "tolerance of straight lines: %g m and %g rad; each must be at least %g and finite",
          tolerance.position, tolerance.angle, kFinestTolerance);
      add(ErrorCode::kBadArgument, text);
      return false;
    }
    try {
      builder_.require_within_limits(program_.start, "the start");
    } catch (const MotionError& error) {
      itinerary_.report.problems.push_back(error.problem());
      return false;
    }
    at_ = program_.start;
    return true;
  }

  /// Builds one leg; where that fails says why, and goes on from the target.
  template <typename Build>
  void build(const Target& target, const Build& build_leg, const LinMove* lin) {
    const MoveOptions& options = program_.steps[static_cast<size_t>(step_)].options;
    if (!options_are_sound(options)) return;
    try {
      if (lost_) {  // where this leg begins is not known: only its end can be looked at
        at_ = builder_.resolve(target, at_);
        lost_ = false;
        return;
      }
      Leg leg = build_leg();
      builder_.apply(leg, options, step_);
      at_ = leg.goal;
      outputs_here_ = 0;
      itinerary_.items.emplace_back(std::move(leg));
    } catch (const MotionError& error) {
      Problem problem = error.problem();
      if (problem.code == ErrorCode::kZeroLength) {
        problem.severity = Severity::kWarning;
        add(std::move(problem));
        return;
      }
      if (lin != nullptr && !lost_) {
        // Only what was tried and works is offered; the follower's general hints stand where
        // nothing does.
        std::vector<std::string> ways = ways_out_of(*lin, at_, builder_);
        if (!ways.empty()) problem.ways_out = std::move(ways);
      }
      add(std::move(problem));
      go_on_from(target);
    }
  }

  void go_on_from(const Target& target) {
    try {
      at_ = builder_.resolve(target, at_);
      lost_ = false;
    } catch (const MotionError&) {
      lost_ = true;  // the target's own problem is in the report already
    }
  }

  bool options_are_sound(const MoveOptions& options) {
    const size_t before = itinerary_.report.problems.size();
    const auto within = [&](const std::optional<double>& wish, const char* name, double most) {
      if (!wish || (*wish >= kLeastWish && *wish <= most)) return;
      char text[128];
      std::snprintf(text, sizeof text, "%s is %g; it must be at least %g and at most %g", name,
                    *wish, kLeastWish, most);
      add(ErrorCode::kBadArgument, text);
    };
    within(options.speed, "speed", kMostWish);
    within(options.acceleration, "acceleration", kMostWish);
    within(options.scale, "scale", 1.0);
    if (!(options.zone.size >= 0.0) || !std::isfinite(options.zone.size)) {
      add(ErrorCode::kBadArgument,
          "zone is " + std::to_string(options.zone.size) + "; it must be zero or more and finite");
    }
    const bool at_tool =
        options.zone.kind == ZoneKind::kRadius || options.zone.kind == ZoneKind::kDeviation;
    if (at_tool && !robot_.has_kinematics()) {
      add(ErrorCode::kBadArgument,
          robot_.name() + " has no kinematics, so a zone at the tool means nothing to it",
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
    locate(problem, program_, step_);
    itinerary_.report.problems.push_back(std::move(problem));
  }
  void add(ErrorCode code, std::string message, std::vector<std::string> ways_out = {}) {
    Problem problem;
    problem.code = code;
    problem.message = std::move(message);
    problem.ways_out = std::move(ways_out);
    add(std::move(problem));
  }

  const RobotModel& robot_;
  LegBuilder builder_;
  const MotionProgram& program_;
  Itinerary itinerary_;
  JointVector at_;     ///< where the arm is, or was to be
  bool lost_ = false;  ///< at_ is not where the step before was to end
  int step_ = 0;
  int outputs_here_ = 0;  ///< changes since the last motion or wait
};

}  // namespace

Itinerary make_itinerary(const RobotModel& robot, const MotionProgram& program) {
  return Walk(robot, program).run();
}

void locate(Problem& problem, const MotionProgram& program, int step) {
  if (step < 0 || step >= static_cast<int>(program.steps.size())) return;
  if (!problem.move) problem.move = step;
  const SourceLine& source = program.steps[static_cast<size_t>(step)].source;
  if (problem.file.empty()) problem.file = source.file;
  if (!problem.line && source.line > 0) problem.line = source.line;
}

}  // namespace viapoint::planning
