// Speeds, scales and lengths many decades away from everyday.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "problem_count.hpp"
#include "trajectory/time_parameterizer_problems.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/profile/jerk_profile.hpp"
#include "viapoint/trajectory/certificate.hpp"
#include "viapoint/trajectory/time_parameterizer.hpp"

namespace viapoint::testing {
namespace {

/// Two legs of about half a radian with a rounded corner.
JointPath two_legs(double scale) {
  Random random(7);
  const JointPath plain = cornered_path(random_walk(random, 6, 2, 0.3, 0.6), 0.01);
  JointPath path;
  for (JointPiece piece : plain.pieces()) {
    piece.scale = scale;
    path.append(piece);
  }
  return path;
}

void expect_finite(const std::vector<TrajectoryPiece>& pieces) {
  ASSERT_FALSE(pieces.empty());
  for (const TrajectoryPiece& piece : pieces) {
    ASSERT_TRUE(std::isfinite(piece.duration) && piece.duration > 0.0) << piece.duration;
    for (double c : piece.timing) ASSERT_TRUE(std::isfinite(c));
  }
}

TEST(ExtremeLimits, TimeACornerOrRefuseItByName) {
  for (const double tiny : {1e-10, 1e-30, 1e-100, 1e-160, 1e-300}) {
    SCOPED_TRACE(::testing::Message() << "scale " << tiny);
    try {
      expect_finite(parameterize(two_legs(tiny), arm_limits()));
    } catch (const MotionError& error) {
      EXPECT_EQ(error.code(), ErrorCode::kBadArgument) << error.what();
    }
  }
}

/// The end is reached at rest, no limit is left anywhere, and the time is that of the seven phases.
TEST(ExtremeLimits, TimeALineExactlyWhateverTheRatioOfLimits) {
  for (std::uint64_t seed = 0; seed < problems<std::uint64_t>(5000); ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    Random random(seed);
    const double length = decades(random, 1e-6, 1e6);
    const double v = decades(random, 1e-9, 1e12), a = decades(random, 1e-9, 1e12);
    const double j = decades(random, 1e-9, 1e12);
    const double scale = seed % 2 == 0 ? 1.0 : decades(random, 1e-12, 1.0);
    const auto one = [](double x) { return JointVector(JointVector::Constant(1, x)); };
    JointLimits limits = limits_of(one(v), one(a), one(j));
    limits.position_min *= 10.0;
    limits.position_max *= 10.0;
    JointPath path;
    const double from = seed % 3 == 0 ? 0.0 : uniform(random, -1.0, 1.0) * length;
    const int count = 1 + static_cast<int>(seed % 4);
    for (int k = 0; k < count; ++k) {
      JointPiece piece = JointPiece::line(one(from + length * k / count),
                                          one(from + length * (k + 1) / count), 1.0 / count);
      piece.scale = scale;
      path.append(piece);
    }
    const auto pieces = parameterize(path, limits);
    const double exact = rest_to_rest(length, v * scale, a * scale, j * scale).total();
    ASSERT_NEAR(duration_of(pieces) / exact, 1.0, 1e-9);
    const Certificate certificate = certify(pieces, limits);
    ASSERT_TRUE(certificate.holds()) << certificate.problems.front().describe();
    const double most = (1.0 + 1e-9) * scale;
    ASSERT_LE(certificate.velocity[0].share, most);
    ASSERT_LE(certificate.acceleration[0].share, most);
    ASSERT_LE(certificate.jerk[0].share, most);
    ASSERT_NEAR(pieces.front().at(0.0).q[0], from, 1e-15 * length);
    ASSERT_NEAR(pieces.back().at(pieces.back().duration).q[0], from + length, 1e-14 * length);
  }
}

TEST(ExtremeLimits, NameWhatIsExtreme) {
  try {
    (void)parameterize(two_legs(1e-300), arm_limits());
    FAIL() << "1e300 s are not refused";
  } catch (const MotionError& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadArgument);
    EXPECT_NE(error.problem().message.find("scale of limits, which is 1e-300"), std::string::npos)
        << error.what();
  }
}

/// Corners under limits of any size: certified, ends met, or refused as too extreme.
TEST(ExtremeLimits, TimeCornersWhateverTheRatioOfLimits) {
  for (std::uint64_t seed = 0; seed < problems<std::uint64_t>(1000); ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    Random random(seed);
    const int joints = 1 + static_cast<int>(seed % 4) + 1;
    const double size = decades(random, 1e-6, 1e3);
    const JointPath plain = cornered_path(random_walk(random, joints, 2, size, 3 * size),
                                          size * decades(random, 1e-3, 0.1));
    JointVector v(joints), a(joints), j(joints);
    for (int i = 0; i < joints; ++i) {
      v[i] = decades(random, 1e-9, 1e12);
      a[i] = decades(random, 1e-9, 1e12);
      j[i] = decades(random, 1e-9, 1e12);
    }
    const JointLimits limits = limits_of(v, a, j);
    const double scale = seed % 3 == 0 ? decades(random, 1e-12, 1.0) : 1.0;
    JointPath path;
    for (JointPiece piece : plain.pieces()) {
      piece.scale = scale;
      path.append(piece);
    }
    const auto pieces = parameterize(path, limits);
    expect_finite(pieces);
    const Certificate certificate = certify(pieces, limits);
    ASSERT_TRUE(certificate.holds()) << certificate.problems.front().describe();
    const JointVector end = path.at(path.length()).q;
    ASSERT_LE((pieces.back().at(pieces.back().duration).q - end).cwiseAbs().maxCoeff(),
              1e-13 * size);
  }
}

TEST(ExtremeLimits, TimeMovesFarFromZeroSoThatTheyAreCertified) {
  for (std::uint64_t seed = 0; seed < problems<std::uint64_t>(400); ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    Random random(seed);
    const double far = decades(random, 1.0, 1e13);
    auto points = random_walk(random, 3, 2 + static_cast<int>(seed % 3), far, 3.0 * far);
    const bool away = seed % 2 == 0;  // a long way off, but short moves
    if (away) {
      points = random_walk(random, 3, 2, 0.5, 1.0);
      for (JointVector& point : points) point += JointVector::Constant(3, std::min(far, 1e9));
    }
    const JointPath path = cornered_path(points, away ? 0.02 : 0.02 * far);
    JointLimits limits = random_limits(random, 3, 0.5);
    limits.position_min.setConstant(-1e15);
    limits.position_max.setConstant(1e15);
    const Certificate certificate = certify(parameterize(path, limits), limits);
    ASSERT_TRUE(certificate.holds()) << certificate.problems.front().describe();
  }
}

TEST(ExtremeLimits, LetAJointGoToItsLimitFarFromZero) {
  for (const double limit : {1e5, 1e8, 1e12}) {
    SCOPED_TRACE(limit);
    JointLimits limits = limits_of(JointVector::Constant(1, 2.0), JointVector::Constant(1, 20.0),
                                   JointVector::Constant(1, 200.0));
    limits.position_max[0] = limit;
    JointPath path;
    path.append(JointPiece::line(JointVector::Constant(1, 0.3 * limit),
                                 JointVector::Constant(1, limit), 1.0));
    const Certificate certificate = certify(parameterize(path, limits), limits);
    EXPECT_TRUE(certificate.holds()) << certificate.problems.front().describe();
    limits.position_max[0] = limit * (1.0 - 1e-10);
    EXPECT_FALSE(certify(parameterize(path, limits), limits).holds());
  }
}

}  // namespace
}  // namespace viapoint::testing
