/// @file
/// Values of a step that mean nothing, or lie outside what is allowed, wherever the arm is.
#pragma once

#include <optional>
#include <vector>

#include "viapoint/core/error.hpp"
#include "viapoint/kinematics/robot_model.hpp"
#include "viapoint/program/motion_program.hpp"

namespace viapoint::planning {

[[nodiscard]] std::optional<Problem> flaw_of(const Wait& wait);
[[nodiscard]] std::optional<Problem> flaw_of(const WaitInput& wait);
[[nodiscard]] std::optional<Problem> flaw_of(const SetOutput& output, const RobotModel& robot);
[[nodiscard]] std::optional<Problem> flaw_of(const LineTolerance& tolerance);
/// All of them: each option stands for itself.
[[nodiscard]] std::vector<Problem> flaws_of(const MoveOptions& options, const RobotModel& robot);

}  // namespace viapoint::planning
