// What holds for both families of six-axis arms: any offsets and directions of axes are recognised,
// and a path through the wrist singularity is followed without a jump.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "kinematics/arms.hpp"
#include "viapoint/kinematics/inverse_kinematics.hpp"

namespace viapoint {
namespace {

using Unit = std::function<double()>;  ///< random, from -1 to 1

struct Family {
  const char* robot;
  const char* says;                                     ///< in the family's own words
  double spread;                                        ///< of a path's start, share of the limits
  void (*place)(JointVector& start, JointVector& end);  ///< clear of the elbow's singularity
  void (*offset)(std::vector<ChainJoint>&, const Unit&);  ///< lengths that keep the family
};

const Family kFamilies[] = {
    {"puma560", "spherical", 0.5, [](JointVector&, JointVector&) {},
     [](std::vector<ChainJoint>& chain, const Unit& unit) {
       chain[0].before.translation() = Eigen::Vector3d(unit(), unit(), unit());
       chain[1].before.translation() += Eigen::Vector3d(0.2 * unit(), 0.0, 0.0);
       chain[3].before.translation() += Eigen::Vector3d(0.1 * unit(), 0.0, 0.0);
     }},
    {"ur5e", "parallel", 0.4,
     [](JointVector& start, JointVector& end) {
       start[2] = 1.0;
       end[2] = 1.3;
     },
     [](std::vector<ChainJoint>& chain, const Unit& unit) {
       chain[1].before.translation() += Eigen::Vector3d(0.2 * unit(), 0.0, 0.0);
       chain[2].before.translation() += Eigen::Vector3d(0.0, 0.1 * unit(), 0.1);
       chain[4].before.translation() += Eigen::Vector3d(0.05 * unit(), 0.0, 0.0);
     }},
};

class WristFamilies : public testing::TestWithParam<Family> {};
INSTANTIATE_TEST_SUITE_P(InverseKinematics, WristFamilies, testing::ValuesIn(kFamilies),
                         [](const auto& each) { return std::string(each.param.robot); });

TEST_P(WristFamilies, CrossTheWristSingularityWithoutAJump) {
  // Paths through q5 = 0 with everything else smooth: the branch is kept.
  const RobotPtr robot = arm(GetParam().robot);
  std::mt19937_64 generator(25);
  constexpr int kSteps = 200;
  for (int path = 0; path < 100; ++path) {
    SCOPED_TRACE(path);
    JointVector start = GetParam().spread * random_joints(*robot, generator);
    JointVector end = start + 0.05 * random_joints(*robot, generator);
    GetParam().place(start, end);
    start[4] = -0.3;
    end[4] = 0.3;
    JointVector q = start;
    JointVector before = start;
    for (int step = 1; step <= kSteps; ++step) {
      const JointVector goal = start + (end - start) * (static_cast<double>(step) / kSteps);
      const JointVector expected = 2.0 * q - before;
      before = q;
      ASSERT_NO_THROW(q = robot->inverse().solve_near(robot->fk(goal), expected));
      ASSERT_LT((q - goal).lpNorm<Eigen::Infinity>(), 1e-5) << "step " << step;
    }
  }
}

TEST_P(WristFamilies, AreRecognisedWithEveryOffsetAndOrientation) {
  // Offsets, joints turned end for end, any base and tool.
  for (unsigned seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 generator(seed);
    std::uniform_real_distribution<double> distribution(-1.0, 1.0);
    const Unit unit = [&] { return distribution(generator); };
    RobotDescription description =
        load_description(std::string(VIAPOINT_TEST_ROBOTS) + "/" + GetParam().robot + ".yaml");
    auto& chain = description.chain;
    chain[0].before.linear() = rotation_exp(Eigen::Vector3d(unit(), unit(), unit()));
    GetParam().offset(chain, unit);
    for (ChainJoint& joint : chain) {
      if (unit() > 0.0) joint.axis = -joint.axis;
    }
    description.tool.linear() = rotation_exp(Eigen::Vector3d(unit(), unit(), unit()));
    description.tool.translation() = Eigen::Vector3d(0.1, 0.2 * unit(), 0.3);
    const RobotPtr robot = RobotModel::make(description);
    ASSERT_NE(robot->inverse().family().find(GetParam().says), std::string::npos);
    for (int problem = 0; problem < 20; ++problem) {
      const JointVector q = random_joints(*robot, generator);
      const Pose pose = robot->fk(q);
      ASSERT_LT((robot->inverse().solve_near(pose, q) - q).lpNorm<Eigen::Infinity>(), 1e-6);
      BranchSet branches;
      ASSERT_EQ(robot->inverse().solve_branches(pose, q, branches), BranchStatus::kSolved);
      double nearest = 1e300;
      for (const JointVector& solution : branches) {
        nearest = std::min(nearest, (solution - q).lpNorm<Eigen::Infinity>());
        ASSERT_LT(pose_distance(robot->fk(solution), pose), 2e-9);
      }
      ASSERT_LT(nearest, 1e-6);
    }
  }
}

}  // namespace
}  // namespace viapoint
