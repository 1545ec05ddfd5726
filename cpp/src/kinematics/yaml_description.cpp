// Robots in YAML: Denavit–Hartenberg tables (standard: Denavit & Hartenberg 1955 as in Paul 1981;
// modified: Craig 1986), joint axes, or joints with limits alone.
#include <yaml-cpp/depthguard.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinematics/yaml_documents.hpp"
#include "kinematics/yaml_map.hpp"
#include "viapoint/core/number_range.hpp"
#include "viapoint/core/number_text.hpp"
#include "viapoint/core/units.hpp"
#include "viapoint/kinematics/robot_description.hpp"

namespace viapoint {
namespace {

enum class Form { kStandard, kModified, kAxes, kNone };

const std::vector<std::string> kTopKeys{"name",       "title",  "units",  "axes", "dh",
                                        "kinematics", "base",   "flange", "tool", "coupling",
                                        "sources",    "chosen", "joints"};
const std::vector<std::string> kLimitKeys{"name",     "type",         "position",
                                          "velocity", "acceleration", "jerk"};

/// Sine and cosine that are exact at right angles, where π/2 in binary is not.
std::pair<double, double> sine_cosine(double angle) {
  const double quarter = std::round(angle / (kPi / 2.0));
  if (std::abs(angle - quarter * (kPi / 2.0)) > 1e-15 * std::max(1.0, std::abs(angle))) {
    return {std::sin(angle), std::cos(angle)};
  }
  constexpr double kSine[4] = {0.0, 1.0, 0.0, -1.0};
  const auto index = static_cast<size_t>(std::fmod(std::fmod(quarter, 4.0) + 4.0, 4.0));
  return {kSine[index], kSine[(index + 1) % 4]};
}

Pose about_x(double angle) {
  const auto [s, c] = sine_cosine(angle);
  Pose pose = Pose::Identity();
  pose.linear() << 1.0, 0.0, 0.0, 0.0, c, -s, 0.0, s, c;
  return pose;
}

Pose about_y(double angle) {
  const auto [s, c] = sine_cosine(angle);
  Pose pose = Pose::Identity();
  pose.linear() << c, 0.0, s, 0.0, 1.0, 0.0, -s, 0.0, c;
  return pose;
}

Pose about_z(double angle) {
  const auto [s, c] = sine_cosine(angle);
  Pose pose = Pose::Identity();
  pose.linear() << c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0;
  return pose;
}

Pose shift(double x, double y, double z) { return Pose(Eigen::Translation3d(x, y, z)); }

/// {xyz: [...], rpy: [...]} (fixed axes x, y, z in turn) or {xyz: [...], rotation: [9 by rows]}.
Pose read_pose(const YamlValue& value, double angle) {
  YamlMap map(value, {"xyz", "rpy", "rotation"});
  map.finish();
  Pose pose = Pose::Identity();
  if (map.has("rpy") && map.has("rotation")) value.refuse("give rpy or rotation, not both");
  if (map.has("rpy")) {
    const auto rpy = map.at("rpy").numbers(3);
    pose = about_z(rpy[2] * angle) * about_y(rpy[1] * angle) * about_x(rpy[0] * angle);
  }
  if (map.has("rotation")) {
    const YamlValue entry = map.at("rotation");
    const auto rows = entry.numbers(9);
    pose.linear() << rows[0], rows[1], rows[2], rows[3], rows[4], rows[5], rows[6], rows[7],
        rows[8];
    const Eigen::Matrix3d off =
        pose.linear().transpose() * pose.linear() - Eigen::Matrix3d::Identity();
    if (!(off.cwiseAbs().maxCoeff() < 1e-9) || pose.linear().determinant() < 0.0) {
      entry.refuse("these nine numbers (by rows) are not a rotation matrix");
    }
  }
  if (map.has("xyz")) {
    const auto xyz = map.at("xyz").numbers(3);
    pose.translation() << xyz[0], xyz[1], xyz[2];
  }
  if (!pose.matrix().allFinite()) value.refuse("every number must be finite");
  if (pose.translation().cwiseAbs().maxCoeff() > kLongest) {
    value.refuse("a length is " + number_text(pose.translation().cwiseAbs().maxCoeff()) +
                     " m; it may be up to " + number_text(kLongest) + " m",
                 {"give lengths in metres"});
  }
  return pose;
}

class Reader {
 public:
  Reader(const YAML::Node& root, const std::string& source)
      : top_(YamlValue(root, source, ""), kTopKeys) {}

  RobotDescription read() {
    top_.finish();
    require_joints_last();
    out_.name = top_.at("name", "a line \"name: my_arm\"").text();
    if (out_.name.empty()) top_.at("name").refuse("expected a name, got nothing");
    if (top_.has("title")) out_.title = top_.at("title").text();
    read_units();
    read_form();
    if (top_.has("sources")) out_.sources = top_.at("sources").texts();
    if (top_.has("chosen")) out_.chosen = top_.at("chosen").texts();
    read_joints();
    if (top_.has("base")) out_.base = read_pose(top_.at("base"), angle_);
    if (top_.has("flange")) out_.flange = out_.flange * read_pose(top_.at("flange"), angle_);
    if (top_.has("tool")) out_.tool = read_pose(top_.at("tool"), angle_);
    if (form_ == Form::kNone && (top_.has("base") || top_.has("flange") || top_.has("tool"))) {
      top_.value().refuse("a robot without kinematics has no base, no flange and no tool");
    }
    if (top_.has("coupling")) read_coupling();
    return std::move(out_);
  }

 private:
  void read_units() {
    YamlMap units(top_.at("units", "\"units: {angle: deg}\" or \"units: {angle: rad}\""),
                  {"angle"});
    units.finish();
    const YamlValue angle = units.at("angle", "\"angle: deg\" or \"angle: rad\"");
    if (angle.text() == "deg") {
      angle_ = kDegree;
    } else if (angle.text() != "rad") {
      angle.refuse("expected deg or rad, got \"" + angle.text() + "\"");
    }
  }

  void read_form() {
    if (top_.has("dh") && top_.has("kinematics")) {
      top_.at("kinematics").refuse("give dh or kinematics, not both");
    }
    if (top_.has("dh")) {
      const YamlValue dh = top_.at("dh");
      if (dh.text() == "standard") {
        form_ = Form::kStandard;
      } else if (dh.text() == "modified") {
        form_ = Form::kModified;
      } else {
        dh.refuse("expected standard or modified, got \"" + dh.text() + "\"",
                  {"leave out dh to give each joint an origin and an axis"});
      }
    } else if (top_.has("kinematics")) {
      const YamlValue kinematics = top_.at("kinematics");
      if (kinematics.text() != "none") kinematics.refuse("the only value known is none");
      form_ = Form::kNone;
    }
  }

  /// A file cut short is always found out: within the joints by an open brace or their number, and
  /// before them by their want. Behind them, a tool or a coupled limit would be lost unseen.
  void require_joints_last() const {
    bool behind = false;
    for (const auto& entry : top_.value().node()) {
      const YamlValue key(entry.first, top_.value().source(), "");
      if (behind) {
        key.refuse("key \"" + key.text() + "\" stands behind the joints, which come last",
                   {"move it above \"joints:\"; so a file cut short is always found out"});
      }
      behind = key.text() == "joints";
    }
  }

  void read_joints() {
    const YamlValue joints = top_.at("joints", "a list \"joints:\" with one entry a joint");
    const std::vector<YamlValue> list = joints.list();
    const std::string count = std::to_string(list.size());
    const YamlValue axes = top_.at(
        "axes", "\"axes: " + count + "\", the number of joints: so one that is lost is found out");
    if (list.empty() || axes.whole_number() != static_cast<int>(list.size())) {
      axes.refuse("says " + axes.text() + ", but " + count + " joints are listed",
                  {"if the file is whole, write \"axes: " + count + "\""});
    }
    if (list.size() > static_cast<size_t>(kMaxJoints)) {
      joints.refuse("at most " + std::to_string(kMaxJoints) + " joints are supported");
    }
    const auto n = static_cast<Eigen::Index>(list.size());
    JointLimits& limits = out_.limits;
    for (JointVector* values : {&limits.position_min, &limits.position_max, &limits.velocity,
                                &limits.acceleration, &limits.jerk}) {
      values->resize(n);
    }
    limits.coupling.resize(0, n);
    for (Eigen::Index i = 0; i < n; ++i) read_joint(list[static_cast<size_t>(i)], i);
    if (form_ == Form::kStandard) out_.flange = link_;
  }

  void read_joint(const YamlValue& value, Eigen::Index i) {
    if (value.node().IsMap() && value.node().Style() != YAML::EmitterStyle::Flow) {
      value.refuse("a joint stands in braces",
                   {"write it as {name: ..., position: [...], ...}; so a file cut short is always "
                    "found out"});
    }
    std::vector<std::string> keys = kLimitKeys;
    if (form_ == Form::kAxes) keys.insert(keys.end(), {"origin", "axis"});
    if (form_ == Form::kStandard || form_ == Form::kModified) {
      keys.insert(keys.end(), {"d", "a", "alpha", "theta"});
    }
    YamlMap joint(value, std::move(keys));
    joint.finish();
    const std::string name = joint.at("name", "a name for this joint").text();
    if (std::find(out_.joint_names.begin(), out_.joint_names.end(), name) !=
        out_.joint_names.end()) {
      joint.at("name").refuse("two joints are called \"" + name + "\"");
    }
    out_.joint_names.push_back(name);

    ChainJoint chain;
    if (joint.has("type")) {
      const YamlValue type = joint.at("type");
      if (type.text() == "prismatic") {
        chain.type = JointType::kPrismatic;
      } else if (type.text() != "revolute") {
        type.refuse("expected revolute or prismatic, got \"" + type.text() + "\"");
      }
    }
    const double unit = chain.type == JointType::kRevolute ? angle_ : 1.0;
    read_limits(joint, i, unit);
    if (form_ == Form::kNone) return;
    if (form_ == Form::kAxes) {
      if (joint.has("origin")) chain.before = read_pose(joint.at("origin"), angle_);
      chain.axis = read_axis(joint);
    } else {
      read_dh(joint, chain);
    }
    out_.chain.push_back(chain);
  }

  Eigen::Vector3d read_axis(YamlMap& joint) const {
    const YamlValue entry =
        joint.at("axis", "the axis in the joint's frame, as \"axis: [0, 0, 1]\"");
    const auto numbers = entry.numbers(3);
    const Eigen::Vector3d axis(numbers[0], numbers[1], numbers[2]);
    const double norm = axis.norm();
    if (!(norm > 1e-9) || !std::isfinite(norm)) entry.refuse("an axis needs a direction");
    // Left as it is where it is a unit vector already: what was written reads back unchanged.
    return std::abs(norm - 1.0) < 1e-12 ? axis : Eigen::Vector3d(axis / norm);
  }

  double dh_number(YamlMap& joint, const std::string& key, bool needed) const {
    if (!needed && !joint.has(key)) return 0.0;
    const YamlValue entry = joint.at(key, "\"" + key + ": 0\" or its value");
    const double value = entry.number();
    if (!std::isfinite(value)) entry.refuse("must be finite");
    return value;
  }

  void read_dh(YamlMap& joint, ChainJoint& chain) {
    const double d = dh_number(joint, "d", true);
    const double a = dh_number(joint, "a", true);
    for (const char* key : {"d", "a"}) {
      if (std::abs(dh_number(joint, key, true)) <= kLongest) continue;
      joint.at(key).refuse(
          "is " + joint.at(key).text() + " m; it may be up to " + number_text(kLongest) + " m",
          {"give lengths in metres"});
    }
    const double alpha = dh_number(joint, "alpha", true) * angle_;
    const double theta = dh_number(joint, "theta", false) * angle_;
    if (form_ == Form::kStandard) {
      // Rz(θ) Tz(d) Tx(a) Rx(α): the link comes after the joint. Turn and slide along z commute,
      // so the constant of the joint's own coordinate is put before it.
      chain.before = link_ * about_z(theta);
      link_ = shift(a, 0.0, d) * about_x(alpha);
    } else {
      // Rx(α) Tx(a) Rz(θ) Tz(d): the link comes before the joint.
      chain.before = about_x(alpha) * shift(a, 0.0, 0.0) * about_z(theta) * shift(0.0, 0.0, d);
    }
  }

  void read_limits(YamlMap& joint, Eigen::Index i, double unit) {
    JointLimits& limits = out_.limits;
    const std::string per = unit == 1.0 ? "m" : (angle_ == kDegree ? "deg" : "rad");
    const YamlValue position =
        joint.at("position", "\"position: [min, max]\" in " + per + " (.inf for none)",
                 ErrorCode::kBadLimits);
    const auto range = position.numbers(2);
    if (!(range[0] < range[1])) {
      position.refuse("the lower limit " + number_text(range[0]) +
                          " must be below the upper limit " + number_text(range[1]),
                      {"write the lower limit first"}, ErrorCode::kBadLimits);
    }
    limits.position_min[i] = range[0] * unit;
    limits.position_max[i] = range[1] * unit;
    const auto rate = [&](const std::string& key, const std::string& power) {
      const YamlValue entry =
          joint.at(key, "\"" + key + ": ...\" in " + per + "/s" + power, ErrorCode::kBadLimits);
      const double value = entry.number();
      if (!(value > 0.0) || !std::isfinite(value)) {
        entry.refuse("must be positive and finite, got " + entry.text(), {}, ErrorCode::kBadLimits);
      }
      if (!(value * unit >= kLeastRate && value * unit <= kMostRate)) {
        entry.refuse("must be from " + number_text(kLeastRate / unit) + " to " +
                         number_text(kMostRate / unit) + " " + per + "/s" + power + ", got " +
                         entry.text(),
                     {"check the unit: the file says " + per}, ErrorCode::kBadLimits);
      }
      return value * unit;
    };
    limits.velocity[i] = rate("velocity", "");
    limits.acceleration[i] = rate("acceleration", "^2");
    limits.jerk[i] = rate("jerk", "^3");
  }

  /// lower <= C q <= upper. In degrees, entries of C stay as they are and the bounds are converted:
  /// that holds only among revolute joints, so with prismatic ones the file must be in rad.
  void read_coupling() {
    const YamlValue value = top_.at("coupling");
    YamlMap map(value, {"matrix", "lower", "upper"});
    map.finish();
    const int joints = out_.limits.joints();
    const bool slides = std::any_of(out_.chain.begin(), out_.chain.end(), [](const auto& joint) {
      return joint.type == JointType::kPrismatic;
    });
    if (slides && angle_ == kDegree) {
      value.refuse("a coupling with prismatic joints needs \"units: {angle: rad}\"");
    }
    const YamlValue matrix = map.at("matrix", "\"matrix: [[...], ...]\", one row a limit");
    const std::vector<YamlValue> rows = matrix.list();
    if (rows.size() > static_cast<size_t>(kMaxCouplings)) {
      matrix.refuse("at most " + std::to_string(kMaxCouplings) + " rows are supported");
    }
    const auto m = static_cast<Eigen::Index>(rows.size());
    JointLimits& limits = out_.limits;
    limits.coupling.resize(m, joints);
    limits.coupling_lower.resize(m);
    limits.coupling_upper.resize(m);
    const YamlValue lower_entry = map.at("lower", "\"lower: [...]\", one value a row");
    const YamlValue upper_entry = map.at("upper", "\"upper: [...]\", one value a row");
    const auto lower = lower_entry.numbers(static_cast<int>(m));
    const auto upper = upper_entry.numbers(static_cast<int>(m));
    for (Eigen::Index row = 0; row < m; ++row) {
      const auto k = static_cast<size_t>(row);
      const auto numbers = rows[k].numbers(joints);
      for (int i = 0; i < joints; ++i) limits.coupling(row, i) = numbers[static_cast<size_t>(i)];
      limits.coupling_lower[row] = lower[k] * angle_;
      limits.coupling_upper[row] = upper[k] * angle_;
      if (!(lower[k] < upper[k])) {
        lower_entry.refuse("row " + std::to_string(k + 1) + ": lower must be below upper", {},
                           ErrorCode::kBadLimits);
      }
    }
  }

  YamlMap top_;
  RobotDescription out_;
  Form form_ = Form::kAxes;
  double angle_ = 1.0;
  Pose link_ = Pose::Identity();  ///< what the last standard D-H row puts after its joint
};

}  // namespace

RobotDescription description_from_yaml(const std::string& text, const std::string& source) {
  try {
    const YamlDocuments documents = load_documents(text);
    const YAML::Node& root = documents.first;
    if (documents.count > 1) {
      Problem problem;
      problem.code = ErrorCode::kBadRobot;
      problem.message = "a second YAML document begins; a file holds one robot";
      problem.ways_out = {"put each robot into a file of its own",
                          "delete the \"---\" between them"};
      problem.file = source;
      problem.line = documents.second_line;
      throw MotionError(std::move(problem));
    }
    if (!root.IsDefined() || root.IsNull()) {
      Problem problem;
      problem.code = ErrorCode::kBadRobot;
      problem.message = "the file is empty; expected a robot: name, units, axes, joints";
      problem.ways_out = {"copy a built-in description and change it"};
      problem.file = source;
      throw MotionError(std::move(problem));
    }
    RobotDescription description = Reader(root, source).read();
    description.limits.validate();
    return description;
  } catch (const YAML::Exception& error) {
    Problem problem;
    problem.code = ErrorCode::kBadRobot;
    // yaml-cpp calls a file whose brackets are too deep for its own stack "bad".
    const bool deep = dynamic_cast<const YAML::DeepRecursion*>(&error) != nullptr;
    problem.message = "not YAML: " + (deep ? "brackets stand too deep in one another" : error.msg);
    problem.ways_out = {"check that the file was written whole and that brackets are closed"};
    problem.file = source;
    if (!error.mark.is_null()) problem.line = error.mark.line + 1;
    throw MotionError(std::move(problem));
  }
}

}  // namespace viapoint
