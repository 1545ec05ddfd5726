// Zones that bound the tool's orientation besides its position.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "path/tool_corners.hpp"
#include "problem_count.hpp"
#include "viapoint/path/corner.hpp"

namespace viapoint {
namespace {

using testing::tool_corner;
using testing::ToolCorner;

constexpr int kSamples = 100;

/// Poses along a stretch, both ends included.
std::vector<Pose> poses(const ForwardKinematics& arm, const JointPath& path, double s0, double s1) {
  std::vector<Pose> found;
  for (int k = 0; k <= kSamples; ++k) {
    found.push_back(arm.pose(path.at(s0 + (s1 - s0) * k / kSamples).q));
  }
  return found;
}

struct Rounded {
  std::vector<Pose> blend, legs;
};

Rounded sampled(const ForwardKinematics& arm, const ToolCorner& legs, const Corner& corner) {
  JointPath blend;
  blend.append(corner.blend);
  Rounded rounded{
      poses(arm, blend, 0.0, blend.length()),
      poses(arm, legs.before, legs.before.length() - corner.cut_before, legs.before.length())};
  const auto second = poses(arm, legs.after, 0.0, corner.cut_after);
  rounded.legs.insert(rounded.legs.end(), second.begin(), second.end());
  return rounded;
}

double farthest_from(const std::vector<Pose>& some, const Pose& corner) {
  double worst = 0.0;
  for (const Pose& pose : some) {
    worst = std::max(worst, rotation_distance(pose.linear(), corner.linear()));
  }
  return worst;
}

/// Largest angle of an orientation of `some` from the nearest of `others`.
double farthest_from(const std::vector<Pose>& some, const std::vector<Pose>& others) {
  double worst = 0.0;
  for (const Pose& pose : some) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Pose& other : others) {
      nearest = std::min(nearest, rotation_distance(pose.linear(), other.linear()));
    }
    worst = std::max(worst, nearest);
  }
  return worst;
}

double largest_step(const std::vector<Pose>& some) {
  double step = 0.0;
  for (size_t k = 1; k < some.size(); ++k) {
    step = std::max(step, rotation_distance(some[k - 1].linear(), some[k].linear()));
  }
  return step;
}

/// How many corners one or the other bound ruled.
struct Ruled {
  int by_angle = 0, by_size = 0;
};

template <typename Check>
Ruled round_many(ZoneKind kind, double size, const Check& check) {
  const ForwardKinematics arm = testing::puma560();
  Ruled ruled;
  for (unsigned seed = 0; seed < problems(300U); ++seed) {
    SCOPED_TRACE(seed);
    const auto legs = tool_corner(arm, seed);
    if (!legs) continue;
    Zone zone{kind, size * (1 + seed % 4)};
    zone.angle = 0.004 * (1 + seed % 7);
    const Corner corner = round_corner(&arm, legs->before, legs->after, zone,
                                       0.9 * legs->before.length(), 0.9 * legs->after.length());
    EXPECT_TRUE(corner.possible) << corner.reason;
    if (!corner.possible) continue;
    EXPECT_LE(corner.used, zone.size);
    EXPECT_LE(corner.used_angle, zone.angle);
    EXPECT_EQ(corner.angle_rules, corner.used_angle / zone.angle > corner.used / zone.size);
    if (corner.reason.empty()) {
      EXPECT_GE(std::max(corner.used_angle / zone.angle, corner.used / zone.size), 0.985);
    }
    ++(corner.angle_rules ? ruled.by_angle : ruled.by_size);
    check(*legs, corner, sampled(arm, *legs, corner));
  }
  return ruled;
}

TEST(ZoneWithAngle, KeepsTheOrientationNearThatAtThePointOfARadius) {
  const Ruled ruled = round_many(
      ZoneKind::kRadius, 0.005, [](const ToolCorner& legs, const Corner& corner, const Rounded& r) {
        const double reached =
            std::max(farthest_from(r.blend, legs.corner), farthest_from(r.legs, legs.corner));
        // The legs meet the corner's pose as nearly as they were inserted.
        EXPECT_LE(reached, corner.used_angle + 1e-4);
        if (corner.reason.empty() && corner.angle_rules) {
          EXPECT_GE(reached, 0.97 * corner.used_angle - 1e-4);
        }
      });
  EXPECT_GT(ruled.by_angle, problems(50));
  EXPECT_GT(ruled.by_size, problems(10));
}

TEST(ZoneWithAngle, KeepsTheOrientationOfTheLegsWithinADeviation) {
  const Ruled ruled =
      round_many(ZoneKind::kDeviation, 0.001,
                 [](const ToolCorner& /*legs*/, const Corner& corner, const Rounded& r) {
                   const double step = std::max(largest_step(r.blend), largest_step(r.legs));
                   EXPECT_LE(farthest_from(r.blend, r.legs), corner.used_angle + step);
                   EXPECT_LE(farthest_from(r.legs, r.blend), corner.used_angle + step);
                 });
  EXPECT_GT(ruled.by_angle, problems(30));
  EXPECT_GT(ruled.by_size, problems(30));
}

TEST(ZoneWithAngle, IsTheSameAsWithoutWhereTheAngleIsWide) {
  const ForwardKinematics arm = testing::puma560();
  for (const ZoneKind kind : {ZoneKind::kRadius, ZoneKind::kDeviation}) {
    for (unsigned seed = 0; seed < 20; ++seed) {
      SCOPED_TRACE(seed);
      const auto legs = tool_corner(arm, seed);
      if (!legs) continue;
      Zone zone{kind, 0.002};
      const auto round = [&] {
        return round_corner(&arm, legs->before, legs->after, zone, legs->before.length(),
                            legs->after.length());
      };
      const Corner without = round();
      zone.angle = 3.0;
      const Corner with = round();
      EXPECT_EQ(with.cut_before, without.cut_before);
      EXPECT_EQ(with.cut_after, without.cut_after);
      EXPECT_EQ(without.used_angle, 0.0);
      EXPECT_GT(with.used_angle, 0.0);
      EXPECT_FALSE(with.angle_rules);
    }
  }
}

TEST(ZoneWithAngle, SaysWhetherItsAngleOrItsSizeLeavesNoCorner) {
  const ForwardKinematics arm = testing::puma560();
  for (const ZoneKind kind : {ZoneKind::kRadius, ZoneKind::kDeviation}) {
    unsigned seen = 0;
    for (unsigned seed = 0; seed < 40; ++seed) {
      SCOPED_TRACE(seed);
      const auto legs = tool_corner(arm, seed);
      if (!legs) continue;
      ++seen;
      const auto round = [&](double size, double angle) {
        Zone zone{kind, size};
        zone.angle = angle;
        return round_corner(&arm, legs->before, legs->after, zone, legs->before.length(),
                            legs->after.length());
      };
      const Corner by_angle = round(0.01, 1e-10);
      EXPECT_FALSE(by_angle.possible);
      EXPECT_TRUE(by_angle.angle_rules);
      EXPECT_EQ(by_angle.reason, "the zone's angle is too small for a corner");
      const Corner by_size = round(1e-10, 0.5);
      EXPECT_FALSE(by_size.possible);
      EXPECT_FALSE(by_size.angle_rules);
      EXPECT_EQ(by_size.reason, "the zone is too small for a corner");
      EXPECT_EQ(round(1e-10, 1e-13).reason, by_angle.reason);
      EXPECT_EQ(round(1e-13, 1e-10).reason, by_size.reason);
    }
    EXPECT_GT(seen, 10U);
  }
}

TEST(ZoneWithAngle, MeansNothingToAnArmWithoutATool) {
  JointPath before, after;
  before.append(JointPiece::line(JointVector::Zero(2), JointVector::Unit(2, 0), 1.0));
  after.append(JointPiece::line(JointVector::Unit(2, 0), JointVector::Ones(2), 1.0));
  Zone zone{ZoneKind::kJointDeviation, 0.01};
  EXPECT_TRUE(round_corner(nullptr, before, after, zone, 0.5, 0.5).possible);
  zone.angle = 0.1;
  const Corner corner = round_corner(nullptr, before, after, zone, 0.5, 0.5);
  EXPECT_FALSE(corner.possible);
  EXPECT_NE(corner.reason.find("no tool"), std::string::npos);
}

}  // namespace
}  // namespace viapoint
