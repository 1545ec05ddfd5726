#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "kinematics/arms.hpp"
#include "viapoint/core/atomic_file.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/core/units.hpp"

namespace viapoint {
namespace {

/// A good file of two joints; tests break it in one place.
const char* const kGood =
    "name: pair\n"                                                                // line 1
    "units: {angle: deg}\n"                                                       // 2
    "axes: 2\n"                                                                   // 3
    "dh: standard\n"                                                              // 4
    "joints:\n"                                                                   // 5
    "  - {name: one, d: 0, a: 1, alpha: 0, position: [-90, 90], velocity: 100, "  // 6
    "acceleration: 1000, jerk: 10000}\n"
    "  - {name: two, type: prismatic, d: 0, a: 2, alpha: 0, position: [0, 1], "  // 7
    "velocity: 1, acceleration: 10, jerk: 100}\n";

std::string with(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

Problem problem_of(const std::string& yaml) {
  try {
    (void)description_from_yaml(yaml, "pair.yaml");
  } catch (const MotionError& error) {
    EXPECT_EQ(error.problem().file, "pair.yaml");
    return error.problem();
  }
  ADD_FAILURE() << "accepted:\n" << yaml;
  return {};
}

bool says(const Problem& problem, const std::string& text) {
  return problem.describe().find(text) != std::string::npos;
}

void expect_same_bits(const RobotDescription& a, const RobotDescription& b) {
  ASSERT_EQ(a.chain.size(), b.chain.size());
  for (size_t i = 0; i < a.chain.size(); ++i) {
    EXPECT_EQ(a.chain[i].type, b.chain[i].type);
    EXPECT_TRUE(a.chain[i].before.matrix() == b.chain[i].before.matrix());
    EXPECT_TRUE(a.chain[i].axis == b.chain[i].axis);
  }
  EXPECT_TRUE(a.flange.matrix() == b.flange.matrix());
  EXPECT_TRUE(a.tool.matrix() == b.tool.matrix());
  EXPECT_TRUE(a.limits.position_min == b.limits.position_min);
  EXPECT_TRUE(a.limits.position_max == b.limits.position_max);
  EXPECT_TRUE(a.limits.velocity == b.limits.velocity);
  EXPECT_TRUE(a.limits.acceleration == b.limits.acceleration);
  EXPECT_TRUE(a.limits.jerk == b.limits.jerk);
  EXPECT_TRUE(a.limits.coupling == b.limits.coupling);
  EXPECT_TRUE(a.limits.coupling_lower == b.limits.coupling_lower);
  EXPECT_TRUE(a.limits.coupling_upper == b.limits.coupling_upper);
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.title, b.title);
  EXPECT_EQ(a.joint_names, b.joint_names);
  EXPECT_EQ(a.sources, b.sources);
  EXPECT_EQ(a.chosen, b.chosen);
}

TEST(YamlDescription, ReadsDegreesAndMetres) {
  const RobotDescription robot = description_from_yaml(kGood, "pair.yaml");
  EXPECT_EQ(robot.name, "pair");
  EXPECT_EQ(robot.limits.position_max[0], 90.0 * kDegree);
  EXPECT_EQ(robot.limits.jerk[0], 10000.0 * kDegree);
  EXPECT_EQ(robot.limits.position_max[1], 1.0);
  EXPECT_EQ(robot.limits.velocity[1], 1.0);
  EXPECT_EQ(robot.chain[1].type, JointType::kPrismatic);
}

TEST(YamlDescription, ReadsRadiansAsTheyAre) {
  const auto robot = description_from_yaml(with(kGood, "deg", "rad"), "pair.yaml");
  EXPECT_EQ(robot.limits.position_max[0], 90.0);
}

TEST(YamlDescription, StandardAndModifiedTablesOfOneArmAgree) {
  // A planar arm has a over the joint in one convention, before it in the other.
  const std::string tail = "position: [-180, 180], velocity: 1, acceleration: 1, jerk: 1}\n";
  const std::string head = "name: x\nunits: {angle: deg}\naxes: 2\n";
  const auto standard = RobotModel::make(description_from_yaml(
      head + "dh: standard\njoints:\n  - {name: a, d: 0.3, a: 0.5, alpha: 90, theta: 20, " + tail +
          "  - {name: b, d: 0.1, a: 0.7, alpha: 0, " + tail,
      "standard"));
  const auto modified = RobotModel::make(
      description_from_yaml(head +
                                "dh: modified\nflange: {xyz: [0.7, 0, 0]}\njoints:\n"
                                "  - {name: a, d: 0.3, a: 0, alpha: 0, theta: 20, " +
                                tail + "  - {name: b, d: 0.1, a: 0.5, alpha: 90, " + tail,
                            "modified"));
  std::mt19937_64 generator(31);
  for (int problem = 0; problem < 100; ++problem) {
    const JointVector q = random_joints(*standard, generator);
    ASSERT_LT(pose_distance(standard->fk(q), modified->fk(q)), 1e-14);
  }
}

TEST(YamlDescription, AxisFormAgreesWithTheTable) {
  const auto axes = RobotModel::make(description_from_yaml(
      "name: x\nunits: {angle: deg}\naxes: 2\ntool: {xyz: [2, 0, 0], rpy: [0, 0, 0]}\njoints:\n"
      "  - {name: a, axis: [0, 0, 2], position: [-180, 180], velocity: 180, acceleration: 1, jerk: "
      "1}\n"
      "  - {name: b, origin: {xyz: [1, 0, 0], rpy: [180, 0, 0]}, axis: [0, 0, -1], position: "
      "[-180, 180], velocity: 180, acceleration: 1, jerk: 1}\n",
      "axes"));
  const RobotPtr table = arm("two_link");
  std::mt19937_64 generator(32);
  for (int problem = 0; problem < 100; ++problem) {
    const JointVector q = random_joints(*table, generator);
    ASSERT_LT((axes->fk(q).translation() - table->fk(q).translation()).norm(), 1e-14);
  }
}

TEST(YamlDescription, ReadsRollPitchYawAboutFixedAxes) {
  const auto robot = description_from_yaml(
      "name: x\nunits: {angle: rad}\naxes: 1\ntool: {rpy: [0.1, 0.2, 0.3]}\njoints:\n"
      "  - {name: a, axis: [0, 0, 1], position: [-1, 1], velocity: 1, acceleration: 1, jerk: 1}\n",
      "rpy");
  const Eigen::Matrix3d expected = (Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()) *
                                    Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY()) *
                                    Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX()))
                                       .toRotationMatrix();
  EXPECT_LT((robot.tool.linear() - expected).norm(), 1e-15);
}

TEST(YamlDescription, RoundTripsToTheLastBit) {
  for (const char* name : kArms) {
    SCOPED_TRACE(name);
    const RobotDescription first = arm(name)->description();
    const RobotDescription second = description_from_yaml(to_yaml(first), "again");
    expect_same_bits(first, second);
    EXPECT_EQ(RobotModel::make(second)->fingerprint(), RobotModel::make(first)->fingerprint());
    EXPECT_EQ(to_yaml(second), to_yaml(first));
  }
}

TEST(YamlDescription, RoundTripsWhateverThereIs) {
  std::mt19937_64 generator(33);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int problem = 0; problem < 200; ++problem) {
    SCOPED_TRACE(problem);
    RobotDescription robot = arm("panda")->description();
    robot.title = "quotes \" and \\ and: {braces} #\nand two lines\tand tabs";
    robot.chosen = {"- a dash", "", "ünïcode"};
    for (ChainJoint& joint : robot.chain) {
      joint.axis = Eigen::Vector3d(unit(generator), unit(generator), unit(generator)).normalized();
      joint.before.linear() =
          rotation_exp(3.0 * Eigen::Vector3d(unit(generator), unit(generator), unit(generator)));
      joint.before.translation().setConstant(unit(generator) * 1e-7);
    }
    robot.limits.position_max[2] = std::numeric_limits<double>::infinity();
    robot.limits.position_min[2] = -std::numeric_limits<double>::infinity();
    robot.limits.coupling.resize(2, 7);
    for (int i = 0; i < 7; ++i) {
      robot.limits.coupling(0, i) = unit(generator);
      robot.limits.coupling(1, i) = unit(generator) * 1e-300;
    }
    robot.limits.coupling_lower = Eigen::Vector2d(-1.0 / 3.0, -2.0);
    robot.limits.coupling_upper = Eigen::Vector2d(1.0 / 3.0, 1e22);
    ASSERT_NO_FATAL_FAILURE(
        expect_same_bits(robot, description_from_yaml(to_yaml(robot), "again")));
  }
}

TEST(YamlDescription, KeepsAJointRobot) {
  const RobotPtr robot = RobotModel::joint_robot(arm("panda")->limits());
  const RobotDescription again = description_from_yaml(to_yaml(robot->description()), "again");
  EXPECT_TRUE(again.chain.empty());
  EXPECT_EQ(RobotModel::make(again)->fingerprint(), robot->fingerprint());
}

TEST(YamlDescription, RefusesAFileCutShortAnywhere) {
  for (const std::string& text : {std::string(kGood), to_yaml(arm("puma560")->description()),
                                  read_file(VIAPOINT_TEST_ROBOTS "/panda.yaml")}) {
    const size_t last = text.find_last_not_of('\n');
    for (size_t size = 0; size <= last; ++size) {
      const Problem problem = problem_of(text.substr(0, size));
      ASSERT_TRUE(problem.code == ErrorCode::kBadRobot || problem.code == ErrorCode::kBadLimits)
          << "cut at " << size;
    }
  }
}

TEST(YamlDescription, RefusesWhatACutFileWouldLoseUnseen) {
  // Behind the joints, and in joints without braces, a cut at a line's end leaves a whole robot.
  for (const char* behind : {"tool: {xyz: [0, 0, 0.1]}\n", "title: late\n",
                             "coupling: {matrix: [[1, 0]], lower: [-1], upper: [1]}\n"}) {
    const Problem problem = problem_of(std::string(kGood) + behind);
    EXPECT_TRUE(says(problem, "behind the joints")) << problem.describe();
    EXPECT_EQ(problem.line, 8) << problem.describe();
    EXPECT_TRUE(says(problem, "move it above")) << problem.describe();
  }
  const Problem open = problem_of(
      "name: one\nunits: {angle: rad}\naxes: 1\njoints:\n  - name: a\n    axis: [0, 0, 1]\n"
      "    position: [-1, 1]\n    velocity: 1\n    acceleration: 1\n    jerk: 10\n");
  EXPECT_TRUE(says(open, "braces")) << open.describe();
  EXPECT_EQ(open.line, 5);
}

TEST(YamlDescription, RefusesASecondDocument) {
  const Problem problem = problem_of(std::string(kGood) + "---\nname: other\n");
  EXPECT_TRUE(says(problem, "second YAML document")) << problem.describe();
  EXPECT_NO_THROW((void)description_from_yaml(std::string("---\n") + kGood + "...\n", "one.yaml"));
}

TEST(YamlDescription, RefusesEndlessNestingByName) {
  for (const char* bracket : {"[", "{", "{a: ", "- "}) {
    std::string text = "name: ";
    for (int i = 0; i < 100'000; ++i) text += bracket;
    const Problem problem = problem_of(bracket[0] == '-' ? text.substr(6) : text);
    EXPECT_EQ(problem.code, ErrorCode::kBadRobot) << bracket;
    EXPECT_FALSE(problem.ways_out.empty());
    EXPECT_TRUE(says(problem, "too deep in one another")) << problem.describe();
  }
  // Each of these names ten of the one before: ten thousand million values, if they were copied.
  std::string laughs = "a0: &a0 [0, 0, 0, 0, 0, 0, 0, 0, 0, 0]\n";
  for (int i = 1; i < 10; ++i) {
    const std::string one = "*a" + std::to_string(i - 1) + " ";
    laughs += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [";
    for (int k = 0; k < 10; ++k) laughs += (k == 0 ? "" : ", ") + one;
    laughs += "]\n";
  }
  EXPECT_TRUE(says(problem_of(laughs), "unknown key \"a0\""));
  const Problem inside = problem_of(with(kGood, "a: 1,", "a: &a [*a],"));
  EXPECT_EQ(inside.code, ErrorCode::kBadRobot);
}

TEST(YamlDescription, RefusesLengthsThatNoArmHas) {
  const Problem problem = problem_of(with(kGood, "a: 1,", "a: 1e300,"));
  EXPECT_TRUE(says(problem, "1e+06 m")) << problem.describe();
  EXPECT_EQ(problem.line, 6);
  EXPECT_TRUE(says(problem_of(with(kGood, "dh:", "tool: {xyz: [0, -1e9, 0]}\ndh:")), "1e+06 m"));
  // However a description was made.
  RobotDescription far = arm("puma560")->description();
  far.tool.translation().x() = 2e6;
  EXPECT_THROW((void)RobotModel::make(far), MotionError);
}

TEST(YamlDescription, TellsALimitBeyondAllRangeInTheUnitOfTheFile) {
  const Problem problem = problem_of(with(kGood, "velocity: 100", "velocity: 1e300"));
  EXPECT_EQ(problem.code, ErrorCode::kBadLimits);
  EXPECT_EQ(problem.line, 6);
  EXPECT_TRUE(says(problem, "joints[0].velocity")) << problem.describe();
  EXPECT_TRUE(says(problem, "deg/s, got 1e300")) << problem.describe();
}

TEST(YamlDescription, RefusesAnEmptyFile) {
  for (const char* text : {"", "\n\n", "# only a comment\n", "~\n"}) {
    const Problem problem = problem_of(text);
    EXPECT_EQ(problem.code, ErrorCode::kBadRobot);
    EXPECT_TRUE(says(problem, "empty")) << problem.describe();
  }
}

TEST(YamlDescription, RefusesWhatIsNoMap) {
  EXPECT_TRUE(says(problem_of("just words\n"), "expected keys and values"));
  EXPECT_TRUE(says(problem_of("- a\n- b\n"), "a list of 2"));
  const Problem broken = problem_of("name: x\nunits: {angle: deg\naxes: 2\n");
  EXPECT_TRUE(says(broken, "not YAML"));
  EXPECT_TRUE(broken.line.has_value());
}

struct Fault {
  const char* name;
  const char* from;
  const char* to;
  ErrorCode code;
  int line;
  const char* says;
};

class YamlFault : public testing::TestWithParam<Fault> {};

TEST_P(YamlFault, IsNamedByLineAndKey) {
  const Fault& fault = GetParam();
  const Problem problem = problem_of(with(kGood, fault.from, fault.to));
  EXPECT_EQ(problem.code, fault.code) << problem.describe();
  EXPECT_EQ(problem.line, fault.line) << problem.describe();
  EXPECT_TRUE(says(problem, fault.says)) << problem.describe();
}

INSTANTIATE_TEST_SUITE_P(
    YamlDescription, YamlFault,
    testing::Values(
        Fault{"ZeroVelocity", "velocity: 100", "velocity: 0", ErrorCode::kBadLimits, 6,
              "joints[0].velocity: must be positive"},
        Fault{"NegativeJerk", "jerk: 100}", "jerk: -100}", ErrorCode::kBadLimits, 7,
              "joints[1].jerk"},
        Fault{"InfiniteAcceleration", "acceleration: 1000", "acceleration: .inf",
              ErrorCode::kBadLimits, 6, "finite"},
        Fault{"SwappedLimits", "[-90, 90]", "[90, -90]", ErrorCode::kBadLimits, 6,
              "must be below the upper limit"},
        Fault{"EqualLimits", "[-90, 90]", "[90, 90]", ErrorCode::kBadLimits, 6, "position"},
        Fault{"MissingVelocity", "velocity: 100, ", "", ErrorCode::kBadLimits, 6,
              "add \"velocity: ...\" in deg/s"},
        Fault{"MissingJerkOfASlide", ", jerk: 100}", "}", ErrorCode::kBadLimits, 7, "in m/s^3"},
        Fault{"MissingPosition", "position: [-90, 90], ", "", ErrorCode::kBadLimits, 6,
              "\"position: [min, max]\""},
        Fault{"OneLimitOnly", "[-90, 90]", "[90]", ErrorCode::kBadRobot, 6,
              "list of 2 numbers, got a list of 1"},
        Fault{"UnknownKey", "a: 1,", "a: 1, lenght: 2,", ErrorCode::kBadRobot, 6,
              "unknown key \"lenght\""},
        Fault{"UnknownTopKey", "dh:", "colour: red\ndh:", ErrorCode::kBadRobot, 4, "known keys"},
        Fault{"KeyTwice", "a: 1,", "a: 1, a: 2,", ErrorCode::kBadRobot, 6, "twice"},
        Fault{"NotANumber", "a: 1,", "a: long,", ErrorCode::kBadRobot, 6,
              "expected a number, got \"long\""},
        Fault{"NaN", "a: 1,", "a: .nan,", ErrorCode::kBadRobot, 6, "joints[0].a"},
        Fault{"InfiniteLength", "a: 1,", "a: .inf,", ErrorCode::kBadRobot, 6, "finite"},
        Fault{"MissingLength", "a: 1, ", "", ErrorCode::kBadRobot, 6, "\"a\" is missing"},
        Fault{"UnknownUnit", "angle: deg", "angle: grad", ErrorCode::kBadRobot, 2,
              "expected deg or rad"},
        Fault{"NoUnits", "units: {angle: deg}\n", "", ErrorCode::kBadRobot, 1,
              "units: {angle: deg}"},
        Fault{"UnknownConvention", "standard", "classic", ErrorCode::kBadRobot, 4,
              "expected standard or modified"},
        Fault{"UnknownType", "prismatic", "sliding", ErrorCode::kBadRobot, 7,
              "expected revolute or prismatic"},
        Fault{"WrongCount", "axes: 2", "axes: 3", ErrorCode::kBadRobot, 3, "2 joints are listed"},
        Fault{"NoCount", "axes: 2\n", "", ErrorCode::kBadRobot, 1, "axes: 2"},
        Fault{"SameName", "name: two", "name: one", ErrorCode::kBadRobot, 7, "\"one\""},
        Fault{"NoName", "name: pair\n", "", ErrorCode::kBadRobot, 1, "name: my_arm"},
        Fault{"BadRotation", "dh:", "tool: {rotation: [1, 0, 0, 0, 1, 0, 0, 1, 1]}\ndh:",
              ErrorCode::kBadRobot, 4, "not a rotation matrix"},
        Fault{"CouplingOfTheWrongWidth",
              "dh:", "coupling: {matrix: [[1]], lower: [0], upper: [1]}\ndh:", ErrorCode::kBadRobot,
              4, "coupling"}),
    [](const auto& each) { return std::string(each.param.name); });

TEST(LoadDescription, ListsTheBuiltInsForAnUnknownName) {
  try {
    (void)load_description("puma561");
    FAIL() << "found";
  } catch (const MotionError& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadRobot);
    const std::string text = error.problem().describe();
    EXPECT_NE(text.find("puma561"), std::string::npos);
    EXPECT_NE(text.find("panda, puma560, rpp, scara, two_link, ur5e"), std::string::npos) << text;
  }
}

TEST(LoadDescription, KnowsItsBuiltIns) {
  const std::vector<std::string> expected{"iiwa14", "panda",    "puma560", "rpp",
                                          "scara",  "two_link", "ur5e"};
  EXPECT_EQ(builtin_robots(), expected);
  for (const std::string& name : expected) EXPECT_EQ(load_description(name).name, name);
}

TEST(LoadDescription, SaysWhichFileIsMissing) {
  for (const char* path : {"/nowhere/arm.yaml", "/nowhere/arm.urdf"}) {
    try {
      (void)load_description(path);
      FAIL() << "found";
    } catch (const MotionError& error) {
      EXPECT_EQ(error.code(), ErrorCode::kFile);
      EXPECT_NE(std::string(error.what()).find(path), std::string::npos);
    }
  }
}

TEST(LoadDescription, RefusesOtherKindsOfFile) {
  for (const char* path : {"", "./arm", "folder/arm.txt"}) {
    EXPECT_THROW((void)load_description(path), MotionError) << path;
  }
}

TEST(LoadDescription, LooksInTheGivenDirectories) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(testing::TempDir()) / "viapoint_robots_test";
  fs::create_directories(folder);
  write_file_atomically((folder / "pair.yaml").string(), kGood);
  set_robot_directory(folder);
  EXPECT_EQ(load_description("pair").name, "pair");
  set_robot_directory({});
  EXPECT_THROW((void)load_description("pair"), MotionError);
  ASSERT_EQ(setenv("VIAPOINT_ROBOTS", folder.c_str(), 1), 0);
  EXPECT_EQ(load_description("pair").name, "pair");
  EXPECT_EQ(load_description("puma560").name, "puma560");
  ASSERT_EQ(unsetenv("VIAPOINT_ROBOTS"), 0);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace viapoint
