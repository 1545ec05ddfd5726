/// @file
/// Programs at random, of every kind of step: what tests and benches plan by the thousand.
#pragma once

#include <array>
#include <cmath>
#include <random>
#include <set>
#include <utility>

#include "planning/script.hpp"
#include "viapoint/planning/motion_planner.hpp"

namespace viapoint::testing_planner {

/// How a random program is made.
struct ProgramKind {
  size_t moves = 4;
  /// Share of the moves that go far or next to nowhere and ask for anything, possible or not.
  double wild = 0.5;
  /// How far the other moves go about one place, as a share of the joints' ranges (1.5 rad at
  /// most).
  double spread = 0.08;
  bool curves = true;  ///< arcs, turns, splines; else PTP and LIN alone
};

/// As many moves as long programs have: 2 to 200, most of them few.
inline size_t random_length(std::mt19937& random) {
  const double share = std::uniform_real_distribution<double>(0.0, 1.0)(random);
  return static_cast<size_t>(std::lround(2.0 * std::pow(100.0, share * share * share)));
}

/// Draws one program.
class ProgramMaker {
 public:
  ProgramMaker(const RobotModel& robot, const ProgramKind& kind, std::mt19937& random)
      : robot_(robot), kind_(kind), random_(random) {
    const JointLimits& limits = robot.limits();
    middle_ = 0.5 * (limits.position_min + limits.position_max);
    half_ = 0.5 * (limits.position_max - limits.position_min);
  }

  MotionProgram make() {
    home_ = middle_ + 0.6 * half_.cwiseMin(1.5).cwiseProduct(uniform_joints());
    at_ = home_;
    Script script(robot_, home_);
    for (size_t k = 0; k < kind_.moves; ++k) {
      if (chance(kind_.wild)) {
        add_wild(script);
      } else {
        add_calm(script);
      }
      add_between(script);
    }
    return script.program();
  }

 private:
  double uniform(double low = 0.0, double high = 1.0) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  bool chance(double share) { return uniform() < share; }
  double decades(double highest, double count) {
    return std::pow(10.0, highest - count * uniform());
  }
  JointVector uniform_joints() {
    JointVector q(robot_.joints());
    for (double& value : q) value = uniform(-1.0, 1.0);
    return q;
  }
  Eigen::Vector3d offset(double size) {
    std::normal_distribution<double> normal(0.0, size);
    const double x = normal(random_);
    const double y = normal(random_);
    return {x, y, normal(random_)};
  }

  Zone zone(double least_decades) {
    switch (random_() % 4) {
      case 0:
        return {};
      case 1:
        return {ZoneKind::kRadius, decades(-0.5, least_decades)};
      case 2:
        return {ZoneKind::kDeviation, decades(-1.0, least_decades)};
      default:
        return {ZoneKind::kJointDeviation, decades(-1.0, least_decades)};
    }
  }

  /// Not far, with wishes that can be had.
  void add_calm(Script& script) {
    const JointVector range = half_.cwiseMin(1.5);
    std::normal_distribution<double> normal(0.0, kind_.spread);
    JointVector q = home_;
    for (Eigen::Index i = 0; i < q.size(); ++i) q[i] += range[i] * normal(random_);
    q = q.cwiseMax(middle_ - 0.95 * half_).cwiseMin(middle_ + 0.95 * half_);
    MoveOptions options;
    options.zone = zone(3.0);
    if (chance(0.2)) options.scale = decades(0.0, 1.0);
    if (chance(0.3)) options.speed = decades(0.0, 2.0);
    add_move(script, q, options, kind_.curves ? random_() % 8 : random_() % 5, 0.02);
    at_ = q;
  }

  /// Near, far, tiny or nowhere, with wishes over many decades.
  void add_wild(Script& script) {
    double step = 0.15;
    if (random_() % 4 == 0) step = 1.0;
    if (random_() % 6 == 0) step = decades(0.0, 8.0);
    if (random_() % 30 == 0) step = 0.0;
    const JointVector far = middle_ + 0.8 * half_.cwiseProduct(uniform_joints());
    const JointVector q = (1.0 - step) * at_ + step * far;
    MoveOptions options;
    options.zone = zone(6.0);
    if (random_() % 3 == 0) options.scale = decades(0.0, 4.0);
    if (random_() % 3 == 0) options.speed = decades(1.0, 5.0);
    if (random_() % 3 == 0) options.acceleration = decades(1.0, 4.0);
    if (random_() % 5 == 0) options.angular_speed = decades(1.0, 4.0);
    if (random_() % 5 == 0) options.angular_acceleration = decades(2.0, 4.0);
    if (random_() % 12 == 0) options.process_speed = decades(0.0, 2.0);
    const size_t kinds = kind_.curves ? 8 : 5;
    add_move(script, q, options, random_() % kinds, random_() % 5 == 0 ? 0.5 : 0.05);
    at_ = q;
  }

  void add_move(Script& script, const JointVector& q, const MoveOptions& options, size_t what,
                double size) {
    constexpr std::array kOfLines = {Orientation::kLeast, Orientation::kLeast, Orientation::kLeast,
                                     Orientation::kSpin,  Orientation::kWrist, Orientation::kFixed};
    const Pose end = robot_.forward().pose(q);
    if (what <= 1) {
      script.add(PtpMove{JointTarget{q}}, options);
    } else if (what <= 4) {
      if (random_() % 8 == 0) {
        script.add(LinMove{PositionTarget{end.translation()}}, options);
      } else if (random_() % 8 == 0) {
        script.add(LinMove{JointTarget{q}}, options);
      } else {
        script.add(LinMove{PoseTarget{end}, kOfLines[random_() % kOfLines.size()]}, options);
      }
    } else if (what == 5) {
      Pose via = end;
      via.translation() += offset(size);
      script.add(CircMove{PoseTarget{via}, PoseTarget{end}, orientation()}, options);
    } else if (what == 6) {
      TurnMove move;
      if (random_() % 4 != 0) move.center = end.translation() + offset(size);
      if (random_() % 2 == 0) move.axis = Eigen::Vector3d::UnitZ();
      move.angle = uniform(-7.0, 7.0);
      if (random_() % 3 == 0) move.pitch = size * uniform(-1.0, 1.0);
      move.orientation = random_() % 2 == 0 ? Orientation::kFixed : orientation();
      script.add(std::move(move), options);
    } else {
      script.add(spline(q, size), options);
    }
  }

  SplineMove spline(const JointVector& q, double size) {
    SplineMove move;
    std::normal_distribution<double> normal(0.0, size);
    for (size_t k = random_() % 4; k > 0; --k) {
      JointVector point = 0.7 * q + 0.3 * at_;
      for (double& value : point) value += normal(random_);
      move.points.emplace_back(PoseTarget{robot_.forward().pose(point)});
    }
    move.points.emplace_back(PoseTarget{robot_.forward().pose(q)});
    move.kind = static_cast<SplineKind>(random_() % 4);
    move.space = random_() % 3 == 0 ? SplineSpace::kJoint : SplineSpace::kTool;
    move.orientation = orientation();
    return move;
  }

  /// Mostly one that the move can have.
  Orientation orientation() {
    return random_() % 3 == 0 ? static_cast<Orientation>(random_() % 7) : Orientation::kLeast;
  }

  /// Waits and outputs.
  void add_between(Script& script) {
    if (random_() % 12 == 0) script.add(Wait{random_() % 3 == 0 ? 0.0 : 0.1 * uniform()});
    for (size_t k = random_() % 12 == 0 ? 1 + random_() % 9 : 0; k > 0; --k) {
      const unsigned draw = static_cast<unsigned>(random_());
      SetOutput output{static_cast<int>(draw % 64), random_() % 2 == 0};
      if ((draw >> 6) % 4 == 0) output.time = (draw >> 8) % 2 == 0 ? -0.05 : 0.02;
      script.add(output);
    }
  }

  const RobotModel& robot_;
  ProgramKind kind_;
  std::mt19937& random_;
  JointVector middle_, half_;  ///< of the joints' ranges
  JointVector home_, at_;
};

/// @param random the same seed gives the same program
inline MotionProgram random_program(const RobotModel& robot, const ProgramKind& kind,
                                    std::mt19937& random) {
  return ProgramMaker(robot, kind, random).make();
}

/// Leaves out the steps that have errors. @return whether there were any
inline bool leave_out_errors(MotionProgram& program, const Report& report) {
  std::set<int> wrong;
  for (const Problem& problem : report.problems) {
    if (problem.severity == Severity::kError && problem.move) wrong.insert(*problem.move);
  }
  for (auto step = wrong.rbegin(); step != wrong.rend(); ++step) {
    program.steps.erase(program.steps.begin() + *step);
  }
  return !wrong.empty();
}

}  // namespace viapoint::testing_planner
