/// @file
/// Programs in few words.
#pragma once

#include <utility>

#include "viapoint/kinematics/robot_model.hpp"
#include "viapoint/program/motion_program.hpp"

namespace viapoint::testing_planner {

/// A program that is written step by step; line numbers count from 1.
class Script {
 public:
  Script(const RobotModel& robot, const JointVector& start) {
    program_.robot = robot.name();
    program_.robot_fingerprint = robot.fingerprint();
    program_.start = start;
  }
  template <typename What>
  Script& add(What what, MoveOptions options = {}) {
    program_.steps.push_back(
        {std::move(what), options, {"cell.py", static_cast<int>(program_.steps.size()) + 1}});
    return *this;
  }
  Script& movej(const JointVector& q, Zone zone = {}) {
    MoveOptions options;
    options.zone = zone;
    return add(PtpMove{JointTarget{q}}, options);
  }
  Script& movel(const Pose& pose, Zone zone = {}, Orientation orientation = Orientation::kLeast) {
    MoveOptions options;
    options.zone = zone;
    return add(LinMove{PoseTarget{pose}, orientation}, options);
  }
  [[nodiscard]] MotionProgram& program() { return program_; }

 private:
  MotionProgram program_;
};

}  // namespace viapoint::testing_planner
