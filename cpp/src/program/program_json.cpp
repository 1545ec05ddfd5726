// The program as a JSON file. One step a line, so that files diff well.
#include <string>
#include <utility>

#include "program/curve_json.hpp"
#include "program/json_reader.hpp"
#include "program/strict_json.hpp"
#include "program/target_json.hpp"
#include "viapoint/core/atomic_file.hpp"
#include "viapoint/program/motion_program.hpp"

namespace viapoint {
namespace {

using program_json::circ_of;
using program_json::Json;
using program_json::json_of;
using program_json::Node;
using program_json::orientation_of;
using program_json::pose_of;
using program_json::spline_of;
using program_json::target_of;
using program_json::turn_of;
using program_json::value_of;
using program_json::Word;
using program_json::word_of;
using program_json::write;

constexpr int kFormat = 1;

constexpr Word<ZoneKind> kZones[] = {{ZoneKind::kRadius, "radius"},
                                     {ZoneKind::kDeviation, "deviation"},
                                     {ZoneKind::kJointDeviation, "joint_deviation"}};
constexpr Word<TimedSpace> kSpaces[] = {{TimedSpace::kJoint, "joint"},
                                        {TimedSpace::kCartesian, "cartesian"}};

struct StepWriter {
  Json& json;

  void operator()(const PtpMove& move) const { json["ptp"] = json_of(move.target); }
  void operator()(const LinMove& move) const {
    json["lin"] = json_of(move.target);
    json["orientation"] = word_of(move.orientation);
  }
  void operator()(const CircMove& move) const { write(json, move); }
  void operator()(const TurnMove& move) const { write(json, move); }
  void operator()(const SplineMove& move) const { write(json, move); }
  void operator()(const Wait& wait) const { json["wait"] = wait.seconds; }
  void operator()(const WaitInput& wait) const {
    json["wait_di"] = {{"index", wait.index}, {"value", wait.value}};
    if (wait.timeout) json["wait_di"]["timeout"] = *wait.timeout;
  }
  void operator()(const SetOutput& output) const {
    json["set_do"] = {{"index", output.index}, {"value", output.value}};
    if (output.distance != 0.0) json["set_do"]["distance"] = output.distance;
    if (output.time != 0.0) json["set_do"]["time"] = output.time;
  }
  void operator()(const SetFrame& step) const {
    json["set_frame"] = named(&step.pose_base_frame, step.name);
  }
  void operator()(const SetTool& step) const {
    json["set_tool"] = named(step.pose_flange_tool ? &*step.pose_flange_tool : nullptr, step.name);
  }
  void operator()(const TimedMove& move) const {
    Json points = Json::array();
    for (const TimedPoint& point : move.points) {
      Json json_point = json_of(point.target);
      json_point["seconds"] = point.seconds;
      points.push_back(json_point);
    }
    json["timed"] = {
        {"space", word_of(move.space, kSpaces)}, {"t_acc", move.t_acc}, {"points", points}};
  }

  static Json named(const Pose* pose, const std::string& name) {
    Json json = Json::object();
    if (!name.empty()) json["name"] = name;
    if (pose != nullptr) json["pose"] = json_of(*pose);
    return json;
  }
};

Json json_of(const Step& step) {
  Json json = Json::object();
  std::visit(StepWriter{json}, step.what);
  const MoveOptions& options = step.options;
  if (options.zone.kind != ZoneKind::kFine) {
    json["zone"] = {{word_of(options.zone.kind, kZones), options.zone.size}};
    if (options.zone.bounds_angle()) json["zone"]["angle"] = options.zone.angle;
  }
  if (options.speed) json["speed"] = *options.speed;
  if (options.acceleration) json["acceleration"] = *options.acceleration;
  if (options.angular_speed) json["angular_speed"] = *options.angular_speed;
  if (options.angular_acceleration) json["angular_acceleration"] = *options.angular_acceleration;
  if (options.process_speed) json["process_speed"] = *options.process_speed;
  if (options.scale) json["scale"] = *options.scale;
  if (!step.source.file.empty() || step.source.line != 0) {
    json["source"] = {{"file", step.source.file}, {"line", step.source.line}};
  }
  return json;
}

// ---- reading

TimedMove timed_of(const Node& node) {
  node.only({"space", "t_acc", "points"});
  TimedMove move;
  move.space = value_of(node.at("space"), kSpaces);
  move.t_acc = node.at("t_acc").number();
  const Node points = node.at("points");
  for (size_t i = 0; i < points.array_size(); ++i) {
    move.points.push_back({target_of(points.item(i), true), points.item(i).at("seconds").number()});
  }
  return move;
}

std::optional<double> wish(const Node& node, const char* key) {
  if (!node.has(key)) return std::nullopt;
  const double value = node.at(key).number();
  if (!(value > 0.0)) node.at(key).refuse("a number above zero");
  return value;
}

double number_or_zero(const Node& node, const char* key) {
  return node.has(key) ? node.at(key).number() : 0.0;
}

Zone zone_of(const Node& node) {
  node.require_object();
  for (const auto& word : kZones) {
    if (!node.has(word.text)) continue;
    node.only({word.text, "angle"});
    const double size = node.at(word.text).number();
    if (size < 0.0) node.at(word.text).refuse("a size of zero or more");
    Zone zone{word.value, size};
    if (const auto angle = wish(node, "angle")) zone.angle = *angle;
    return zone;
  }
  node.refuse(
      "{\"radius\": m}, {\"deviation\": m} or {\"joint_deviation\": rad}, each with an \"angle\" "
      "[rad] or without");
}

std::optional<Pose> pose_in(const Node& node) {
  node.only({"name", "pose"});
  if (!node.has("pose")) return std::nullopt;
  return pose_of(node.at("pose"));
}

std::string name_in(const Node& node) { return node.has("name") ? node.at("name").text() : ""; }

/// A step is one thing: what says two would have one of them ignored.
void require_one_kind(const Node& node) {
  int kinds = 0;
  for (const char* kind : {"ptp", "lin", "circ", "turn", "spline", "wait", "wait_di", "set_do",
                           "timed", "set_frame", "set_tool"}) {
    kinds += node.has(kind) ? 1 : 0;
  }
  if (kinds != 1) {
    node.refuse(
        "exactly one of ptp, lin, circ, turn, spline, wait, wait_di, set_do, timed, set_frame, "
        "set_tool");
  }
  const bool cartesian =
      node.has("lin") || node.has("circ") || node.has("turn") || node.has("spline");
  if (node.has("orientation") && !cartesian) {
    node.at("orientation").refuse("no orientation but on a lin, circ, turn or spline");
  }
  if (node.has("via") && !node.has("circ")) node.at("via").refuse("no via but on a circ");
  if (!node.has("ptp") && !cartesian) {
    for (const char* wish : {"zone", "speed", "acceleration", "angular_speed",
                             "angular_acceleration", "process_speed", "scale"}) {
      if (node.has(wish)) node.at(wish).refuse(std::string("no ") + wish + " but on a move");
    }
  }
}

Step step_of(const Node& node) {
  node.only(
      {"ptp",           "lin",   "circ",    "via",          "turn",          "spline",
       "orientation",   "wait",  "wait_di", "set_do",       "timed",         "set_frame",
       "set_tool",      "zone",  "speed",   "acceleration", "angular_speed", "angular_acceleration",
       "process_speed", "scale", "source"});
  require_one_kind(node);
  Step step;
  if (node.has("ptp")) {
    step.what = PtpMove{target_of(node.at("ptp"))};
  } else if (node.has("lin")) {
    step.what = LinMove{target_of(node.at("lin")), orientation_of(node.at("orientation"))};
  } else if (node.has("circ")) {
    step.what = circ_of(node);
  } else if (node.has("turn")) {
    step.what = turn_of(node);
  } else if (node.has("spline")) {
    step.what = spline_of(node);
  } else if (node.has("wait")) {
    step.what = Wait{node.at("wait").number()};
  } else if (node.has("wait_di")) {
    const Node wait = node.at("wait_di");
    wait.only({"index", "value", "timeout"});
    step.what =
        WaitInput{wait.at("index").integer(), wait.at("value").boolean(), wish(wait, "timeout")};
  } else if (node.has("set_do")) {
    const Node output = node.at("set_do");
    output.only({"index", "value", "distance", "time"});
    step.what = SetOutput{output.at("index").integer(), output.at("value").boolean(),
                          number_or_zero(output, "distance"), number_or_zero(output, "time")};
  } else if (node.has("set_frame")) {
    const Node frame = node.at("set_frame");
    step.what = SetFrame{pose_in(frame).value_or(Pose::Identity()), name_in(frame)};
  } else if (node.has("set_tool")) {
    const Node tool = node.at("set_tool");
    step.what = SetTool{pose_in(tool), name_in(tool)};
  } else {
    step.what = timed_of(node.at("timed"));
  }
  if (node.has("zone")) step.options.zone = zone_of(node.at("zone"));
  step.options.speed = wish(node, "speed");
  step.options.acceleration = wish(node, "acceleration");
  step.options.angular_speed = wish(node, "angular_speed");
  step.options.angular_acceleration = wish(node, "angular_acceleration");
  step.options.process_speed = wish(node, "process_speed");
  step.options.scale = wish(node, "scale");
  if (node.has("source")) {
    const Node source = node.at("source");
    source.only({"file", "line"});
    step.source = {source.at("file").text(), source.at("line").integer()};
  }
  return step;
}

}  // namespace

std::string to_json(const MotionProgram& program) {
  const Json robot = {{"name", program.robot}, {"fingerprint", program.robot_fingerprint}};
  const Json tolerance = {{"position", program.tolerance.position},
                          {"angle", program.tolerance.angle}};
  std::string text = "{\n \"viapoint_program\": " + std::to_string(kFormat) +
                     ",\n \"robot\": " + robot.dump() +
                     ",\n \"start\": " + json_of(program.start).dump() +
                     ",\n \"tolerance\": " + tolerance.dump() + ",\n \"steps\": [";
  const char* separator = "\n  ";
  for (const Step& step : program.steps) {
    text += separator + json_of(step).dump();
    separator = ",\n  ";
  }
  return text + "\n ]\n}\n";
}

MotionProgram program_from_json(const std::string& text, const std::string& source) {
  const Json json = program_json::parse_strictly(text, source);
  const Node root(json, "", source);
  root.only({"viapoint_program", "robot", "start", "tolerance", "steps"});
  if (root.at("viapoint_program").integer() != kFormat) {
    root.at("viapoint_program").refuse("format " + std::to_string(kFormat));
  }
  const Node robot = root.at("robot");
  robot.only({"name", "fingerprint"});
  MotionProgram program;
  program.robot = robot.at("name").text();
  program.robot_fingerprint = robot.at("fingerprint").text();
  program.start = root.at("start").joint_vector();
  if (root.has("tolerance")) {
    const Node tolerance = root.at("tolerance");
    tolerance.only({"position", "angle"});
    program.tolerance = {tolerance.at("position").number(), tolerance.at("angle").number()};
  }
  const Node steps = root.at("steps");
  for (size_t i = 0; i < steps.array_size(); ++i) program.steps.push_back(step_of(steps.item(i)));
  return program;
}

void save_program(const MotionProgram& program, const std::string& path) {
  write_file_atomically(path, to_json(program));
}

MotionProgram load_program(const std::string& path) {
  return program_from_json(read_file(path), path);
}

}  // namespace viapoint
