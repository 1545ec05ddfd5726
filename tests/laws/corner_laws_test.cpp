/// The laws of corners: they keep their zone, both ways, and use the whole of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "corner_subjects.hpp"

namespace viapoint::laws {
namespace {

constexpr int kSamples = 2000;

/// Joints at even steps of a path between s0 and s1.
std::vector<JointVector> joints_along(const JointPath& path, double s0, double s1) {
  std::vector<JointVector> points;
  points.reserve(kSamples + 1);
  for (int i = 0; i <= kSamples; ++i) points.push_back(path.at(s0 + (s1 - s0) * i / kSamples).q);
  return points;
}

/// Largest distance of a point of `from` from the nearest of `to`: at most half a step of `to` too
/// large.
double farthest(const std::vector<JointVector>& from, const std::vector<JointVector>& to) {
  double worst = 0.0;
  for (const JointVector& a : from) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const JointVector& b : to) nearest = std::min(nearest, (a - b).norm());
    worst = std::max(worst, nearest);
  }
  return worst;
}

double largest_step(const std::vector<JointVector>& points) {
  double step = 0.0;
  for (size_t i = 1; i < points.size(); ++i) {
    step = std::max(step, (points[i] - points[i - 1]).norm());
  }
  return step;
}

class CornerLaws : public ::testing::TestWithParam<Subject<CornerCase>> {};

TEST_P(CornerLaws, KeepsItsZone) {
  const CornerCase subject = GetParam().make();
  const Corner& corner = subject.corner;
  EXPECT_LE(corner.used, subject.zone.size * (1 + 1e-12));
  const double leave = subject.before.length() - corner.cut_before;
  auto legs = joints_along(subject.before, leave, subject.before.length());
  const auto second = joints_along(subject.after, 0.0, corner.cut_after);
  legs.insert(legs.end(), second.begin(), second.end());

  if (subject.zone.kind == ZoneKind::kJointDeviation) {
    JointPath blend;
    blend.append(corner.blend);
    const auto rounded = joints_along(blend, 0.0, blend.length());
    const double step = std::max(largest_step(legs), largest_step(rounded));
    const double reached = std::max(farthest(rounded, legs), farthest(legs, rounded));
    EXPECT_LE(reached, corner.used + 0.5 * step);
    // Proven, yet not wasteful.
    EXPECT_GE(reached, 0.9 * corner.used - step);
  } else {
    ASSERT_EQ(subject.zone.kind, ZoneKind::kRadius);
    const auto tool = [&](const JointVector& q) {
      return Eigen::Vector3d(subject.arm->forward().pose(q).translation());
    };
    const Eigen::Vector3d point = tool(subject.after.at(0.0).q);
    for (const JointVector& q : legs) ASSERT_LE((tool(q) - point).norm(), corner.used + 1e-9);
  }
}

TEST_P(CornerLaws, UsesItsZoneUnlessItSaysWhyNot) {
  const CornerCase subject = GetParam().make();
  if (subject.corner.reason.empty()) {
    EXPECT_GE(subject.corner.used, 0.9 * subject.zone.size);
  } else {
    EXPECT_LT(subject.corner.used, subject.zone.size);
  }
  EXPECT_LE(subject.corner.cut_before, 0.5 * subject.before.length() * (1 + 1e-12));
  EXPECT_LE(subject.corner.cut_after, 0.5 * subject.after.length() * (1 + 1e-12));
}

INSTANTIATE_TEST_SUITE_P(Corners, CornerLaws, ::testing::ValuesIn(corners()), SubjectName());

}  // namespace
}  // namespace viapoint::laws
