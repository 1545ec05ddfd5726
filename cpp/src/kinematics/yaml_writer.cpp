#include <charconv>
#include <cmath>
#include <sstream>
#include <string>

#include "viapoint/core/error.hpp"
#include "viapoint/kinematics/robot_description.hpp"

namespace viapoint {
namespace {

/// The shortest text that reads back to the same double.
std::string number(double value) {
  if (std::isinf(value)) return value > 0.0 ? ".inf" : "-.inf";
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  return {text, end};
}

template <typename Derived>
std::string list(const Eigen::MatrixBase<Derived>& values) {
  std::string out = "[";
  for (Eigen::Index row = 0; row < values.rows(); ++row) {
    for (Eigen::Index column = 0; column < values.cols(); ++column) {
      if (out.size() > 1) out += ", ";
      out += number(values(row, column));
    }
  }
  return out + "]";
}

/// In double quotes, with what YAML would otherwise read as syntax escaped.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (c == '\n') {
      out += "\\n";
    } else if (c == '\t') {
      out += "\\t";
    } else if (c == '\r') {
      out += "\\r";
    } else {
      out += c;
    }
  }
  return out + "\"";
}

std::string pose(const Pose& value) {
  return "{xyz: " + list(value.translation()) + ", rotation: " + list(value.linear()) + "}";
}

void write_texts(std::ostringstream& out, const char* key, const std::vector<std::string>& texts) {
  if (texts.empty()) return;
  out << key << ":\n";
  for (const std::string& text : texts) out << "  - " << quoted(text) << "\n";
}

}  // namespace

std::string to_yaml(const RobotDescription& description) {
  const JointLimits& limits = description.limits;
  const size_t joints = description.joint_names.size();
  const bool kinematics = !description.chain.empty();
  if (joints != static_cast<size_t>(limits.joints()) ||
      (kinematics && description.chain.size() != joints)) {
    throw MotionError(ErrorCode::kBadArgument,
                      "a description needs as many joint names and chain joints as limits");
  }
  std::ostringstream out;
  out << "name: " << quoted(description.name) << "\n";
  if (!description.title.empty()) out << "title: " << quoted(description.title) << "\n";
  out << "units: {angle: rad}\n";
  out << "axes: " << joints << "\n";
  if (!kinematics) {
    out << "kinematics: none\n";
  } else {
    if (description.base.matrix() != Eigen::Matrix4d::Identity()) {
      out << "base: " << pose(description.base) << "\n";
    }
    out << "flange: " << pose(description.flange) << "\n";
    out << "tool: " << pose(description.tool) << "\n";
  }
  if (limits.couplings() > 0) {
    out << "coupling:\n  matrix:\n";
    for (int row = 0; row < limits.couplings(); ++row) {
      out << "    - " << list(limits.coupling.row(row)) << "\n";
    }
    out << "  lower: " << list(limits.coupling_lower) << "\n";
    out << "  upper: " << list(limits.coupling_upper) << "\n";
  }
  write_texts(out, "sources", description.sources);
  write_texts(out, "chosen", description.chosen);
  // The joints come last, each closed by a brace: a file cut short is always found out.
  out << "joints:\n";
  for (size_t i = 0; i < joints; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    out << "  - {name: " << quoted(description.joint_names[i]);
    if (kinematics) {
      const ChainJoint& joint = description.chain[i];
      out << ", type: " << (joint.type == JointType::kRevolute ? "revolute" : "prismatic")
          << ", origin: " << pose(joint.before) << ", axis: " << list(joint.axis);
    }
    out << ", position: [" << number(limits.position_min[k]) << ", "
        << number(limits.position_max[k]) << "], velocity: " << number(limits.velocity[k])
        << ", acceleration: " << number(limits.acceleration[k])
        << ", jerk: " << number(limits.jerk[k]) << "}\n";
  }
  return out.str();
}

}  // namespace viapoint
