#include "planning/step_flaws.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "viapoint/core/number_text.hpp"
#include "viapoint/core/units.hpp"
#include "viapoint/trajectory/trajectory.hpp"
#include "viapoint/trajectory/trajectory_piece.hpp"

namespace viapoint::planning {
namespace {

/// Speeds [m/s, rad/s], accelerations [m/s², rad/s²] and scale: below this a move takes for ever,
/// above nothing is limited.
constexpr double kLeastWish = 1e-6;
constexpr double kMostWish = 1e9;

Problem flaw(std::string message, std::vector<std::string> ways_out = {}) {
  Problem problem;
  problem.code = ErrorCode::kBadArgument;
  problem.message = std::move(message);
  problem.ways_out = std::move(ways_out);
  return problem;
}

}  // namespace

std::optional<Problem> flaw_of(const Wait& wait) {
  if (wait.seconds >= 0.0 && wait.seconds <= Trajectory::kMostDuration) return std::nullopt;
  return flaw("a wait of " + number_text(wait.seconds) + " s; allowed are 0 to " +
                  number_text(Trajectory::kMostDuration) + " s",
              {"give the wait in seconds, or leave it out"});
}

std::optional<Problem> flaw_of(const WaitInput& wait) {
  if (wait.index < 0 || wait.index >= kDigitalInputs) {
    return flaw("digital input " + std::to_string(wait.index) + "; inputs are 0 to " +
                std::to_string(kDigitalInputs - 1));
  }
  if (wait.timeout && (!(*wait.timeout > 0.0) || !std::isfinite(*wait.timeout))) {
    return flaw("a time-out of " + number_text(*wait.timeout) + " s; it must be above 0 and finite",
                {"leave the time-out out to wait for ever"});
  }
  return std::nullopt;
}

std::optional<Problem> flaw_of(const SetOutput& output, const RobotModel& robot) {
  if (output.index < 0 || output.index >= kDigitalOutputs) {
    return flaw("digital output " + std::to_string(output.index) + "; outputs are 0 to " +
                std::to_string(kDigitalOutputs - 1));
  }
  if (!(std::abs(output.time) <= kMostOutputTime)) {
    return flaw("an output " + number_text(output.time) + " s from its point; allowed are " +
                    number_text(kMostOutputTime) + " s before or after it",
                {"put the output at a nearer point, or a wait before it"});
  }
  if (!std::isfinite(output.distance)) {
    return flaw("the distance of an output from its point is not finite");
  }
  if (output.distance != 0.0 && !robot.has_kinematics()) {
    return flaw(robot.name() + " has no kinematics, so a distance at the tool means nothing to it",
                {"tell the output a time instead"});
  }
  return std::nullopt;
}

std::optional<Problem> flaw_of(const LineTolerance& tolerance) {
  const double finest = std::min(tolerance.position, tolerance.angle);
  if (finest >= kFinestTolerance && std::isfinite(tolerance.position + tolerance.angle)) {
    return std::nullopt;
  }
  char text[160];
  std::snprintf(
      text, sizeof text,
      "tolerance of lines and curves: %g m and %g rad; each must be at least %g and finite",
      tolerance.position, tolerance.angle, kFinestTolerance);
  return flaw(text);
}

std::vector<Problem> flaws_of(const MoveOptions& options, const RobotModel& robot) {
  std::vector<Problem> flaws;
  const auto within = [&](const std::optional<double>& wish, const char* name, double most) {
    if (!wish || (*wish >= kLeastWish && *wish <= most)) return;
    flaws.push_back(flaw(std::string(name) + " is " + number_text(*wish) +
                             "; it must be at least " + number_text(kLeastWish) + " and at most " +
                             number_text(most),
                         {std::string("give ") + name + " within that range, or leave it out"}));
  };
  within(options.speed, "speed", kMostWish);
  within(options.acceleration, "acceleration", kMostWish);
  within(options.process_speed, "process_speed", kMostWish);
  within(options.angular_speed, "angular_speed", kMostWish);
  within(options.angular_acceleration, "angular_acceleration", kMostWish);
  within(options.scale, "scale", 1.0);
  const Zone& zone = options.zone;
  if (!(zone.size >= 0.0) || !std::isfinite(zone.size)) {
    flaws.push_back(
        flaw("zone is " + number_text(zone.size) + "; it must be zero or more and finite",
             {"leave the zone out to stop at the point"}));
  }
  if (zone.bounds_angle() && !(zone.angle > 0.0 && zone.angle <= kPi)) {
    flaws.push_back(flaw("the angle of the zone is " + number_text(zone.angle) +
                             "; it must be above zero and at most pi",
                         {"leave the angle out to bound the position alone"}));
  }
  const bool at_tool =
      zone.kind == ZoneKind::kRadius || zone.kind == ZoneKind::kDeviation || zone.bounds_angle();
  if (at_tool && !robot.has_kinematics()) {
    flaws.push_back(
        flaw(robot.name() + " has no kinematics, so a zone at the tool means nothing to it",
             {"zone=joint_deviation(rad)"}));
  }
  return flaws;
}

}  // namespace viapoint::planning
