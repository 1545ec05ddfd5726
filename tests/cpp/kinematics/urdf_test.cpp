#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "kinematics/arms.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/core/units.hpp"
#include "viapoint/kinematics/inverse_kinematics.hpp"

namespace viapoint {
namespace {

/// Two turning joints, a slide between fixed links, and a tool flange.
const char* const kGood = R"(<robot name="trio">
  <link name="base"/><link name="upper"/><link name="bracket"/><link name="fore"/>
  <link name="carriage"/><link name="flange"/>
  <joint name="shoulder" type="revolute">
    <parent link="base"/><child link="upper"/><origin xyz="0 0 0.5" rpy="0 0 0"/>
    <axis xyz="0 0 1"/><limit lower="-2" upper="2" effort="1" velocity="1.5"/>
  </joint>
  <joint name="mount" type="fixed">
    <parent link="upper"/><child link="bracket"/><origin xyz="1 0 0" rpy="1.5707963267948966 0 0"/>
  </joint>
  <joint name="elbow" type="continuous">
    <parent link="bracket"/><child link="fore"/><axis xyz="0 0 -2"/>
    <limit effort="1" velocity="2"/>
  </joint>
  <joint name="slide" type="prismatic">
    <parent link="fore"/><child link="carriage"/><origin xyz="0.2 0 0"/>
    <axis xyz="1 0 0"/><limit lower="0" upper="0.4" effort="1" velocity="0.3"/>
  </joint>
  <joint name="end" type="fixed">
    <parent link="carriage"/><child link="flange"/><origin xyz="0.1 0 0"/>
  </joint>
</robot>)";

std::string with(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

Problem problem_of(const std::string& text, const std::string& tip = "") {
  try {
    (void)description_from_urdf(text, "trio.urdf", tip);
  } catch (const MotionError& error) {
    EXPECT_EQ(error.problem().file, "trio.urdf");
    return error.problem();
  }
  ADD_FAILURE() << "accepted";
  return {};
}

bool says(const Problem& problem, const std::string& text) {
  return problem.describe().find(text) != std::string::npos;
}

TEST(UrdfDescription, ReadsTheChainThroughFixedJoints) {
  const RobotPtr robot = RobotModel::make(description_from_urdf(kGood, "trio.urdf"));
  ASSERT_EQ(robot->joints(), 3);
  EXPECT_EQ(robot->description().joint_names,
            (std::vector<std::string>{"shoulder", "elbow", "slide"}));
  EXPECT_EQ(robot->forward().type(2), JointType::kPrismatic);
  for (const double q1 : {-0.7, 0.0, 1.1}) {
    for (const double q2 : {-0.4, 0.9}) {
      for (const double q3 : {0.0, 0.25}) {
        // The elbow turns about the bracket's −z, which is the upper arm's +y: down for q2 > 0.
        const double reach = 0.2 + q3 + 0.1;
        const double out = 1.0 + reach * std::cos(q2);
        const Eigen::Vector3d expected(out * std::cos(q1), out * std::sin(q1),
                                       0.5 - reach * std::sin(q2));
        const Pose pose = robot->fk(Eigen::Vector3d(q1, q2, q3));
        EXPECT_LT((pose.translation() - expected).norm(), 1e-12);
      }
    }
  }
}

TEST(UrdfDescription, ChoosesAccelerationAndJerkAndSaysSo) {
  const RobotDescription robot = description_from_urdf(kGood, "trio.urdf");
  EXPECT_EQ(robot.limits.velocity, Eigen::Vector3d(1.5, 2.0, 0.3));
  EXPECT_EQ(robot.limits.acceleration, 10.0 * robot.limits.velocity);
  EXPECT_EQ(robot.limits.jerk, 100.0 * robot.limits.velocity);
  EXPECT_TRUE(std::isinf(robot.limits.position_max[1]));
  ASSERT_EQ(robot.chosen.size(), 2u);
  EXPECT_NE(robot.chosen[0].find("acceleration"), std::string::npos);
}

TEST(UrdfDescription, StopsAtTheNamedTip) {
  const RobotDescription robot = description_from_urdf(kGood, "trio.urdf", "fore");
  EXPECT_EQ(robot.joint_names, (std::vector<std::string>{"shoulder", "elbow"}));
  EXPECT_TRUE(says(problem_of(kGood, "hand"), "no link is called \"hand\""));
}

TEST(UrdfDescription, PassesOverALeafThatIsFixedToTheRoot) {
  const std::string second_name =
      "<link name=\"base_too\"/><joint name=\"same\" type=\"fixed\"><parent link=\"base\"/>"
      "<child link=\"base_too\"/></joint></robot>";
  const RobotPtr robot =
      RobotModel::make(description_from_urdf(with(kGood, "</robot>", second_name), "trio.urdf"));
  EXPECT_EQ(robot->joints(), 3);
}

TEST(UrdfDescription, RefusesToGuessABranch) {
  const std::string forked = with(kGood, "</robot>", R"(<link name="camera"/>
    <joint name="eye" type="fixed"><parent link="fore"/><child link="camera"/></joint></robot>)");
  const Problem problem = problem_of(forked);
  EXPECT_EQ(problem.code, ErrorCode::kBadRobot);
  EXPECT_TRUE(says(problem, "camera, flange")) << problem.describe();
  EXPECT_NO_THROW((void)description_from_urdf(forked, "trio.urdf", "flange"));
}

TEST(UrdfDescription, RefusesZeroVelocityWithWhatToAdd) {
  const Problem problem = problem_of(with(kGood, "velocity=\"0.3\"", "velocity=\"0\""));
  EXPECT_EQ(problem.code, ErrorCode::kBadLimits);
  EXPECT_TRUE(says(problem, "\"slide\""));
  EXPECT_TRUE(says(problem, "add velocity")) << problem.describe();
}

TEST(UrdfDescription, NamesEveryJointWithoutAVelocityAtOnce) {
  const Problem problem = problem_of(
      with(with(kGood, "velocity=\"0.3\"", "velocity=\"0\""), "velocity=\"2\"", "velocity=\"-1\""));
  EXPECT_EQ(problem.code, ErrorCode::kBadLimits);
  EXPECT_TRUE(says(problem, "nor have a velocity")) << problem.describe();
  EXPECT_TRUE(says(problem, "these joints")) << problem.describe();
}

TEST(UrdfDescription, RefusesMissingVelocityWithWhatToAdd) {
  const Problem problem = problem_of(with(kGood, " velocity=\"0.3\"", ""));
  EXPECT_TRUE(says(problem, "velocity")) << problem.describe();
  EXPECT_TRUE(says(problem, "slide")) << problem.describe();
  EXPECT_FALSE(problem.ways_out.empty());
}

TEST(UrdfDescription, RefusesMissingLimits) {
  const Problem turning =
      problem_of(with(kGood, R"(<limit lower="-2" upper="2" effort="1" velocity="1.5"/>)", ""));
  EXPECT_TRUE(says(turning, "shoulder")) << turning.describe();
  EXPECT_TRUE(says(turning, "velocity=")) << turning.describe();
  const Problem endless = problem_of(with(kGood, R"(<limit effort="1" velocity="2"/>)", ""));
  EXPECT_EQ(endless.code, ErrorCode::kBadLimits);
  EXPECT_TRUE(says(endless, "elbow")) << endless.describe();
}

TEST(UrdfDescription, RefusesSwappedLimits) {
  const Problem problem =
      problem_of(with(kGood, R"(lower="-2" upper="2")", R"(lower="2" upper="-2")"));
  EXPECT_EQ(problem.code, ErrorCode::kBadLimits);
  EXPECT_TRUE(says(problem, "must be below"));
}

TEST(UrdfDescription, RefusesEmptyAndTruncatedFiles) {
  EXPECT_TRUE(says(problem_of(""), "empty"));
  EXPECT_TRUE(says(problem_of(" \n"), "empty"));
  const std::string text = kGood;
  for (size_t size = 1; size < text.size() - 1; size += 7) {
    EXPECT_EQ(problem_of(text.substr(0, size)).code, ErrorCode::kBadRobot) << size;
  }
  EXPECT_EQ(problem_of("<model/>").code, ErrorCode::kBadRobot);
}

TEST(UrdfDescription, RefusesElementsWithoutEndByName) {
  constexpr int kMany = 200'000;
  std::string opening;
  std::string closing;
  for (int i = 0; i < kMany; ++i) {
    opening += "<link name='a'>";
    closing += "</link>";
  }
  for (const std::string& text : {opening, opening + closing}) {
    const Problem problem = problem_of("<robot name='x'>" + text + "</robot>");
    EXPECT_EQ(problem.code, ErrorCode::kBadRobot);
    EXPECT_TRUE(says(problem, "in one another"));
    EXPECT_FALSE(problem.ways_out.empty());
  }
}

TEST(UrdfDescription, TakesAChainAsLongAsItsBoundAllowsToPieces) {
  // The links hold one another; the last in the order of names is the root.
  constexpr int kLinks = 12'000;
  std::string text = "<robot name='x'>";
  const auto name = [](int i) { return "'l" + std::to_string(100'000 + kLinks - i) + "'"; };
  for (int i = 0; i < kLinks; ++i) text += "<link name=" + name(i) + "/>";
  for (int i = 1; i < kLinks; ++i) {
    text += "<joint name='j" + std::to_string(i) + "' type='fixed'><parent link=" + name(i - 1) +
            "/><child link=" + name(i) + "/></joint>";
  }
  EXPECT_TRUE(says(problem_of(text + "</robot>"), "no moving joint"));
}

TEST(UrdfDescription, PassesOverElementsThatAreNone) {
  std::string text = kGood;
  std::string unclosed;
  for (int i = 0; i < 300; ++i) unclosed += "<a b='>'>";
  text.insert(text.find("<link"), "<!-- " + unclosed + " --><note text='/>'/>");
  EXPECT_EQ(description_from_urdf(text, "trio.urdf").chain.size(),
            description_from_urdf(kGood, "trio.urdf").chain.size());
}

TEST(UrdfDescription, RefusesARingOfJointsBesideTheRoot) {
  const std::string ring = with(kGood, "</robot>", R"(<link name="a"/><link name="b"/>
    <joint name="ab" type="fixed"><parent link="a"/><child link="b"/></joint>
    <joint name="ba" type="fixed"><parent link="b"/><child link="a"/></joint></robot>)");
  const Problem problem = problem_of(ring);
  EXPECT_TRUE(says(problem, "form a ring")) << problem.describe();
  EXPECT_TRUE(says(problem, "joint \"ba\"") || says(problem, "joint \"ab\"")) << problem.describe();
}

TEST(UrdfDescription, RefusesARingThatLeavesNoRootOrAlsoHangsOnTheTree) {
  const std::string links = R"(<robot name="r"><link name="a"/><link name="b"/><link name="c"/>)";
  const auto joint = [](const std::string& parent, const std::string& child) {
    return "<joint name=\"" + parent + child + "\" type=\"fixed\"><parent link=\"" + parent +
           "\"/><child link=\"" + child + "\"/></joint>";
  };
  for (const std::string& joints :
       {joint("a", "b") + joint("b", "c") + joint("c", "a"), joint("a", "a"),
        joint("a", "b") + joint("b", "c") + joint("c", "b")}) {
    const Problem problem = problem_of(links + joints + "</robot>");
    EXPECT_TRUE(says(problem, "form a ring")) << problem.describe();
  }
  // Far from any ring, and in the order that is worst for a search.
  std::string chain = R"(<robot name="r"><link name="l10000"/>)";
  for (int i = 10'000; i < 20'000; ++i) {
    const std::string child = "l" + std::to_string(i + 1);
    chain += "<link name=\"" + child + "\"/>" + joint("l" + std::to_string(i), child);
  }
  EXPECT_FALSE(says(problem_of(chain + joint("l20000", "nowhere") + "</robot>"), "form a ring"));
}

TEST(UrdfDescription, SaysWhatMendsAComplaint) {
  const auto way = [](const Problem& problem) {
    return problem.ways_out.empty() ? "" : problem.ways_out.front();
  };
  EXPECT_NE(way(problem_of(with(kGood, "type=\"continuous\"", "type=\"ball\""))).find("types"),
            std::string::npos);
  std::string twice = kGood;
  twice.insert(twice.find("<link"), "<link name=\"base\"/>");
  EXPECT_NE(way(problem_of(twice)).find("name of its own"), std::string::npos);
}

TEST(UrdfDescription, RefusesJointsItCannotMove) {
  EXPECT_TRUE(
      says(problem_of(with(kGood, "type=\"continuous\"", "type=\"floating\"")), "floating"));
  const Problem mimic = problem_of(
      with(kGood, "<axis xyz=\"1 0 0\"/>", "<axis xyz=\"1 0 0\"/><mimic joint=\"shoulder\"/>"));
  EXPECT_TRUE(says(mimic, "mimics")) << mimic.describe();
  const Problem still = problem_of(kGood, "base");
  EXPECT_TRUE(says(still, "no moving joint")) << still.describe();
}

TEST(UrdfDescription, RefusesAnAxisWithoutDirection) {
  EXPECT_TRUE(says(problem_of(with(kGood, "xyz=\"0 0 -2\"", "xyz=\"0 0 0\"")), "elbow"));
}

TEST(UrdfDescription, RefusesLengthsBeyondEveryArm) {
  const Problem problem = problem_of(with(kGood, "0 0 0.5", "0 0 2e6"));
  EXPECT_TRUE(says(problem, "\"shoulder\" is 2e+06 m from what carries it")) << problem.describe();
  EXPECT_TRUE(says(problem, "1e+06 m"));
  // Together, though neither is by itself; and behind the last joint that moves.
  const std::string far = with(with(kGood, "1 0 0", "9e5 0 0"), "<axis xyz=\"0 0 -2\"/>",
                               "<origin xyz=\"9e5 0 0\"/><axis xyz=\"0 0 -2\"/>");
  EXPECT_TRUE(says(problem_of(far), "\"elbow\" is 1800000 m"));
  EXPECT_TRUE(says(problem_of(with(kGood, "0.1 0 0", "2e6 0 0")), "\"end\" is 2e+06 m"));
}

TEST(UrdfDescription, RefusesEmptyNames) {
  EXPECT_TRUE(says(problem_of(with(kGood, "\"trio\"", "\"\"")), "the robot has an empty name"));
  EXPECT_TRUE(says(problem_of(with(kGood, "\"elbow\"", "\"\"")), "a joint has an empty name"));
}

TEST(UrdfDescription, RoundTripsThroughYaml) {
  const RobotDescription robot = description_from_urdf(kGood, "trio.urdf");
  const RobotDescription again = description_from_yaml(to_yaml(robot), "again");
  EXPECT_EQ(RobotModel::make(again)->fingerprint(), RobotModel::make(robot)->fingerprint());
}

TEST(UrdfDescription, SolvesPositionsOfAJointWithoutLimits) {
  const RobotPtr robot = RobotModel::make(description_from_urdf(kGood, "trio.urdf"));
  std::mt19937_64 generator(41);
  std::uniform_real_distribution<double> unit(0.05, 0.95);
  for (int problem = 0; problem < 500; ++problem) {
    SCOPED_TRACE(problem);
    const Eigen::Vector3d q(4.0 * unit(generator) - 2.0, 6.0 * unit(generator) - 3.0,
                            0.4 * unit(generator));
    const Eigen::Vector3d p = robot->fk(q).translation();
    JointVector found;
    ASSERT_NO_THROW(found = robot->inverse().solve_near(p, q));
    ASSERT_TRUE(robot->limits().contains(found));
    ASSERT_LT((robot->fk(found).translation() - p).norm(), 1e-9);
  }
}

}  // namespace
}  // namespace viapoint
