#include <algorithm>
#include <cmath>
#include <ctime>
#include <functional>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "benches.hpp"
#include "durations.hpp"
#include "json_line.hpp"
#include "kinematics/closed_form.hpp"
#include "kinematics/numerical_inverse.hpp"
#include "kinematics_peers.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/core/units.hpp"
#include "viapoint/kinematics/inverse_kinematics.hpp"
#include "viapoint/kinematics/robot_model.hpp"

namespace viapoint::bench {
namespace {

/// Runs `action` and returns the processor time it took [s]: other programs on the machine do not
/// count. Reading this clock takes a call of the system, so what is quick is timed by time_of().
template <typename Action>
double processor_time_of(Action&& action) {
  const auto read = [] {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  };
  const double begin = read();
  action();
  return read() - begin;
}

/// What reading the clock takes [s], which no figure here counts. @param timer one of the two
template <typename Timer>
double clock_cost(Timer&& timer) {
  Durations reads;
  for (int i = 0; i < 10'000; ++i) reads.add(timer([] {}));
  return reads.quantile(0.5);
}

JointVector random_joints(const JointLimits& limits, std::mt19937_64& generator) {
  JointVector q(limits.joints());
  for (int i = 0; i < q.size(); ++i) {
    q[i] = std::uniform_real_distribution<double>(limits.position_min[i],
                                                  limits.position_max[i])(generator);
  }
  return q;
}

/// Worst of position [m] and angle [rad].
double miss(const RobotModel& robot, const JointVector& q, const Pose& pose) {
  const Pose reached = robot.forward().pose(q);
  return std::max((reached.translation() - pose.translation()).norm(),
                  rotation_distance(reached.linear(), pose.linear()));
}

/// The closed form alone, limits and turns left aside: every branch, put through the form's own
/// forward kinematics.
void form_of(const std::string& name, const RobotModel& robot, int poses) {
  const auto form = recognise_closed_form(robot.forward());
  std::mt19937_64 generator(1);
  const double own = clock_cost([](auto&& action) { return time_of(action); });
  Durations durations;
  durations.reserve(static_cast<size_t>(poses));
  double count = 0.0;
  for (int i = 0; i < poses; ++i) {
    const JointVector q = random_joints(robot.limits(), generator);
    const InverseTask task(robot.forward().pose(q));
    ClosedSolutions found;
    durations.add(time_of([&] { form->solve(task, q, found); }) - own);
    count += found.branches.size();
  }
  JsonLine("kinematics", name + " closed form")
      .add("poses", poses)
      .add("branches", count / poses)
      .add("p50_us", 1e6 * durations.quantile(0.5))
      .add("p99_us", 1e6 * durations.quantile(0.99));
}

/// Every branch of random poses within the limits, on its turn nearest to the joints that made the
/// pose: times, how many poses are solved, and whether the joints that made
/// the pose are among them.
void branches_of(const std::string& name, const RobotModel& robot, int poses) {
  std::mt19937_64 generator(1);
  const double own = clock_cost([](auto&& action) { return time_of(action); });
  Durations durations;
  durations.reserve(static_cast<size_t>(poses));
  int solved = 0;
  int found = 0;
  double worst = 0.0;
  double count = 0.0;
  for (int i = 0; i < poses; ++i) {
    const JointVector q = random_joints(robot.limits(), generator);
    const Pose pose = robot.forward().pose(q);
    BranchSet branches;
    BranchStatus status{};
    durations.add(time_of([&] { status = robot.inverse().solve_branches(pose, q, branches); }) -
                  own);
    solved += status == BranchStatus::kSolved ? 1 : 0;
    bool again = false;
    for (const JointVector& branch : branches) {
      worst = std::max(worst, miss(robot, branch, pose));
      again = again || (branch - q).lpNorm<Eigen::Infinity>() < 1e-6;
    }
    found += again ? 1 : 0;
    count += branches.size();
  }
  JsonLine("kinematics", name + " branches")
      .add("poses", poses)
      .add("unsolved", poses - solved)
      .add("joints_not_found", poses - found)
      .add("branches", count / poses)
      .add("worst_error", worst)
      .add("p50_us", 1e6 * durations.quantile(0.5))
      .add("p99_us", 1e6 * durations.quantile(0.99));
}

/// Where the joints are that a solver is told to stay near.
enum class Near {
  kAnywhere,  ///< at random, far from the answer in general
  kOnTheWay,  ///< within kStep of joints that make the pose, as from one pose of a way to the next
};
constexpr double kStep = 0.05;  // [rad or m]

/// Finds one solution within the limits, or nothing; it may throw.
struct Solver {
  std::string name;
  std::function<std::optional<JointVector>(const Pose&, const JointVector&)> solve;
};

/// One solution of each pose by every solver, one after the other. An answer that misses the pose,
/// or leaves the limits, counts as none.
void one_of(const RobotModel& robot, Near kind, int poses, const std::vector<Solver>& solvers) {
  constexpr double kMiss = 1e-6;  // [m] and [rad]
  struct Tally {
    Durations durations;
    int unsolved = 0;
    double worst = 0.0;
    double change = 0.0;
  };
  std::mt19937_64 generator(2);
  std::uniform_real_distribution<double> step(-kStep, kStep);
  const double own = clock_cost([](auto&& action) { return processor_time_of(action); });
  std::vector<Tally> tallies(solvers.size());
  for (int i = 0; i < poses; ++i) {
    const JointVector made_by = random_joints(robot.limits(), generator);
    const Pose pose = robot.forward().pose(made_by);
    JointVector near = made_by;
    if (kind == Near::kAnywhere) {
      near = random_joints(robot.limits(), generator);
    } else {
      for (double& value : near) value += step(generator);
    }
    for (size_t k = 0; k < solvers.size(); ++k) {
      Tally& tally = tallies[k];
      std::optional<JointVector> q;
      tally.durations.add(processor_time_of([&] {
                            try {
                              q = solvers[k].solve(pose, near);
                            } catch (const MotionError&) {
                              q.reset();
                            }
                          }) -
                          own);
      const double off = q ? miss(robot, *q, pose) : 0.0;
      if (!q || off > kMiss || !robot.limits().contains(*q, 1e-9)) {
        ++tally.unsolved;
        continue;
      }
      tally.worst = std::max(tally.worst, off);
      tally.change += (*q - near).lpNorm<Eigen::Infinity>();
    }
  }
  for (size_t k = 0; k < solvers.size(); ++k) {
    Tally& tally = tallies[k];
    JsonLine("kinematics", solvers[k].name)
        .add("poses", poses)
        .add("unsolved", tally.unsolved)
        .add("mean_change", tally.change / std::max(1, poses - tally.unsolved))
        .add("worst_error", tally.worst)
        .add("p50_us", 1e6 * tally.durations.quantile(0.5))
        .add("p99_us", 1e6 * tally.durations.quantile(0.99));
  }
}

/// The solution nearest to joints anywhere, and to those one step of a way before.
void nearest_of(const std::string& name, const RobotModel& robot, const InverseKinematics& inverse,
                int poses) {
  const auto solve = [&](const Pose& pose, const JointVector& near) {
    return inverse.solve_near(pose, near);
  };
  one_of(robot, Near::kAnywhere, poses, {{name + " nearest", solve}});
  one_of(robot, Near::kOnTheWay, poses, {{name + " nearest, on a way", solve}});
}

/// Search alone, as for an arm that no closed form serves, beside KDL's.
void searched_of(const std::string& name, const RobotModel& robot, int poses) {
  const NumericalInverse numerical(robot.forward(), robot.limits(), "as measured");
  const Solver ours{name + " searched", [&](const Pose& pose, const JointVector& near) {
                      return numerical.find(InverseTask(pose), near);
                    }};
  constexpr int kSlower = 10;  // times slower, and so many fewer poses
  KdlSolvers kdl(robot);
  one_of(robot, Near::kAnywhere, poses, {ours});
  one_of(robot, Near::kAnywhere, std::max(1, poses / kSlower),
         {{name + " searched, beside KDL", ours.solve},
          {name + " KDL LMA",
           [&](const Pose& pose, const JointVector& near) { return kdl.lma(pose, near); }},
          {name + " KDL NR_JL",
           [&](const Pose& pose, const JointVector& near) { return kdl.nr_jl(pose, near); }}});
  nearest_of(name + " by search", robot, numerical, poses);
}

#ifdef VIAPOINT_EAIK
/// Every branch, by EAIK and by ours, one after the other. EAIK has no limits: ours is timed
/// without, the closed form alone, and with.
void beside_eaik(const std::string& name, const RobotModel& robot, int poses) {
  const EAIK::Robot eaik = eaik_robot(robot.forward());
  const auto form = recognise_closed_form(robot.forward());
  std::mt19937_64 generator(1);
  const double own = clock_cost([](auto&& action) { return time_of(action); });
  Durations ours;
  Durations alone;
  Durations theirs;
  int unsolved = 0;
  int missed = 0;
  for (int i = 0; i < poses; ++i) {
    const JointVector made_by = random_joints(robot.limits(), generator);
    const Pose pose = robot.forward().pose(made_by);
    const Eigen::Matrix4d& matrix = pose.matrix();
    BranchSet branches;
    IKS::IK_Eigen_Solution found;
    ours.add(time_of([&] { (void)robot.inverse().solve_branches(pose, made_by, branches); }) - own);
    ClosedSolutions solutions;
    alone.add(time_of([&] { form->solve(InverseTask(pose), made_by, solutions); }) - own);
    theirs.add(time_of([&] { found = eaik.calculate_Eigen_IK(matrix); }) - own);
    bool solved = false;
    bool again = false;
    for (Eigen::Index row = 0; row < found.Q.rows(); ++row) {
      const JointVector q = found.Q.row(row).transpose();
      if (miss(robot, q, pose) > 1e-6) continue;
      solved = true;
      double apart = 0.0;
      for (int k = 0; k < q.size(); ++k) {
        apart = std::max(apart, std::abs(std::remainder(q[k] - made_by[k], 2.0 * kPi)));
      }
      again = again || apart < 1e-5;
    }
    unsolved += solved ? 0 : 1;
    missed += again ? 0 : 1;
  }
  JsonLine("kinematics", name + " closed form, beside EAIK")
      .add("poses", poses)
      .add("p50_us", 1e6 * alone.quantile(0.5))
      .add("p99_us", 1e6 * alone.quantile(0.99));
  JsonLine("kinematics", name + " branches, beside EAIK")
      .add("poses", poses)
      .add("p50_us", 1e6 * ours.quantile(0.5))
      .add("p99_us", 1e6 * ours.quantile(0.99));
  JsonLine("kinematics", name + " EAIK")
      .add("poses", poses)
      .add("unsolved", unsolved)
      .add("joints_not_found", missed)
      .add("p50_us", 1e6 * theirs.quantile(0.5))
      .add("p99_us", 1e6 * theirs.quantile(0.99));
}
#endif

}  // namespace

void bench_kinematics(int poses) {
  for (const std::string name : {"puma560", "ur5e", "scara", "rpp", "two_link"}) {
    const RobotPtr robot = RobotModel::make(load_description(name));
    if (robot->joints() == 6) form_of(name, *robot, poses);
    branches_of(name, *robot, poses);
    nearest_of(name, *robot, robot->inverse(), poses);
  }
  constexpr int kSlower = 10;  // times slower, and so many fewer poses
  for (const std::string name : {"panda", "iiwa14"}) {
    const RobotPtr robot = RobotModel::make(load_description(name));
    nearest_of(name, *robot, robot->inverse(), std::max(1, poses / kSlower));
  }
  for (const std::string name : {"puma560", "ur5e"}) {
    RobotDescription description = load_description(name);
    // Axis 3 as a calibration finds it: the UR then has no closed form.
    description.chain[2].before.linear() =
        description.chain[2].before.linear() * rotation_exp(Eigen::Vector3d(1e-4, 0.0, 0.0));
    const RobotPtr robot = RobotModel::make(description);
    nearest_of(name + " out of true", *robot, robot->inverse(), std::max(1, poses / kSlower));
  }
  for (const std::string name : {"puma560", "ur5e", "panda", "iiwa14"}) {
    searched_of(name, *RobotModel::make(load_description(name)), std::max(1, poses / kSlower));
  }
#ifdef VIAPOINT_EAIK
  for (const std::string name : {"puma560", "ur5e"}) {
    beside_eaik(name, *RobotModel::make(load_description(name)), std::max(1, poses / kSlower));
  }
#endif
}

}  // namespace viapoint::bench
