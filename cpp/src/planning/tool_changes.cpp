#include "planning/tool_changes.hpp"

#include <algorithm>

namespace viapoint::planning {

RobotPtr ToolChanges::with(const SetTool& step) {
  if (!step.pose_flange_tool) return robots_.front();
  const auto known = std::find_if(robots_.begin(), robots_.end(), [&](const RobotPtr& robot) {
    return robot->has_kinematics() &&
           robot->description().tool.matrix() == step.pose_flange_tool->matrix();
  });
  if (known != robots_.end()) return *known;
  robots_.push_back(robots_.front()->with_tool(*step.pose_flange_tool));
  return robots_.back();
}

std::optional<TimedAlone> timed_alone(const RobotPtr& robot, const MotionProgram& program) {
  if (program.steps.empty() || !std::holds_alternative<TimedMove>(program.steps.back().what)) {
    return std::nullopt;
  }
  ToolChanges tools(robot);
  Pose frame = Pose::Identity();
  TimedAlone alone{robot, {}, static_cast<int>(program.steps.size()) - 1};
  for (const Step& step : program.steps) {
    if (const auto* set_frame = std::get_if<SetFrame>(&step.what)) {
      frame = set_frame->pose_base_frame;
    } else if (const auto* set_tool = std::get_if<SetTool>(&step.what)) {
      alone.robot = tools.with(*set_tool);
    } else if (&step != &program.steps.back()) {
      return std::nullopt;
    }
  }
  alone.move = std::get<TimedMove>(in_base(program.steps.back(), frame).what);
  return alone;
}

}  // namespace viapoint::planning
