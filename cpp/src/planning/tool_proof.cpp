#include "planning/tool_proof.hpp"

#include <algorithm>
#include <string>

#include "viapoint/core/number_text.hpp"

namespace viapoint::planning {
namespace {

/// The path that a piece of the motion lies on.
JointPiece geometry_of(const TrajectoryPiece& piece) {
  JointPiece geometry;
  geometry.coefficients.resize(6, piece.joints);
  for (int k = 0; k < 6; ++k) {
    for (int i = 0; i < piece.joints; ++i) {
      geometry.coefficients(k, i) = piece.path[static_cast<size_t>(k)][static_cast<size_t>(i)];
    }
  }
  geometry.length = 1.0;
  return geometry;
}

}  // namespace

void ToolProof::add(const RobotModel& robot, std::span<const TrajectoryPiece> pieces,
                    std::span<const ToolLimits> limits, double time) {
  if (limits.empty()) return;
  std::optional<ToolRates> rates;
  for (size_t k = 0; k < pieces.size(); ++k) {
    const TrajectoryPiece& piece = pieces[k];
    const double end = time + piece.duration;
    if (limits[k].any()) {
      if (k == 0 || !rates || piece.path != pieces[k - 1].path) {
        rates = tool_rates(robot.forward(), geometry_of(piece));
      }
      rates->limits = limits[k];
      certifier_.add(piece, *rates, time);
      if (limits[k].hold_speed) process_.add(robot.limits(), piece, *rates, time);
      if (!spans_.empty() && spans_.back().move == piece.move && spans_.back().to == time &&
          spans_.back().limits == limits[k]) {
        spans_.back().to = end;
      } else {
        spans_.push_back({piece.move, time, end, limits[k]});
      }
    }
    time = end;
  }
}

double add_process(ProcessProof& process, const RobotModel& robot,
                   std::span<const TrajectoryPiece> pieces, std::span<const ToolLimits> limits,
                   double time) {
  for (size_t k = 0; k < pieces.size(); ++k) {
    if (k < limits.size() && limits[k].hold_speed) {
      ToolRates rates = tool_rates(robot.forward(), geometry_of(pieces[k]));
      rates.limits = limits[k];
      process.add(robot.limits(), pieces[k], rates, time);
    }
    time += pieces[k].duration;
  }
  return time;
}

std::vector<Problem> problems_of(const ToolExtrema& extrema) {
  std::vector<Problem> problems;
  const auto look = [&](const Extremum& worst, ErrorCode code, const char* name, const char* unit) {
    if (worst.share <= 1.0 + kLimitSlack) return;
    Problem problem;
    problem.code = code;
    problem.move = worst.move;
    problem.time = worst.time;
    problem.value = worst.value;
    problem.limit = worst.value / worst.share;
    problem.message = std::string("the ") + name + " of the tool reaches " +
                      number_text(worst.value) + ' ' + unit + "; the move allows " +
                      number_text(worst.value / worst.share);
    problem.ways_out = {"give the move more time: a lower speed or scale"};
    problems.push_back(std::move(problem));
  };
  look(extrema.speed, ErrorCode::kVelocityLimit, "speed", "m/s");
  look(extrema.acceleration, ErrorCode::kAccelerationLimit, "acceleration", "m/s²");
  look(extrema.angular_speed, ErrorCode::kVelocityLimit, "angular speed", "rad/s");
  look(extrema.angular_acceleration, ErrorCode::kAccelerationLimit, "angular acceleration",
       "rad/s²");
  std::ranges::sort(problems, [](const Problem& a, const Problem& b) {
    return *a.value * *b.limit > *b.value * *a.limit;
  });
  return problems;
}

}  // namespace viapoint::planning
