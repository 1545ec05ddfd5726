#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>
#include <string>

#include "problem_count.hpp"
#include "viapoint/core/atomic_file.hpp"
#include "viapoint/program/motion_program.hpp"

namespace viapoint {
namespace {

JointVector random_joints(std::mt19937& random, int joints) {
  std::uniform_real_distribution<double> uniform(-3.0, 3.0);
  JointVector q(joints);
  for (double& value : q) value = uniform(random);
  return q;
}

Pose random_pose(std::mt19937& random) {
  std::normal_distribution<double> normal;
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
                      .normalized()
                      .toRotationMatrix();
  pose.translation() << normal(random), normal(random), normal(random);
  return pose;
}

Target random_target(std::mt19937& random, int joints) {
  std::normal_distribution<double> normal;
  const Eigen::Vector3d p(normal(random), normal(random), normal(random));
  switch (random() % 3) {
    case 0:
      return JointTarget{random_joints(random, joints)};
    case 1: {
      PoseTarget target{Pose::Identity()};
      target.pose_base_tool.linear() =
          Eigen::Quaterniond(normal(random), p.x(), p.y(), p.z()).normalized().toRotationMatrix();
      target.pose_base_tool.translation() = p;
      if (random() % 2 == 0) target.correction = 0.004 * std::abs(normal(random));
      return target;
    }
    default:
      return PositionTarget{p};
  }
}

TurnMove random_turn(std::mt19937& random) {
  std::normal_distribution<double> normal;
  TurnMove move;
  if (random() % 2 == 0) move.center = Eigen::Vector3d(normal(random), 0.1, -0.0);
  if (random() % 2 == 0) move.axis = Eigen::Vector3d(0.0, normal(random), 1e-300);
  move.angle = 10.0 * normal(random);
  move.pitch = 0.01 * normal(random);
  move.orientation = static_cast<Orientation>(random() % 6);
  return move;
}

SplineMove random_spline(std::mt19937& random, int joints) {
  SplineMove move;
  for (size_t k = 1 + random() % 5; k > 0; --k) {
    move.points.push_back(random_target(random, joints));
  }
  move.kind = static_cast<SplineKind>(random() % 4);
  move.space = random() % 2 == 0 ? SplineSpace::kTool : SplineSpace::kJoint;
  move.orientation = static_cast<Orientation>(random() % 6);
  if (random() % 2 == 0) move.start = random_target(random, joints);
  for (size_t k = random() % 2 == 0 ? move.points.size() + 1 : 0; k > 0; --k) {
    move.at.push_back(std::sqrt(static_cast<double>(random() % 1000)));
  }
  return move;
}

SetOutput random_output(std::mt19937& random) {
  SetOutput output{static_cast<int>(random() % 64), random() % 2 == 0};
  if (random() % 2 == 0) output.distance = -0.1 / 3.0;
  if (random() % 2 == 0) output.time = 0.1 / 7.0;
  return output;
}

WaitInput random_wait(std::mt19937& random) {
  WaitInput wait{static_cast<int>(random() % 64), random() % 2 == 0, std::nullopt};
  if (random() % 2 == 0) wait.timeout = 1.0 / 3.0;
  return wait;
}

MotionProgram random_program(std::mt19937& random) {
  MotionProgram program;
  const int joints = 1 + static_cast<int>(random() % 7);
  program.robot = "arm \"quoted\"";
  program.robot_fingerprint = "00ff";
  program.tolerance = {1e-4 / 3.0, 1e-3 / 7.0};
  program.start = random_joints(random, joints);
  const size_t steps = 1 + random() % 8;
  for (size_t i = 0; i < steps; ++i) {
    Step step;
    switch (random() % 11) {
      case 10:
        step.what = random_wait(random);
        break;
      case 8:
        step.what = SetFrame{random_pose(random), random() % 2 == 0 ? "table \"3\"" : ""};
        break;
      case 9: {
        SetTool tool;
        if (random() % 2 == 0) tool = {random_pose(random), "gripper"};
        step.what = tool;
        break;
      }
      case 5:
        step.what = CircMove{random_target(random, joints), random_target(random, joints),
                             static_cast<Orientation>(random() % 6)};
        break;
      case 6:
        step.what = random_turn(random);
        break;
      case 7:
        step.what = random_spline(random, joints);
        break;
      case 0:
        step.what = PtpMove{random_target(random, joints)};
        break;
      case 1:
        step.what = LinMove{random_target(random, joints), static_cast<Orientation>(random() % 6)};
        break;
      case 2:
        step.what = Wait{0.1 * static_cast<double>(random() % 10)};
        break;
      case 3:
        step.what = random_output(random);
        break;
      default:
        step.what = TimedMove{
            {{random_target(random, joints), 0.0}, {random_target(random, joints), 0.1 / 3.0}},
            1.0 / 7.0,
            static_cast<TimedSpace>(random() % 2)};
    }
    const bool moves = !std::holds_alternative<Wait>(step.what) &&
                       !std::holds_alternative<WaitInput>(step.what) &&
                       !std::holds_alternative<SetOutput>(step.what) &&
                       !std::holds_alternative<SetFrame>(step.what) &&
                       !std::holds_alternative<SetTool>(step.what) &&
                       !std::holds_alternative<TimedMove>(step.what);
    if (random() % 2 == 0) step.source = {"cell/α.py", 1 + static_cast<int>(random() % 99)};
    if (!moves) {
      program.steps.push_back(step);
      continue;
    }
    if (random() % 2 == 0) step.options.speed = 0.1 / 3.0;
    if (random() % 2 == 0) step.options.acceleration = 1.0 / 7.0;
    if (random() % 2 == 0) step.options.angular_speed = 2.0 / 7.0;
    if (random() % 2 == 0) step.options.angular_acceleration = 3.0 / 7.0;
    if (random() % 2 == 0) step.options.process_speed = 4.0 / 7.0;
    if (random() % 2 == 0) step.options.scale = 1.0 / 3.0;
    step.options.zone = {static_cast<ZoneKind>(random() % 4), 0.0};
    if (step.options.zone.kind != ZoneKind::kFine) step.options.zone.size = 0.1 / 7.0;
    program.steps.push_back(step);
  }
  return program;
}

std::string message_of(const std::string& text) {
  try {
    (void)program_from_json(text, "cell.json");
  } catch (const MotionError& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadProgram);
    EXPECT_EQ(error.problem().file, "cell.json");
    return error.problem().message;
  }
  ADD_FAILURE() << "accepted: " << text;
  return "";
}

TEST(ProgramJson, ReadsBackToTheLastBit) {
  for (unsigned seed = 0; seed < problems(2000U); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const MotionProgram program = random_program(random);
    const std::string text = to_json(program);
    const MotionProgram back = program_from_json(text, "test");
    // Text holds every number in its shortest exact form, so equal text means equal programs.
    ASSERT_EQ(to_json(back), text);
    ASSERT_EQ(back.start, program.start);
    ASSERT_EQ(back.tolerance.position, program.tolerance.position);
    ASSERT_EQ(back.tolerance.angle, program.tolerance.angle);
    ASSERT_EQ(back.steps.size(), program.steps.size());
    for (size_t i = 0; i < program.steps.size(); ++i) {
      ASSERT_EQ(back.steps[i].what.index(), program.steps[i].what.index());
      ASSERT_EQ(back.steps[i].options.speed, program.steps[i].options.speed);
      ASSERT_EQ(back.steps[i].options.zone, program.steps[i].options.zone);
      ASSERT_EQ(back.steps[i].source.line, program.steps[i].source.line);
    }
  }
}

TEST(ProgramJson, RefusesEveryTruncation) {
  std::mt19937 random(3);
  const std::string text = to_json(random_program(random));
  // The last character is the newline behind the closing brace.
  for (size_t length = 0; length + 2 < text.size(); ++length) {
    EXPECT_THROW((void)program_from_json(text.substr(0, length), "cut"), MotionError) << length;
  }
}

constexpr const char* kHead =
    R"({"viapoint_program": 1, "robot": {"name": "a", "fingerprint": ""}, "start": [0, 0], "steps": [)";

TEST(ProgramJson, NamesThePlaceAndWhatWasExpected) {
  EXPECT_NE(message_of(std::string(kHead) + R"({"ptp": {"joints": [0, "x"]}}]})")
                .find("steps[0].ptp.joints[1]: expected a number, got \"x\""),
            std::string::npos);
  EXPECT_NE(message_of(std::string(kHead) + R"({"ptp": {"joints": [0]}, "sped": 1}]})")
                .find("no member \"sped\""),
            std::string::npos);
  EXPECT_NE(message_of(std::string(kHead) + R"({"fly": 1}]})").find("no member \"fly\""),
            std::string::npos);
  EXPECT_NE(
      message_of(std::string(kHead) + R"({"lin": {"pose": [[1,0,0,0]]}, "orientation": "least"}]})")
          .find("four rows"),
      std::string::npos);
  EXPECT_NE(message_of(std::string(kHead) +
                       R"({"lin": {"position": [1,0,0]}, "orientation": "sideways"}]})")
                .find("one of least, wrist, fixed"),
            std::string::npos);
  EXPECT_NE(message_of(std::string(kHead) + R"({"ptp": {"joints": [0]}, "scale": 0}]})")
                .find("above zero"),
            std::string::npos);
  EXPECT_NE(message_of(R"({"viapoint_program": 2, "robot": {}, "start": [], "steps": []})")
                .find("format 1"),
            std::string::npos);
  EXPECT_NE(message_of("[]").find("expected an object"), std::string::npos);
}

TEST(ProgramJson, RefusesWhatItWouldOtherwiseIgnore) {
  const auto message = [](const std::string& step) {
    return message_of(std::string(kHead) + step + "]}");
  };
  EXPECT_NE(message(R"({"ptp": {"joints": [0]}, "wait": 1})").find("exactly one of"),
            std::string::npos);
  EXPECT_NE(message("{}").find("exactly one of"), std::string::npos);
  EXPECT_NE(message(R"({"ptp": {"joints": [0]}, "orientation": "least"})").find("orientation"),
            std::string::npos);
  EXPECT_NE(message(R"({"ptp": {"joints": [0]}, "via": {"joints": [0]}})").find("no via"),
            std::string::npos);
  EXPECT_NE(
      message(R"({"turn": {"angle": 1, "radius": 2}, "orientation": "fixed"})").find("\"radius\""),
      std::string::npos);
  EXPECT_NE(message(R"({"spline": {"kind": "round", "space": "tool", "points": []},
                        "orientation": "through"})")
                .find("one of cubic, quintic, bezier, b_spline"),
            std::string::npos);
  EXPECT_NE(message(R"({"wait": 1, "speed": 1})").find("no speed"), std::string::npos);
  EXPECT_NE(message(R"({"wait_di": {"index": 1, "value": true, "timeout": 0}})").find("above zero"),
            std::string::npos);
  EXPECT_NE(message(R"({"set_do": {"index": 1, "value": true, "way": 1}})").find("no member"),
            std::string::npos);
  EXPECT_NE(message(R"({"ptp": {"joints": [0], "seconds": 1}})").find("no member \"seconds\""),
            std::string::npos);
  EXPECT_NE(message(R"({"wait": 1e400})").find("too large"), std::string::npos);
}

TEST(ProgramJson, RefusesEndlessBracketsByName) {
  for (const char* bracket : {"[", "{\"a\":"}) {
    std::string text;
    for (int i = 0; i < problems(100'000); ++i) text += bracket;
    EXPECT_NE(message_of(text).find("64 deep"), std::string::npos);
  }
  EXPECT_NE(message_of(std::string(100'000, '[') + std::string(100'000, ']')).find("64 deep"),
            std::string::npos);
  // At the bound, the value is read and shown whole or in part.
  const std::string deep = std::string(60, '[') + std::string(60, ']');
  EXPECT_NE(message_of(std::string(kHead) + deep + "]}").find("steps[0]: expected an object"),
            std::string::npos);
}

TEST(ProgramJson, RefusesAMemberThatIsThereTwiceByItsPlace) {
  EXPECT_NE(
      message_of(std::string(kHead) + R"({"wait": 1}], "steps": []})").find("member \"steps\" is"),
      std::string::npos);
  const std::string message = message_of(
      std::string(kHead) + R"({"wait": 1}, {"ptp": {"joints": [0, 0], "joints": [1, 1]}}]})");
  EXPECT_NE(message.find("steps[1].ptp: member \"joints\" is there twice"), std::string::npos)
      << message;
}

TEST(ProgramJson, RefusesATargetOfTwoKinds) {
  for (const char* other : {R"("position": [0, 0, 0])", R"("pose": [])"}) {
    EXPECT_NE(message_of(std::string(kHead) + R"({"ptp": {"joints": [0, 0], )" + other + "}}]}")
                  .find("expected one of \"joints\", \"pose\" and \"position\""),
              std::string::npos);
  }
  EXPECT_NE(message_of(std::string(kHead) + R"({"ptp": {"joints": [0, 0], "correction": 0.1}}]})")
                .find("no correction but of a pose"),
            std::string::npos);
}

TEST(ProgramJson, CutsALongTextBetweenCharacters) {
  for (int length = 50; length < 60; ++length) {
    std::string text(static_cast<size_t>(length), 'x');
    for (int i = 0; i < 20; ++i) text += "é";
    const std::string message = message_of(R"({"viapoint_program": 1, "robot": ")" + text +
                                           R"(", "start": [], "steps": []})");
    // No half of a character before the dots: an é is 0xC3 0xA9.
    const size_t dots = message.rfind("…");
    ASSERT_NE(dots, std::string::npos) << message;
    EXPECT_NE(static_cast<unsigned char>(message[dots - 1]), 0xC3U) << length;
  }
}

TEST(ProgramJson, TellsAWayOutOfEveryFault) {
  for (const std::string& text : {std::string("{"), std::string(100, '['), std::string("[1e999]"),
                                  std::string(R"({"a": 1, "a": 2})"), std::string("{}")}) {
    try {
      (void)program_from_json(text, "cell.json");
      ADD_FAILURE() << "accepted: " << text;
    } catch (const MotionError& error) {
      EXPECT_FALSE(error.problem().ways_out.empty()) << error.what();
    }
  }
}

TEST(ProgramJson, RefusesAPoseThatIsNoRotation) {
  const std::string message = message_of(
      std::string(kHead) +
      R"({"ptp": {"pose": [[0.41,0.29,0.87,0.6],[0.69,0.71,-0.09,0.15],[-0.6,0.64,0.49,-0.3],[0,0,0,1]]}}]})");
  EXPECT_NE(message.find("columns 2 and 3"), std::string::npos) << message;
}

TEST(ProgramJson, ReportsAMissingFile) {
  EXPECT_THROW((void)load_program("/nonexistent/program.json"), MotionError);
}

}  // namespace
}  // namespace viapoint
