#include "viapoint/path/corner.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <vector>

#include "path/teaching_arms.hpp"
#include "path/tool_corners.hpp"
#include "problem_count.hpp"
#include "viapoint/core/error.hpp"

namespace viapoint {
namespace {

using testing::tool_corner;
using testing::unit_vector;

JointPath joint_line(const JointVector& a, const JointVector& b, double length) {
  JointPath path;
  path.append(JointPiece::line(a, b, length));
  return path;
}

/// Points of the joint or tool space along a stretch.
using Points = std::vector<Eigen::VectorXd>;

Eigen::VectorXd place(const ForwardKinematics* arm, const JointVector& q) {
  if (arm == nullptr) return q;
  return arm->pose(q).translation();
}

Points along(const ForwardKinematics* arm, const JointPath& path, double s0, double s1, int count) {
  Points points;
  for (int i = 0; i <= count; ++i) {
    points.push_back(place(arm, path.at(s0 + (s1 - s0) * i / count).q));
  }
  return points;
}

double distance_to_segment(const Eigen::VectorXd& p, const Eigen::VectorXd& a,
                           const Eigen::VectorXd& b) {
  const Eigen::VectorXd along = b - a;
  const double square = along.squaredNorm();
  const double share = square > 0.0 ? std::clamp(along.dot(p - a) / square, 0.0, 1.0) : 0.0;
  return (p - a - share * along).norm();
}

/// Largest distance of points of a from the polyline b.
double farthest_from(const Points& a, const Points& b) {
  double worst = 0.0;
  for (const auto& p : a) {
    double nearest = std::numeric_limits<double>::infinity();
    for (size_t k = 0; k + 1 < b.size(); ++k) {
      nearest = std::min(nearest, distance_to_segment(p, b[k], b[k + 1]));
    }
    worst = std::max(worst, nearest);
  }
  return worst;
}

/// Distance both ways between the blend and the parts of the legs it replaces, by samples.
double sampled_hausdorff(const ForwardKinematics* arm, const Corner& corner,
                         const JointPath& before, const JointPath& after, int count = 100) {
  JointPath blend;
  blend.append(corner.blend);
  const Points of_blend = along(arm, blend, 0.0, blend.length(), 2 * count);
  Points of_legs = along(arm, before, before.length() - corner.cut_before, before.length(), count);
  const Points second = along(arm, after, 0.0, corner.cut_after, count);
  of_legs.insert(of_legs.end(), second.begin(), second.end());
  return std::max(farthest_from(of_blend, of_legs), farthest_from(of_legs, of_blend));
}

void expect_smooth_joins(const Corner& corner, const JointPath& before, const JointPath& after) {
  ASSERT_EQ(corner.blend.kind, PieceKind::kBlend);
  const PathPoint leave = before.at(before.length() - corner.cut_before);
  const PathPoint start = corner.blend.at(0.0);
  PathPoint arrive = after.at(corner.cut_after);
  const PathPoint end = corner.blend.at(corner.blend.length);
  arrive.q1 /= corner.scale_after;
  arrive.q2 /= corner.scale_after * corner.scale_after;
  const double s1 = 1.0 + leave.q1.norm();
  const double s2 =
      1.0 + leave.q2.norm() + arrive.q2.norm() + 1.0 / (corner.blend.length * corner.blend.length);
  ASSERT_LT((leave.q - start.q).norm(), 1e-12);
  ASSERT_LT((leave.q1 - start.q1).norm(), 1e-10 * s1);
  ASSERT_LT((leave.q2 - start.q2).norm(), 1e-10 * s2);
  ASSERT_LT((arrive.q - end.q).norm(), 1e-12);
  ASSERT_LT((arrive.q1 - end.q1).norm(), 1e-10 * s1);
  ASSERT_LT((arrive.q2 - end.q2).norm(), 1e-9 * s2);
}

TEST(RoundCorner, PutsTheInnerControlPointsOnTheCorner) {
  const JointVector u1 = JointVector::Unit(2, 0);
  const JointVector u2 = JointVector::Unit(2, 1);
  const JointPath before = joint_line(-u1, JointVector::Zero(2), 1.0);
  const JointPath after = joint_line(JointVector::Zero(2), u2, 1.0);
  const Corner corner =
      round_corner(nullptr, before, after, {ZoneKind::kJointDeviation, 0.01}, 1.0, 1.0);
  ASSERT_TRUE(corner.possible) << corner.reason;
  EXPECT_TRUE(corner.reason.empty()) << corner.reason;
  const double d = corner.cut_before;
  EXPECT_NEAR(corner.cut_after, d, 1e-9);
  EXPECT_NEAR(corner.scale_after, 1.0, 1e-9);
  EXPECT_NEAR(corner.blend.length, 2.5 * d, 1e-9);
  // 0.109375 · d · ‖u2 − u1‖ at the middle, all of the 0.01 rad used.
  const JointVector middle = corner.blend.at(0.5 * corner.blend.length).q;
  EXPECT_NEAR(middle.norm(), 0.109375 * d * std::sqrt(2.0), 1e-9);
  EXPECT_GE(middle.norm(), 0.0099);
  EXPECT_LE(corner.used, 0.01);
  EXPECT_GE(corner.used, 0.0099);
  EXPECT_EQ(corner.tool_deviation, 0.0);
  const JointVector third = corner.blend.at(0.0).q + corner.blend.at(0.0).q1 * 0.4 * 2.5 * d;
  EXPECT_LT(third.norm(), 1e-9);
}

TEST(RoundCorner, UsesAJointZoneFullyOnThousandsOfJointLines) {
  int full = 0;
  for (unsigned seed = 0; seed < problems(3000U); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const int joints = 2 + static_cast<int>(seed % 6);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    const auto leg = [&] { return std::exp(-6.0 + 6.5 * uniform(random)); };
    const double leg1 = leg();
    const double leg2 = leg();
    const JointVector u1 = unit_vector(random, joints);
    const JointVector u2 = unit_vector(random, joints);
    const JointVector zero = JointVector::Zero(joints);
    // Any parameter lengths: s of one leg has nothing to do with s of the other.
    const JointPath before = joint_line(-leg1 * u1, zero, leg());
    const JointPath after = joint_line(zero, leg2 * u2, leg());
    const double size = std::exp(-8.0 + 6.0 * uniform(random));
    const double share = 0.5 + 0.5 * uniform(random);
    const Corner corner = round_corner(nullptr, before, after, {ZoneKind::kJointDeviation, size},
                                       share * before.length(), share * after.length());
    if (!corner.possible) {
      ASSERT_GT(std::acos(u1.dot(u2)), 177.9 * kDegree) << corner.reason;
      continue;
    }
    ASSERT_NO_FATAL_FAILURE(expect_smooth_joins(corner, before, after));
    ASSERT_LE(corner.cut_before, share * before.length() * (1 + 1e-12));
    ASSERT_LE(corner.cut_after, share * after.length() * (1 + 1e-12));
    ASSERT_LE(corner.used, size);
    const double truth = sampled_hausdorff(nullptr, corner, before, after, 40);
    ASSERT_LE(truth, 1.01 * corner.used + 1e-12);
    if (corner.reason.empty()) {
      // A turn of less than a degree has nothing to cut off, however far back the cut.
      if (u1.dot(u2) > std::cos(1.0 * kDegree)) continue;
      ASSERT_GE(corner.used, 0.99 * size);
      ASSERT_GE(truth, 0.98 * size);
      ++full;
    } else {
      // Limited by room: one leg at least is used up.
      const bool all_before = corner.cut_before > 0.999 * share * before.length();
      const bool all_after = corner.cut_after > 0.999 * share * after.length();
      ASSERT_TRUE(all_before || all_after) << corner.reason;
    }
  }
  EXPECT_GT(full, problems(500));
}

TEST(RoundCorner, StaysWithinTheRadiusAndUsesIt) {
  const ForwardKinematics arm = testing::puma560();
  int full = 0;
  for (unsigned seed = 0; seed < problems(400U); ++seed) {
    SCOPED_TRACE(seed);
    const auto legs = tool_corner(arm, seed);
    if (!legs) continue;
    const double radius = 0.005 + 0.01 * (seed % 4);
    const Corner corner = round_corner(&arm, legs->before, legs->after, {ZoneKind::kRadius, radius},
                                       0.9 * legs->before.length(), 0.9 * legs->after.length());
    ASSERT_TRUE(corner.possible) << corner.reason;
    ASSERT_NO_FATAL_FAILURE(expect_smooth_joins(corner, legs->before, legs->after));
    ASSERT_LE(corner.used, radius);
    double farthest = 0.0;
    JointPath blend;
    blend.append(corner.blend);
    const double length1 = legs->before.length();
    for (const Points& points :
         {along(&arm, blend, 0.0, blend.length(), 500),
          along(&arm, legs->before, length1 - corner.cut_before, length1, 500),
          along(&arm, legs->after, 0.0, corner.cut_after, 500)}) {
      for (const auto& p : points)
        farthest = std::max(farthest, (p - legs->corner.translation()).norm());
    }
    // The corner's own tool point may lie an insertion tolerance away from the given one.
    ASSERT_LE(farthest, radius + 1e-7);
    const double truth = sampled_hausdorff(&arm, corner, legs->before, legs->after);
    ASSERT_LE(truth, corner.tool_deviation * 1.02 + 1e-6);
    if (corner.reason.empty()) {
      ASSERT_GE(farthest, 0.99 * radius);
      ++full;
    }
  }
  EXPECT_GT(full, problems(150));
}

TEST(RoundCorner, UsesAToolDeviationFully) {
  const ForwardKinematics arm = testing::puma560();
  int full = 0;
  for (unsigned seed = 0; seed < problems(300U); ++seed) {
    SCOPED_TRACE(seed);
    const auto legs = tool_corner(arm, seed);
    if (!legs) continue;
    const double size = 0.0005 * (1 + seed % 6);
    const Corner corner =
        round_corner(&arm, legs->before, legs->after, {ZoneKind::kDeviation, size},
                     0.9 * legs->before.length(), 0.9 * legs->after.length());
    ASSERT_TRUE(corner.possible) << corner.reason;
    ASSERT_NO_FATAL_FAILURE(expect_smooth_joins(corner, legs->before, legs->after));
    ASSERT_LE(corner.used, size);
    ASSERT_EQ(corner.used, corner.tool_deviation);
    const double truth = sampled_hausdorff(&arm, corner, legs->before, legs->after, 100);
    ASSERT_LE(truth, corner.used * 1.01 + 1e-7);
    if (corner.reason.empty()) {
      ASSERT_GE(corner.used, 0.99 * size);
      ASSERT_GE(truth, 0.99 * size);
      ++full;
    }
  }
  EXPECT_GT(full, problems(100));
}

TEST(RoundCorner, TellsTheToolDeviationOfAJointZone) {
  const ForwardKinematics arm = testing::puma560();
  const JointVector a = testing::joints_in_degrees({10, 40, 20, 30, 40, 10});
  const JointVector b = testing::joints_in_degrees({40, 20, 40, -10, 70, 60});
  const JointVector c = testing::joints_in_degrees({20, 50, 10, 20, 10, 90});
  const JointPath before = joint_line(a, b, 1.0);
  const JointPath after = joint_line(b, c, 1.0);
  const Corner corner =
      round_corner(&arm, before, after, {ZoneKind::kJointDeviation, 0.05}, 0.9, 0.9);
  ASSERT_TRUE(corner.possible);
  EXPECT_GE(corner.used, 0.0495);
  EXPECT_LE(corner.used, 0.05);
  const double truth = sampled_hausdorff(&arm, corner, before, after, 200);
  EXPECT_GT(truth, 0.001);
  EXPECT_LE(truth, corner.tool_deviation * 1.001);
  EXPECT_GE(truth, corner.tool_deviation * 0.5);
}

TEST(RoundCorner, IsLimitedByAShortLegAndSaysSo) {
  const JointVector u1 = JointVector::Unit(3, 0);
  const JointVector u2 = JointVector::Unit(3, 1);
  const JointVector zero = JointVector::Zero(3);
  const JointPath before = joint_line(-1e-4 * u1, zero, 1e-4);
  const JointPath after = joint_line(zero, u2, 1.0);
  const Corner corner =
      round_corner(nullptr, before, after, {ZoneKind::kJointDeviation, 0.05}, 0.5e-4, 0.5);
  ASSERT_TRUE(corner.possible);
  EXPECT_FALSE(corner.reason.empty());
  EXPECT_DOUBLE_EQ(corner.cut_before, 0.5e-4);
  EXPECT_NEAR(corner.cut_after, 2e-4, 1e-9);  // four times the shorter at most
  EXPECT_LT(corner.used, 0.05);
  ASSERT_NO_FATAL_FAILURE(expect_smooth_joins(corner, before, after));
}

TEST(RoundCorner, StopsAtAReversalAndWithoutRoom) {
  const JointVector u = JointVector::Unit(2, 0);
  const JointVector zero = JointVector::Zero(2);
  const JointPath before = joint_line(-u, zero, 1.0);
  const Zone zone = {ZoneKind::kJointDeviation, 0.01};
  const auto turned = [&](double angle) {
    return joint_line(zero, JointVector(Eigen::Vector2d(std::cos(angle), std::sin(angle))), 1.0);
  };
  const Corner reversal = round_corner(nullptr, before, turned(kPi), zone, 1.0, 1.0);
  EXPECT_FALSE(reversal.possible);
  EXPECT_FALSE(reversal.reason.empty());
  EXPECT_FALSE(round_corner(nullptr, before, turned(178.5 * kDegree), zone, 1, 1).possible);
  EXPECT_TRUE(round_corner(nullptr, before, turned(177.0 * kDegree), zone, 1, 1).possible);
  const Corner no_room = round_corner(nullptr, before, turned(1.0), zone, 0.0, 1.0);
  EXPECT_FALSE(no_room.possible);
  EXPECT_FALSE(no_room.reason.empty());
  EXPECT_FALSE(round_corner(nullptr, before, turned(1.0), {ZoneKind::kFine, 0}, 1, 1).possible);
  EXPECT_FALSE(round_corner(nullptr, before, turned(1.0), {ZoneKind::kRadius, 0.1}, 1, 1).possible);
}

TEST(RoundCorner, SaysWhyThereIsNoCorner) {
  const JointVector u1 = JointVector::Unit(2, 0);
  const JointVector u2 = JointVector::Unit(2, 1);
  const JointVector zero = JointVector::Zero(2);
  const JointPath before = joint_line(-u1, zero, 1.0);
  const auto reason = [&](const JointPath& after, double size, double room) {
    const Corner corner =
        round_corner(nullptr, before, after, {ZoneKind::kJointDeviation, size}, room, room);
    EXPECT_FALSE(corner.possible);
    return corner.reason;
  };
  const JointPath straight = joint_line(zero, u2, 1.0);
  EXPECT_NE(reason(straight, 0.02, 1e-9).find("too short"), std::string::npos);
  EXPECT_NE(reason(straight, 1e-9, 0.5).find("zone is too small"), std::string::npos);
  // The leg after leaves the zone right at the corner, comes back, and stays near for long: no
  // corner that cuts it keeps the zone, though both legs are long.
  const ForwardKinematics arm = testing::rpp();  // joints 2 and 3 slide the tool up and outwards
  const auto at = [](double up, double out) {
    return JointVector(Eigen::Vector3d(0.0, up, 0.5 + out));
  };
  const auto knot = [&](double out, double rate) {
    const JointVector zero3 = JointVector::Zero(3);
    return PathPoint{at(0.0, out), rate * JointVector::Unit(3, 2), zero3, zero3};
  };
  JointPath stray;
  stray.append(JointPiece::hermite(knot(0.0, 1.0), knot(0.4, 0.0), 1e-3));
  stray.append(JointPiece::hermite(knot(0.4, 0.0), knot(0.001, 0.0), 1e-3));
  stray.append(JointPiece::hermite(knot(0.001, 0.0), knot(0.1, 0.1), 1.0));
  const Corner refuted = round_corner(&arm, joint_line(at(-1.0, 0.0), at(0.0, 0.0), 1.0), stray,
                                      {ZoneKind::kRadius, 0.02}, 0.9, 0.9);
  EXPECT_FALSE(refuted.possible);
  EXPECT_NE(refuted.reason.find("proven"), std::string::npos) << refuted.reason;
  EXPECT_EQ(refuted.reason.find("too short"), std::string::npos) << refuted.reason;
}

TEST(RoundCorner, GoesStraightOnWhereNothingTurns) {
  const JointVector u = JointVector::Ones(4).normalized();
  const JointVector zero = JointVector::Zero(4);
  // The same direction at another rate by s, and turns of next to nothing.
  for (const double angle : {0.0, 1e-15, 1e-9, 1e-5}) {
    SCOPED_TRACE(angle);
    JointVector v = u;
    v += angle * JointVector::Unit(4, 2);
    const JointPath before = joint_line(-0.5 * u, zero, 1.0);
    const JointPath after = joint_line(zero, 0.3 * v, 7.0);
    const Corner corner =
        round_corner(nullptr, before, after, {ZoneKind::kJointDeviation, 0.01}, 0.5, 3.5);
    ASSERT_TRUE(corner.possible) << corner.reason;
    EXPECT_TRUE(corner.reason.empty()) << corner.reason;
    ASSERT_NO_FATAL_FAILURE(expect_smooth_joins(corner, before, after));
    EXPECT_LE(corner.used, 0.01);
    // On the line, and never backwards.
    for (int i = 0; i <= 100; ++i) {
      const PathPoint point = corner.blend.at(corner.blend.length * i / 100);
      EXPECT_LT((point.q - u * u.dot(point.q)).norm(), 1e-14 + angle);
      EXPECT_GT(u.dot(point.q1), 0.0);
    }
  }
}

TEST(RoundCorner, RefusesLegsThatDoNotMeet) {
  const JointVector zero = JointVector::Zero(2);
  const JointVector one = JointVector::Ones(2);
  const JointPath leg = joint_line(zero, one, 1.0);
  const Zone zone = {ZoneKind::kJointDeviation, 0.01};
  EXPECT_THROW((void)round_corner(nullptr, leg, leg, zone, 1.0, 1.0), MotionError);
  EXPECT_THROW((void)round_corner(nullptr, JointPath(), leg, zone, 1.0, 1.0), MotionError);
}

}  // namespace
}  // namespace viapoint
