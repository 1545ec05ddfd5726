#include <string>

#include "fuzz/broken_promise.hpp"
#include "fuzz/targets.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/kinematics/robot_description.hpp"
#include "viapoint/kinematics/robot_model.hpp"

namespace viapoint::fuzz {
namespace {

/// What is read of a robot is what goes over the wire, so it has to read back.
void use(const RobotDescription& description) {
  const std::string text = to_yaml(description);
  promise(to_yaml(description_from_yaml(text, "again.yaml")) == text,
          "a robot that was read does not read back");
  try {
    const RobotPtr robot = RobotModel::make(description);
    const JointVector q = 0.5 * (robot->limits().position_min.cwiseMax(-1.0) +
                                 robot->limits().position_max.cwiseMin(1.0));
    promise(robot->forward().pose(q).matrix().allFinite(), "a robot whose tool is nowhere");
  } catch (const MotionError& error) {  // well formed, and still no arm
    promise(!error.problem().message.empty(), "a refusal without words");
  }
}

}  // namespace

void robot_yaml(std::string_view bytes) {
  RobotDescription description;
  try {
    description = description_from_yaml(std::string(bytes), "fuzz.yaml");
  } catch (const MotionError&) {
    return;
  }
  use(description);
}

void robot_urdf(std::string_view bytes) {
  RobotDescription description;
  try {
    description = description_from_urdf(std::string(bytes), "fuzz.urdf");
  } catch (const MotionError&) {
    return;
  }
  use(description);
}

}  // namespace viapoint::fuzz
