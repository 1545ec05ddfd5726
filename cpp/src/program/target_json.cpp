#include "program/target_json.hpp"

namespace viapoint::program_json {
namespace {

constexpr Word<Orientation> kOrientations[] = {
    {Orientation::kLeast, "least"},     {Orientation::kWrist, "wrist"},
    {Orientation::kFixed, "fixed"},     {Orientation::kTangent, "tangent"},
    {Orientation::kThrough, "through"}, {Orientation::kSpin, "spin"},
    {Orientation::kFree, "free"}};

}  // namespace

Pose pose_of(const Node& node) {
  if (node.array_size() != 4) node.refuse("four rows of four numbers");
  Eigen::Matrix4d matrix;
  for (size_t row = 0; row < 4; ++row) {
    const Node json_row = node.item(row);
    if (json_row.array_size() != 4) json_row.refuse("four numbers");
    for (size_t column = 0; column < 4; ++column) {
      matrix(static_cast<int>(row), static_cast<int>(column)) = json_row.item(column).number();
    }
  }
  try {
    return checked_pose(matrix).pose;
  } catch (const MotionError& error) {
    node.refuse("a pose; " + error.problem().message);
  }
}

Json json_of(const Eigen::Vector3d& vector) {
  return std::vector<double>(vector.begin(), vector.end());
}

Json json_of(const JointVector& q) { return std::vector<double>(q.begin(), q.end()); }

Json json_of(const Pose& pose) {
  Json rows = Json::array();
  for (int row = 0; row < 4; ++row) {
    const Eigen::RowVector4d values = pose.matrix().row(row);
    rows.push_back(std::vector<double>(values.begin(), values.end()));
  }
  return rows;
}

Json json_of(const Target& target) {
  Json json = Json::object();
  if (const auto* joints = std::get_if<JointTarget>(&target)) {
    json["joints"] = json_of(joints->q);
  } else if (const auto* pose = std::get_if<PoseTarget>(&target)) {
    json["pose"] = json_of(pose->pose_base_tool);
    if (pose->correction != 0.0) json["correction"] = pose->correction;
  } else {
    const Eigen::Vector3d& p = std::get<PositionTarget>(target).position;
    json["position"] = json_of(p);
  }
  return json;
}

const char* word_of(Orientation orientation) { return word_of(orientation, kOrientations); }

Orientation orientation_of(const Node& node) { return value_of(node, kOrientations); }

Eigen::Vector3d vector_of(const Node& node) {
  if (node.array_size() != 3) node.refuse("three numbers");
  return {node.item(0).number(), node.item(1).number(), node.item(2).number()};
}

Target target_of(const Node& node, bool timed) {
  if (timed) {
    node.only({"joints", "pose", "position", "correction", "seconds"});
  } else {
    node.only({"joints", "pose", "position", "correction"});
  }
  const int kinds = static_cast<int>(node.has("joints")) + static_cast<int>(node.has("pose")) +
                    static_cast<int>(node.has("position"));
  if (kinds != 1) node.refuse("one of \"joints\", \"pose\" and \"position\"");
  if (node.has("correction") && !node.has("pose")) {
    node.at("correction").refuse("no correction but of a pose");
  }
  if (node.has("joints")) return JointTarget{node.at("joints").joint_vector()};
  if (node.has("pose")) {
    PoseTarget target{pose_of(node.at("pose"))};
    if (node.has("correction")) target.correction = node.at("correction").number();
    return target;
  }
  return PositionTarget{vector_of(node.at("position"))};
}

}  // namespace viapoint::program_json
