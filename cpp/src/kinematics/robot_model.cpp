#include "viapoint/kinematics/robot_model.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <kdl/chain.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <utility>

#include "kinematics/inverse_errors.hpp"
#include "kinematics/inverse_factory.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/core/number_range.hpp"
#include "viapoint/core/number_text.hpp"
#include "viapoint/kinematics/inverse_kinematics.hpp"

namespace viapoint {
namespace {

KDL::Frame to_kdl(const Pose& pose) {
  const Eigen::Matrix3d& r = pose.linear();
  const Eigen::Vector3d& p = pose.translation();
  return {KDL::Rotation(r(0, 0), r(0, 1), r(0, 2), r(1, 0), r(1, 1), r(1, 2), r(2, 0), r(2, 1),
                        r(2, 2)),
          KDL::Vector(p.x(), p.y(), p.z())};
}

KDL::JntArray to_kdl(const JointVector& q) {
  KDL::JntArray out(static_cast<unsigned>(q.size()));
  out.data = q;
  return out;
}

/// The chain from the frame that poses are told in: the arm's placement is part of it.
std::vector<ChainJoint> placed_chain(const RobotDescription& description) {
  std::vector<ChainJoint> chain = description.chain;
  // Left to the last bit as it is where the arm stands at the origin.
  if (!chain.empty() && description.base.matrix() != Eigen::Matrix4d::Identity()) {
    chain.front().before = description.base * chain.front().before;
  }
  return chain;
}

/// FNV-1a, 64 bit (Fowler, Noll, Vo 1991).
class Fingerprint {
 public:
  void add(double value) {
    unsigned char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    for (const unsigned char byte : bytes) hash_ = (hash_ ^ byte) * 0x100000001b3ULL;
  }
  template <typename Derived>
  void add(const Eigen::MatrixBase<Derived>& values) {
    add(static_cast<double>(values.rows()));
    add(static_cast<double>(values.cols()));
    for (Eigen::Index column = 0; column < values.cols(); ++column) {
      for (Eigen::Index row = 0; row < values.rows(); ++row) add(values(row, column));
    }
  }
  [[nodiscard]] std::string hex() const {
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash_));
    return text;
  }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325ULL;
};

std::string fingerprint_of(const RobotDescription& description) {
  Fingerprint hash;
  for (const ChainJoint& joint : placed_chain(description)) {
    hash.add(joint.type == JointType::kRevolute ? 0.0 : 1.0);
    hash.add(joint.before.matrix());
    hash.add(joint.axis);
  }
  hash.add((description.flange * description.tool).matrix());
  const JointLimits& limits = description.limits;
  for (const JointVector* values : {&limits.position_min, &limits.position_max, &limits.velocity,
                                    &limits.acceleration, &limits.jerk}) {
    hash.add(*values);
  }
  hash.add(limits.coupling);
  hash.add(limits.coupling_lower);
  hash.add(limits.coupling_upper);
  return hash.hex();
}

[[noreturn]] void refuse(const RobotDescription& description, const std::string& what) {
  throw MotionError(ErrorCode::kBadRobot, "robot \"" + description.name + "\": " + what);
}

void require_near(const RobotDescription& description, const Pose& pose, const std::string& what) {
  if (!pose.matrix().allFinite()) refuse(description, what + " must be finite");
  const double farthest = pose.translation().cwiseAbs().maxCoeff();
  if (farthest <= kLongest) return;
  refuse(description, what + " is " + number_text(farthest) + " m away; it may be up to " +
                          number_text(kLongest) + " m: give lengths in metres");
}

void require_sound(const RobotDescription& description) {
  description.limits.validate();
  const size_t joints = static_cast<size_t>(description.limits.joints());
  if (description.joint_names.size() != joints) {
    refuse(description, std::to_string(description.joint_names.size()) + " joint names for " +
                            std::to_string(joints) + " joints");
  }
  if (description.chain.empty()) return;
  if (description.chain.size() != joints) {
    refuse(description, "a chain of " + std::to_string(description.chain.size()) +
                            " joints with limits for " + std::to_string(joints));
  }
  require_near(description, description.base, "base");
  require_near(description, description.flange, "flange");
  require_near(description, description.tool, "tool");
  for (size_t i = 0; i < joints; ++i) {
    const ChainJoint& joint = description.chain[i];
    const std::string name = "joint " + std::to_string(i + 1);
    if (std::abs(joint.axis.norm() - 1.0) > 1e-9) {
      refuse(description, name + " needs an axis of length 1");
    }
    require_near(description, joint.before, "the placement of " + name);
  }
}

}  // namespace

struct RobotModel::Kdl {
  KDL::Chain chain;
};

RobotModel::RobotModel(RobotDescription description, bool has_kinematics)
    : description_(std::move(description)),
      has_kinematics_(has_kinematics),
      fingerprint_(fingerprint_of(description_)) {
  if (!has_kinematics_) return;
  const Pose tool = description_.flange * description_.tool;
  const std::vector<ChainJoint> chain = placed_chain(description_);
  forward_ = ForwardKinematics(chain, tool);
  auto kdl = std::make_unique<Kdl>();
  for (const ChainJoint& joint : chain) {
    const KDL::Vector axis(joint.axis.x(), joint.axis.y(), joint.axis.z());
    const auto type =
        joint.type == JointType::kRevolute ? KDL::Joint::RotAxis : KDL::Joint::TransAxis;
    kdl->chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::None), to_kdl(joint.before)));
    kdl->chain.addSegment(KDL::Segment(KDL::Joint(KDL::Vector::Zero(), axis, type)));
  }
  kdl->chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::None), to_kdl(tool)));
  kdl_ = std::move(kdl);
  inverse_ = make_inverse(forward_, description_.limits);
}

RobotModel::~RobotModel() = default;

std::shared_ptr<const RobotModel> RobotModel::make(RobotDescription description) {
  require_sound(description);
  const bool has_kinematics = !description.chain.empty();
  // make_shared cannot reach the private constructor.
  return std::shared_ptr<const RobotModel>(new RobotModel(std::move(description), has_kinematics));
}

std::shared_ptr<const RobotModel> RobotModel::joint_robot(const JointLimits& limits) {
  RobotDescription description;
  description.name = "joint_robot";
  description.title = std::to_string(limits.joints()) + " joints without kinematics";
  description.limits = limits;
  for (int i = 0; i < limits.joints(); ++i) {
    description.joint_names.push_back("joint" + std::to_string(i + 1));
  }
  return make(std::move(description));
}

std::shared_ptr<const RobotModel> RobotModel::with_limits(const JointLimits& limits) const {
  if (limits.joints() != joints()) {
    throw MotionError(ErrorCode::kBadLimits, "limits for " + std::to_string(limits.joints()) +
                                                 " joints, the arm has " +
                                                 std::to_string(joints()));
  }
  RobotDescription description = description_;
  description.limits = limits;
  return make(std::move(description));
}

std::shared_ptr<const RobotModel> RobotModel::with_tool(const Pose& pose_flange_tool) const {
  require_kinematics();
  RobotDescription description = description_;
  description.tool = pose_flange_tool;
  return make(std::move(description));
}

std::shared_ptr<const RobotModel> RobotModel::with_base(const Pose& pose_world_base) const {
  require_kinematics();
  RobotDescription description = description_;
  description.base = pose_world_base;
  return make(std::move(description));
}

void RobotModel::require_kinematics() const {
  if (has_kinematics_) return;
  throw MotionError(ErrorCode::kUncontrolled,
                    "robot \"" + name() + "\" has joints and limits but no kinematics",
                    {"move it in joint space", "load a robot with a D-H table or a URDF"});
}

void RobotModel::require_kinematics(const JointVector& q) const {
  require_kinematics();
  require_joints(q, joints(), "q");
}

Pose RobotModel::fk(const JointVector& q) const {
  require_kinematics(q);
  KDL::ChainFkSolverPos_recursive solver(kdl_->chain);
  KDL::Frame frame;
  if (solver.JntToCart(to_kdl(q), frame) < 0) {
    throw MotionError(ErrorCode::kInternal, "KDL refused the forward kinematics");
  }
  Pose pose = Pose::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) pose(row, column) = frame.M(row, column);
    pose(row, 3) = frame.p(row);
  }
  return pose;
}

Jacobian RobotModel::jacobian(const JointVector& q) const {
  require_kinematics(q);
  // The solver keeps a workspace of its own, so each call has its solver.
  KDL::ChainJntToJacSolver solver(kdl_->chain);
  KDL::Jacobian out(static_cast<unsigned>(joints()));
  if (solver.JntToJac(to_kdl(q), out) < 0) {
    throw MotionError(ErrorCode::kInternal, "KDL refused the Jacobian");
  }
  return out.data;
}

}  // namespace viapoint
