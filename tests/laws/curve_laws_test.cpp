/// The laws of tool curves: exact derivatives of position and rotation, and true bounds.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "path_subjects.hpp"

namespace viapoint::laws {
namespace {

using CurvePtr = std::shared_ptr<const TaskCurve>;

class CurveLaws : public ::testing::TestWithParam<Subject<CurvePtr>> {};

TEST_P(CurveLaws, DerivativesAreThoseOfTheValue) {
  const CurvePtr curve = GetParam().make();
  std::mt19937_64 random(11);
  const double step = 1e-5 * curve->length();
  std::uniform_real_distribution<double> along(2 * step, curve->length() - 2 * step);
  for (int i = 0; i < 500; ++i) {
    const double s = along(random);
    // Across a jump of the third derivative a difference is none of either side.
    if (curve->last_break(s - 2 * step, s + 2 * step) < s + 2 * step) continue;
    const CurvePoint here = curve->at(s);
    const CurvePoint before = curve->at(s - step);
    const CurvePoint after = curve->at(s + step);
    const CurvePoint long_before = curve->at(s - 2 * step);
    const CurvePoint long_after = curve->at(s + 2 * step);
    // From the changes over two steps and over four, exact up to the fourth order.
    const auto expect_near = [&](const Eigen::Vector3d& derivative, const Eigen::Vector3d& change,
                                 const Eigen::Vector3d& far_change) {
      const Eigen::Vector3d difference = (8.0 * change - far_change) / (12.0 * step);
      ASSERT_LE((derivative - difference).norm(),
                1e-7 * (1.0 + derivative.norm()) / std::min(1.0, curve->length()));
    };
    expect_near(here.p1, after.p - before.p, long_after.p - long_before.p);
    expect_near(here.p2, after.p1 - before.p1, long_after.p1 - long_before.p1);
    expect_near(here.p3, after.p2 - before.p2, long_after.p2 - long_before.p2);
    expect_near(here.w1, after.w - before.w, long_after.w - long_before.w);
    expect_near(here.w2, after.w1 - before.w1, long_after.w1 - long_before.w1);
    // R' = [w]× R, by the rotation between two neighbours in the base frame.
    expect_near(here.w, rotation_log(after.rotation * before.rotation.transpose()),
                rotation_log(long_after.rotation * long_before.rotation.transpose()));
  }
}

TEST_P(CurveLaws, RotationsAreRotations) {
  const CurvePtr curve = GetParam().make();
  for (int i = 0; i <= 100; ++i) {
    const Eigen::Matrix3d r = curve->at(curve->length() * i / 100).rotation;
    EXPECT_LE((r * r.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-14);
    EXPECT_NEAR(r.determinant(), 1.0, 1e-14);
  }
}

TEST_P(CurveLaws, BoundsHoldInTheirInterval) {
  const CurvePtr curve = GetParam().make();
  std::mt19937_64 random(12);
  std::uniform_real_distribution<double> along(0.0, curve->length());
  for (int i = 0; i < 200; ++i) {
    double s0 = along(random);
    double s1 = along(random);
    if (s1 < s0) std::swap(s0, s1);
    const CurveBounds bounds = curve->bounds(s0, s1);
    for (int k = 0; k <= 20; ++k) {
      const CurvePoint here = curve->at(s0 + (s1 - s0) * k / 20);
      ASSERT_LE(here.p3.norm(), bounds.p3 + 1e-12);
      ASSERT_LE(here.w.norm(), bounds.w + 1e-12);
      ASSERT_LE(here.w1.norm(), bounds.w1 + 1e-12);
      ASSERT_LE(here.w2.norm(), bounds.w2 + 1e-12);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Curves, CurveLaws, ::testing::ValuesIn(tool_curves()), SubjectName());

}  // namespace
}  // namespace viapoint::laws
