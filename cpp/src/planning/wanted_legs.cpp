#include "viapoint/planning/wanted_legs.hpp"

#include <type_traits>
#include <utility>
#include <variant>

#include "planning/itinerary.hpp"
#include "planning/spline_way.hpp"
#include "planning/tool_changes.hpp"
#include "planning/tool_way.hpp"

namespace viapoint {
namespace {

using planning::Leg;
using planning::ToolWay;

/// The curve of a Cartesian leg, as its builder made it.
ToolWay way_of(const Step& step, const LineTolerance& tolerance, const Leg& leg) {
  return std::visit(
      [&](const auto& move) -> ToolWay {
        using Move = std::decay_t<decltype(move)>;
        if constexpr (std::is_same_v<Move, SplineMove>) {
          return planning::way_of(move, *leg.robot, tolerance, leg.start);
        } else if constexpr (std::is_same_v<Move, LinMove> || std::is_same_v<Move, CircMove> ||
                             std::is_same_v<Move, TurnMove>) {
          return planning::way_of(move, *leg.robot, leg.start);
        } else {
          throw MotionError(ErrorCode::kInternal, "a leg on a tool curve that no step asked for");
        }
      },
      step.what);
}

/// The frame that every step is told in.
std::vector<Pose> frames_of(const MotionProgram& program) {
  std::vector<Pose> frames;
  Pose frame = Pose::Identity();
  for (const Step& step : program.steps) {
    if (const auto* set_frame = std::get_if<SetFrame>(&step.what)) {
      frame = set_frame->pose_base_frame;
    }
    frames.push_back(frame);
  }
  return frames;
}

}  // namespace

std::vector<WantedLeg> wanted_legs(const RobotPtr& robot, const MotionProgram& program) {
  if (planning::timed_alone(robot, program)) return {};
  const planning::Itinerary itinerary = planning::make_itinerary(robot, program);
  for (const Problem& problem : itinerary.report.problems) {
    if (problem.severity == Severity::kError) throw MotionError(problem);
  }
  const std::vector<Pose> frames = frames_of(program);
  std::vector<WantedLeg> legs;
  for (const planning::Item& item : itinerary.items) {
    const auto* leg = std::get_if<Leg>(&item);
    if (leg == nullptr) continue;
    WantedLeg wanted{leg->robot, leg->step, leg->path, nullptr, Hold::kPose, leg->options, {}};
    for (size_t k = 0; k < leg->merged.points.size(); ++k) {
      const planning::MergedPlace& place = leg->merged.places[k];
      wanted.merged.push_back({leg->merged.points[k], place.at, place.rotation});
    }
    if (leg->cartesian) {
      const auto index = static_cast<size_t>(leg->step);
      const Step step = in_base(program.steps[index], frames[index]);
      ToolWay way = way_of(step, program.tolerance, *leg);
      wanted.curve = std::move(way.curve);
      wanted.hold = way.hold;
    }
    legs.push_back(std::move(wanted));
  }
  return legs;
}

}  // namespace viapoint
