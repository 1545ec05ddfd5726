// Points so dense, or so nearly on one line, that they make one leg.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "planning/planner_fixture.hpp"
#include "planning/stream_fixture.hpp"
#include "problem_count.hpp"

namespace viapoint::testing_planner {
namespace {

using Points = std::vector<Eigen::VectorXd>;

double distance_to_segment(const Eigen::VectorXd& p, const Eigen::VectorXd& a,
                           const Eigen::VectorXd& b) {
  const Eigen::VectorXd along = b - a;
  const double square = along.squaredNorm();
  const double share = square > 0.0 ? std::clamp(along.dot(p - a) / square, 0.0, 1.0) : 0.0;
  return (p - a - share * along).norm();
}

/// Walks along `line` as `points` go along it, so that a curve that comes back is not mistaken.
double farthest_from(const Points& points, const Points& line) {
  constexpr size_t kAhead = 400;
  double worst = 0.0;
  size_t at = 0;
  for (const auto& p : points) {
    double nearest = std::numeric_limits<double>::infinity();
    size_t best = at;
    for (size_t k = at; k + 1 < line.size() && k < at + kAhead; ++k) {
      const double distance = distance_to_segment(p, line[k], line[k + 1]);
      if (distance < nearest) {
        nearest = distance;
        best = k;
      }
    }
    at = best > 2 ? best - 2 : 0;
    worst = std::max(worst, nearest);
  }
  return worst;
}

/// The tool's way, or that of the joints without an arm.
Points way_of(const Trajectory& motion, const RobotModel* arm, int samples) {
  Points way;
  for (const TrajectoryPiece& piece : motion.pieces()) {
    for (int k = 0; k < samples; ++k) {
      const JointVector q = piece.at(piece.duration * k / samples).q;
      way.emplace_back(arm != nullptr ? Eigen::VectorXd(arm->forward().pose(q).translation())
                                      : Eigen::VectorXd(q));
    }
  }
  const JointVector end = motion.at(motion.duration()).q;
  way.emplace_back(arm != nullptr ? Eigen::VectorXd(arm->forward().pose(end).translation())
                                  : Eigen::VectorXd(end));
  return way;
}

size_t merged_points(const PlannedMotion& motion) {
  return static_cast<size_t>(
      std::count_if(motion.corners.begin(), motion.corners.end(),
                    [](const CornerOutcome& corner) { return corner.merged_into.has_value(); }));
}

/// A quarter of a circle of 0.1 m in `count` lines, its points off by a micrometre at most.
Script sampled_arc(const RobotModel& arm, const JointVector& start, int count, Zone zone,
                   Points& taught) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> noise(-1e-6, 1e-6);
  Script script(arm, start);
  const Pose first = arm.forward().pose(start);
  taught = {first.translation()};
  for (int k = 1; k <= count; ++k) {
    const double turn = 0.5 * kPi * k / count;
    Pose pose = first;
    pose.translation() += 0.1 * Eigen::Vector3d(std::sin(turn), 1.0 - std::cos(turn), 0.0) +
                          Eigen::Vector3d(noise(random), noise(random), noise(random));
    script.movel(pose, zone);
    taught.emplace_back(pose.translation());
  }
  return script;
}

TEST(MergedLegs, OfASampledArcStayWithinTheDeviationOfThePolylineBothWays) {
  const RobotPtr arm = robot("ur5e");
  const JointVector start = degrees({10, -80, 110, -120, -90, 10});
  constexpr double kDeviation = 1e-4;
  Points taught;
  Script script = sampled_arc(*arm, start, 1000, {ZoneKind::kDeviation, kDeviation}, taught);
  const PlannedMotion motion = MotionPlanner(arm).plan(script.program());
  EXPECT_TRUE(motion.report.problems.empty()) << motion.report.describe();
  // Every point inside has an outcome, and nearly all of them made no corner.
  EXPECT_EQ(motion.corners.size(), 999u);
  EXPECT_GT(merged_points(motion), 930u);
  for (const CornerOutcome& corner : motion.corners) {
    EXPECT_FALSE(corner.stopped) << corner.reason;
    EXPECT_LE(corner.used, kDeviation);
    if (!corner.merged_into) continue;
    EXPECT_GT(*corner.merged_into, corner.move);
    EXPECT_LE(corner.used, 0.5 * kDeviation);
    EXPECT_EQ(corner.cut, corner.used);
  }
  EXPECT_LE(motion.trajectory.certificate().zone_deviation, kDeviation);
  const double line = LineTolerance().position;
  const Points way = way_of(motion.trajectory, arm.get(), 8);
  EXPECT_LE(farthest_from(way, taught), kDeviation + line);
  EXPECT_LE(farthest_from(taught, way), kDeviation + line + 1e-5);
  EXPECT_TRUE(motion.trajectory.certificate().holds());
}

TEST(MergedLegs, OfSevenJointsEndWhereTheNextLegBegins) {
  const RobotPtr arm = robot("panda");
  const JointVector start = degrees({6, -29, 11, -115, 6, 92, 46});
  Points taught;
  Script script = sampled_arc(*arm, start, 120, {ZoneKind::kDeviation, 1e-4}, taught);
  const PlannedMotion motion = MotionPlanner(arm).plan(script.program());
  EXPECT_GT(merged_points(motion), 60u);
  EXPECT_TRUE(motion.trajectory.certificate().holds());
  const Points way = way_of(motion.trajectory, arm.get(), 8);
  EXPECT_LE(farthest_from(way, taught), 1e-4 + LineTolerance().position);
}

TEST(MergedLegs, AreQuickerThanOnesWithOutputsBetweenThem) {
  const RobotPtr arm = robot("ur5e");
  const JointVector start = degrees({10, -80, 110, -120, -90, 10});
  Points taught;
  Script script = sampled_arc(*arm, start, 200, {ZoneKind::kDeviation, 1e-4}, taught);
  const MotionPlanner planner(arm);
  const PlannedMotion merged = planner.plan(script.program());
  // An output must change at its point, so the point stays.
  Script kept(*arm, start);
  for (const Step& step : script.program().steps) {
    kept.program().steps.push_back(step);
    kept.add(SetOutput{1, true});
  }
  const PlannedMotion whole = planner.plan(kept.program());
  EXPECT_EQ(merged_points(whole), 0u);
  EXPECT_LT(merged.trajectory.duration(), 0.9 * whole.trajectory.duration());
}

TEST(MergedLegs, LeaveNoLegFartherFromItsPointThanTheRadius) {
  const RobotPtr arm = robot("ur5e");
  const JointVector start = degrees({10, -80, 110, -120, -90, 10});
  const Pose first = arm->forward().pose(start);
  const auto merged_with = [&](double radius, double step) {
    Script script(*arm, start);
    for (int k = 1; k <= 2; ++k) {
      Pose pose = first;
      pose.translation() += Eigen::Vector3d(step * k, k == 1 ? 1e-4 : 0.0, 0.0);
      script.movel(pose, {ZoneKind::kRadius, radius});
    }
    return merged_points(MotionPlanner(arm).plan(script.program()));
  };
  // The ends are rests, which allow nothing: the point must reach both.
  EXPECT_EQ(merged_with(0.02, 0.03), 0u);
  EXPECT_EQ(merged_with(0.02, 0.015), 1u);
}

TEST(MergedLegs, KeepPointsThatTurnTheToolOrChangeAWish) {
  const RobotPtr arm = robot("ur5e");
  const JointVector start = degrees({10, -80, 110, -120, -90, 10});
  const Pose first = arm->forward().pose(start);
  const auto merged_with = [&](double turn, double speed, Zone zone) {
    Script script(*arm, start);
    for (int k = 1; k <= 3; ++k) {
      Pose pose = first;
      pose.translation().x() += 0.004 * k;
      if (k == 2) pose.rotate(rotation_exp(Eigen::Vector3d(0.0, 0.0, turn)));
      MoveOptions options;
      options.zone = zone;
      if (k == 2)
        options.speed = speed;
      else
        options.speed = 0.1;
      script.add(LinMove{PoseTarget{pose}}, options);
    }
    return merged_points(MotionPlanner(arm).plan(script.program()));
  };
  const Zone deviation{ZoneKind::kDeviation, 1e-3};
  EXPECT_EQ(merged_with(0.0, 0.1, deviation), 2u);
  EXPECT_EQ(merged_with(0.001, 0.1, deviation), 2u);
  EXPECT_EQ(merged_with(0.05, 0.1, deviation), 0u);
  EXPECT_EQ(merged_with(0.0, 0.05, deviation), 0u);
  Zone tight = deviation;
  tight.angle = 0.002;
  EXPECT_EQ(merged_with(0.001, 0.1, tight), 0u);
  // Within 5 mm of the points lies every place of the line, within 1 mm not.
  EXPECT_EQ(merged_with(0.0, 0.1, {ZoneKind::kRadius, 5e-3}), 2u);
  EXPECT_EQ(merged_with(0.0, 0.1, {ZoneKind::kRadius, 3e-3}),
            1u);  // the first is too far from the rest
  EXPECT_EQ(merged_with(0.0, 0.1, {ZoneKind::kRadius, 1e-3}), 0u);
  EXPECT_EQ(merged_with(0.0, 0.1, {ZoneKind::kJointDeviation, 1e-2}), 0u);
}

/// Joints along a random smooth way in steps of random length, with some sharp turns and some
/// zones of other kinds.
MotionProgram dense_program(const RobotModel& arm, std::mt19937& random, bool tool) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const JointVector start = degrees({10, -80, 110, -120, -90, 10});
  Script script(arm, start);
  JointVector q = start, direction(6);
  for (int i = 0; i < 6; ++i) direction[i] = unit(random);
  Pose pose = arm.forward().pose(start);
  const size_t count = 20 + random() % 60;
  const double size = std::pow(10.0, -3.5 + 0.75 * unit(random));
  for (size_t k = 0; k < count; ++k) {
    const double step = 0.01 * std::pow(10.0, 0.7 * unit(random) - 0.7);
    for (int i = 0; i < 6; ++i) {
      direction[i] += (random() % 15 == 0 ? 1.0 : 0.03) * unit(random);
    }
    direction.normalize();
    Zone zone{tool ? ZoneKind::kDeviation : ZoneKind::kJointDeviation, size};
    if (random() % 12 == 0) zone = {ZoneKind::kRadius, 0.003};
    if (random() % 30 == 0) zone = {};
    if (tool) {
      pose.translation() += step * direction.head<3>();
      pose.rotate(rotation_exp(0.3 * step * Eigen::Vector3d(direction.tail<3>())));
      script.movel(pose, zone);
    } else {
      q += step * direction;
      script.movej(q, zone);
    }
    if (random() % 20 == 0) script.add(SetOutput{2, random() % 2 == 0});
  }
  return script.program();
}

TEST(MergedLegs, OfRandomDenseProgramsKeepEveryZoneInChunksAsInTheWhole) {
  const RobotPtr arm = robot("ur5e");
  const MotionPlanner planner(arm);
  size_t merged = 0, points = 0;
  for (unsigned seed = 0; seed < problems(60U); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const bool tool = seed % 2 == 0;
    const MotionProgram program = dense_program(*arm, random, tool);
    if (!planner.check(program).ok()) continue;
    const PlannedMotion whole = planner.plan(program);
    merged += merged_points(whole);
    points += program.steps.size();
    Points taught = {tool ? Eigen::VectorXd(arm->forward().pose(program.start).translation())
                          : Eigen::VectorXd(program.start)};
    double widest = 0.0;
    for (const Step& step : program.steps) {
      const Zone& zone = step.options.zone;
      if (const auto* line = std::get_if<LinMove>(&step.what)) {
        taught.emplace_back(std::get<PoseTarget>(line->target).pose_base_tool.translation());
        widest = std::max(widest, zone.size);
      } else if (const auto* joints = std::get_if<PtpMove>(&step.what)) {
        taught.emplace_back(std::get<JointTarget>(joints->target).q);
        if (zone.kind == ZoneKind::kJointDeviation) widest = std::max(widest, zone.size);
        // What a zone at the tool lets the joints do is another question.
        if (zone.kind == ZoneKind::kRadius) widest = std::numeric_limits<double>::infinity();
      }
    }
    const double slack = tool ? LineTolerance().position : 1e-9;
    const Points way = way_of(whole.trajectory, tool ? arm.get() : nullptr, 12);
    EXPECT_LE(farthest_from(way, taught), widest + slack);
    // Every point by its own zone.
    for (const CornerOutcome& corner : whole.corners) {
      if (corner.stopped || corner.asked.kind == ZoneKind::kFine) continue;
      EXPECT_LE(corner.used, corner.asked.size * (1.0 + 1e-12));
    }
    MotionProgram head = program;
    head.steps.clear();
    StreamPlanner stream(arm, head);
    Played played(arm->limits());
    for (const Step& step : program.steps) {
      stream.add(step);
      if (random() % 3 == 0) {
        while (const auto chunk = stream.next()) played.add(*chunk);
      }
    }
    stream.end();
    while (const auto chunk = stream.next()) played.add(*chunk);
    played.finish();
    EXPECT_EQ(played.problem, "");
    EXPECT_LE(off_path(played.pieces, whole.trajectory.pieces()), 1e-12);
    ASSERT_EQ(played.corners.size(), whole.corners.size());
    for (size_t k = 0; k < whole.corners.size(); ++k) {
      EXPECT_EQ(played.corners[k].move, whole.corners[k].move);
      EXPECT_EQ(played.corners[k].merged_into, whole.corners[k].merged_into);
      EXPECT_EQ(played.corners[k].used, whole.corners[k].used);
    }
  }
  EXPECT_GT(merged, points / 10);
}

}  // namespace
}  // namespace viapoint::testing_planner
