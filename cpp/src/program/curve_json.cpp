#include "program/curve_json.hpp"

#include "program/target_json.hpp"

namespace viapoint::program_json {
namespace {

constexpr Word<SplineKind> kKinds[] = {{SplineKind::kCubic, "cubic"},
                                       {SplineKind::kQuintic, "quintic"},
                                       {SplineKind::kBezier, "bezier"},
                                       {SplineKind::kBSpline, "b_spline"}};
constexpr Word<SplineSpace> kSpaces[] = {{SplineSpace::kTool, "tool"},
                                         {SplineSpace::kJoint, "joint"}};

}  // namespace

void write(Json& step, const CircMove& move) {
  step["circ"] = json_of(move.target);
  step["via"] = json_of(move.via);
  step["orientation"] = word_of(move.orientation);
}

void write(Json& step, const TurnMove& move) {
  Json json = Json::object();
  if (move.center) json["center"] = json_of(*move.center);
  if (move.axis) json["axis"] = json_of(*move.axis);
  json["angle"] = move.angle;
  json["pitch"] = move.pitch;
  step["turn"] = json;
  step["orientation"] = word_of(move.orientation);
}

void write(Json& step, const SplineMove& move) {
  Json points = Json::array();
  for (const Target& point : move.points) points.push_back(json_of(point));
  Json json = {{"kind", word_of(move.kind, kKinds)}, {"space", word_of(move.space, kSpaces)}};
  if (move.start) json["start"] = json_of(*move.start);
  json["points"] = points;
  if (!move.at.empty()) json["at"] = move.at;
  step["spline"] = json;
  step["orientation"] = word_of(move.orientation);
}

CircMove circ_of(const Node& step) {
  return {target_of(step.at("via")), target_of(step.at("circ")),
          orientation_of(step.at("orientation"))};
}

TurnMove turn_of(const Node& step) {
  const Node node = step.at("turn");
  node.only({"center", "axis", "angle", "pitch"});
  TurnMove move;
  if (node.has("center")) move.center = vector_of(node.at("center"));
  if (node.has("axis")) move.axis = vector_of(node.at("axis"));
  move.angle = node.at("angle").number();
  if (node.has("pitch")) move.pitch = node.at("pitch").number();
  move.orientation = orientation_of(step.at("orientation"));
  return move;
}

SplineMove spline_of(const Node& step) {
  const Node node = step.at("spline");
  node.only({"kind", "space", "start", "points", "at"});
  SplineMove move;
  move.kind = value_of(node.at("kind"), kKinds);
  move.space = value_of(node.at("space"), kSpaces);
  if (node.has("start")) move.start = target_of(node.at("start"));
  const Node points = node.at("points");
  for (size_t i = 0; i < points.array_size(); ++i) {
    move.points.push_back(target_of(points.item(i)));
  }
  if (node.has("at")) {
    const Node at = node.at("at");
    for (size_t i = 0; i < at.array_size(); ++i) move.at.push_back(at.item(i).number());
  }
  move.orientation = orientation_of(step.at("orientation"));
  return move;
}

}  // namespace viapoint::program_json
