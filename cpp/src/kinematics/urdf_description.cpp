// Robots in URDF, read by liburdfdom: the chain of moving joints from the root link to the tip.
#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>

#include "kinematics/urdf_ring.hpp"
#include "kinematics/xml_bounds.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/core/number_range.hpp"
#include "viapoint/core/number_text.hpp"
#include "viapoint/kinematics/robot_description.hpp"

namespace viapoint {
namespace {

/// URDF has no acceleration and jerk limits: these multiples of the velocity limit are chosen.
constexpr double kAccelerationPerVelocity = 10.0;
constexpr double kJerkPerVelocity = 100.0;

/// liburdfdom calls itself for every element within another, and for every link of a chain when
/// the model goes: far beyond any robot, and far from the end of the stack.
constexpr int kDeepestElement = 100;
constexpr int kMostElements = 50'000;

[[noreturn]] void refuse(const std::string& source, const std::string& what,
                         std::vector<std::string> ways_out = {},
                         ErrorCode code = ErrorCode::kBadRobot) {
  Problem problem;
  problem.code = code;
  problem.message = what;
  problem.ways_out = std::move(ways_out);
  problem.file = source;
  throw MotionError(std::move(problem));
}

/// Collects what liburdfdom would print.
class Complaints final : public console_bridge::OutputHandler {
 public:
  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level < console_bridge::CONSOLE_BRIDGE_LOG_ERROR) return;
    if (!text_.empty()) text_ += "; ";
    text_ += text;
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

/// What mends a complaint of liburdfdom.
std::string way_out_of(const std::string& complaint) {
  const auto says = [&](const char* word) { return complaint.find(word) != std::string::npos; };
  if (says("has no known type")) {
    return "give every joint one of the types revolute, continuous, prismatic and fixed";
  }
  if (says("not unique")) return "give every link, joint and material a name of its own";
  if (says("limit")) {
    return "give every revolute and prismatic joint "
           "<limit lower=\"...\" upper=\"...\" effort=\"...\" velocity=\"...\"/> [rad or m, per s]";
  }
  return "check that the file was written whole, and that every joint names a parent and a child "
         "link of the file";
}

urdf::ModelInterfaceSharedPtr parse(const std::string& text, const std::string& source) {
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) {
    refuse(source, "the file is empty; expected a URDF with a <robot> element");
  }
  const XmlExtent extent = xml_extent(text);
  if (extent.depth > kDeepestElement || extent.elements > kMostElements) {
    refuse(source,
           "it has " + std::to_string(extent.elements) + " elements, up to " +
               std::to_string(extent.depth) + " in one another; a URDF may have " +
               std::to_string(kMostElements) + ", and " + std::to_string(kDeepestElement) +
               " in one another",
           {"check that this is the URDF of a robot", "leave out what is not on the arm's chain"});
  }
  if (const auto ring = urdf_ring(text)) {
    refuse(source, "link \"" + ring->link + "\" carries itself: its joints form a ring",
           {"correct the parent of joint \"" + ring->joint + "\""});
  }
  // liburdfdom reports through one handler for the whole process.
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  Complaints complaints;
  console_bridge::useOutputHandler(&complaints);
  urdf::ModelInterfaceSharedPtr model;
  std::string failure;
  try {
    model = urdf::parseURDF(text);
  } catch (const std::exception& error) {
    failure = error.what();
  }
  console_bridge::restorePreviousOutputHandler();
  if (model) return model;
  const std::string reason = failure.empty() ? complaints.text() : failure;
  refuse(source, "not a URDF robot: " + (reason.empty() ? "it cannot be parsed" : reason),
         {way_out_of(reason)});
}

Pose to_pose(const urdf::Pose& pose) {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;
  double w = 1.0;
  pose.rotation.getQuaternion(x, y, z, w);
  Pose out = Pose::Identity();
  out.linear() = Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix();
  out.translation() = Eigen::Vector3d(pose.position.x, pose.position.y, pose.position.z);
  return out;
}

/// Chains whose place can be told, and within the bounds of every robot.
void require_near(const Pose& pose, const std::string& what, const std::string& source) {
  if (!pose.matrix().allFinite()) {
    refuse(source, what + " has an <origin> that is not finite",
           {"write it as <origin xyz=\"0 0 0\" rpy=\"0 0 0\"/>, in metres and radians"});
  }
  const double farthest = pose.translation().cwiseAbs().maxCoeff();
  if (farthest <= kLongest) return;
  refuse(source,
         what + " is " + number_text(farthest) + " m from what carries it; it may be up to " +
             number_text(kLongest) + " m",
         {"give lengths in metres"});
}

/// About or along one axis.
bool moves(const urdf::Joint& joint) {
  return joint.type == urdf::Joint::REVOLUTE || joint.type == urdf::Joint::CONTINUOUS ||
         joint.type == urdf::Joint::PRISMATIC;
}

/// False for a link that is fixed to the root, such as the second name that many files give it.
bool is_moved(const urdf::ModelInterface& model, urdf::LinkConstSharedPtr link) {
  for (; link->parent_joint; link = model.getLink(link->parent_joint->parent_link_name)) {
    if (moves(*link->parent_joint)) return true;
  }
  return false;
}

urdf::LinkConstSharedPtr find_tip(const urdf::ModelInterface& model, const std::string& source,
                                  const std::string& tip) {
  std::vector<std::string> leaves;
  for (const auto& [name, link] : model.links_) {
    if (link->child_joints.empty() && is_moved(model, link)) leaves.push_back(name);
  }
  std::string list;
  for (const std::string& name : leaves) list += (list.empty() ? "" : ", ") + name;
  if (!tip.empty()) {
    const auto link = model.getLink(tip);
    if (!link) refuse(source, "no link is called \"" + tip + "\"", {"the leaf links are: " + list});
    return link;
  }
  if (leaves.empty())
    refuse(source, "no moving joint between the root link and any leaf",
           {"check the types of the joints; for joints without a chain use joint_robot(...)"});
  if (leaves.size() != 1) {
    refuse(
        source, "the robot branches: it has " + std::to_string(leaves.size()) + " leaf links",
        {"name the link that carries the tool: load_robot(file, tip=\"...\") or --tip, one of: " +
         list});
  }
  return model.getLink(leaves.front());
}

bool has_velocity(const urdf::Joint& joint) {
  return joint.limits && joint.limits->velocity > 0.0 && std::isfinite(joint.limits->velocity);
}

/// Names every joint that cannot be moved for want of a velocity, so that one edit mends them all.
void require_velocities(const std::vector<urdf::JointConstSharedPtr>& joints,
                        const std::string& source) {
  std::string first;
  std::string others;
  for (const auto& joint : joints) {
    if (!moves(*joint) || has_velocity(*joint)) continue;
    const std::string name = "\"" + joint->name + "\"";
    if (first.empty()) {
      first = "joint " + name;
      first += joint->limits ? ": the velocity limit is " + number_text(joint->limits->velocity) +
                                   ", it must be positive and finite"
                             : " has no <limit>";
    } else {
      others += (others.empty() ? "; nor have a velocity: " : ", ") + name;
    }
  }
  if (first.empty()) return;
  const std::string whose = others.empty() ? "this joint" : "these joints";
  refuse(source, first + others,
         {"add velocity=\"...\" (positive, rad/s or m/s) to the <limit> of " + whose},
         ErrorCode::kBadLimits);
}

/// @pre has_velocity(joint)
void add_limits(RobotDescription& out, const urdf::Joint& joint, const std::string& source) {
  const std::string name = "joint \"" + joint.name + "\"";
  const urdf::JointLimits& given = *joint.limits;
  double low = given.lower;
  double high = given.upper;
  if (joint.type == urdf::Joint::CONTINUOUS) {
    low = -std::numeric_limits<double>::infinity();
    high = -low;
  }
  if (!(low < high)) {
    refuse(source,
           name + ": the lower limit " + number_text(low) + " must be below the upper limit " +
               number_text(high),
           {"write lower=\"...\" and upper=\"...\" in the <limit> of this joint"},
           ErrorCode::kBadLimits);
  }
  JointLimits& limits = out.limits;
  const Eigen::Index i = limits.velocity.size();
  for (JointVector* values : {&limits.position_min, &limits.position_max, &limits.velocity,
                              &limits.acceleration, &limits.jerk}) {
    values->conservativeResize(i + 1);
  }
  limits.position_min[i] = low;
  limits.position_max[i] = high;
  limits.velocity[i] = given.velocity;
  limits.acceleration[i] = kAccelerationPerVelocity * given.velocity;
  limits.jerk[i] = kJerkPerVelocity * given.velocity;
}

}  // namespace

RobotDescription description_from_urdf(const std::string& text, const std::string& source,
                                       const std::string& tip) {
  const urdf::ModelInterfaceSharedPtr model = parse(text, source);
  std::vector<urdf::JointConstSharedPtr> joints;
  for (auto link = find_tip(*model, source, tip); link->parent_joint;
       link = model->getLink(link->parent_joint->parent_link_name)) {
    joints.push_back(link->parent_joint);
  }
  std::reverse(joints.begin(), joints.end());
  require_velocities(joints, source);

  RobotDescription out;
  out.name = model->getName();
  if (out.name.empty()) {
    refuse(source, "the robot has an empty name", {"write it as <robot name=\"...\">"});
  }
  out.title = out.name + ", from URDF";
  out.sources = {source};
  out.chosen = {"acceleration: 10 x velocity, URDF has none",
                "jerk: 100 x velocity, URDF has none"};
  Pose before = Pose::Identity();
  for (const auto& joint : joints) {
    const std::string name = "joint \"" + joint->name + "\"";
    before = before * to_pose(joint->parent_to_joint_origin_transform);
    require_near(before, name, source);
    if (joint->type == urdf::Joint::FIXED) continue;
    if (joint->name.empty()) {
      refuse(source, "a joint has an empty name", {"write it as <joint name=\"...\">"});
    }
    if (!moves(*joint)) {
      refuse(source,
             name +
                 " is floating or planar; only revolute, continuous, prismatic and fixed "
                 "joints are supported",
             {"make it of revolute and prismatic joints, or end the chain before it with tip"});
    }
    if (joint->mimic)
      refuse(source, name + " mimics another; that is not supported",
             {"end the chain before it with tip, or delete its <mimic>"});
    if (out.chain.size() == static_cast<size_t>(kMaxJoints)) {
      refuse(source, "more than " + std::to_string(kMaxJoints) + " moving joints",
             {"end the chain earlier with tip", "make joints that stand still fixed"});
    }
    const Eigen::Vector3d axis(joint->axis.x, joint->axis.y, joint->axis.z);
    if (!(axis.norm() > 1e-9))
      refuse(source, name + ": its <axis> has no direction", {"write it as <axis xyz=\"0 0 1\"/>"});
    ChainJoint chain;
    chain.type =
        joint->type == urdf::Joint::PRISMATIC ? JointType::kPrismatic : JointType::kRevolute;
    chain.before = before;
    chain.axis = axis.normalized();
    add_limits(out, *joint, source);
    out.chain.push_back(chain);
    out.joint_names.push_back(joint->name);
    before = Pose::Identity();
  }
  if (out.chain.empty())
    refuse(source, "no moving joint between the root link and the tip", {"name a tip that moves"});
  out.flange = before;
  out.limits.coupling.resize(0, static_cast<Eigen::Index>(out.chain.size()));
  out.limits.validate();
  return out;
}

}  // namespace viapoint
