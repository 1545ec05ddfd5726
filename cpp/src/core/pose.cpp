#include "viapoint/core/pose.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "viapoint/core/error.hpp"
#include "viapoint/core/units.hpp"

namespace viapoint {
namespace {

std::string format(const char* pattern, double a, double b = 0.0, double c = 0.0) {
  char text[200];
  std::snprintf(text, sizeof text, pattern, a, b, c);
  return text;
}

/// Names the pair of columns whose angle is farthest from 90°.
std::string worst_columns(const Eigen::Matrix3d& m) {
  int first = 0;
  int second = 1;
  double worst_angle = kPi / 2;
  double worst = -1.0;
  for (int i = 0; i < 3; ++i) {
    for (int j = i + 1; j < 3; ++j) {
      const double norm = m.col(i).norm() * m.col(j).norm();
      const double angle =
          norm > 0.0 ? std::acos(std::clamp(m.col(i).dot(m.col(j)) / norm, -1.0, 1.0)) : 0.0;
      if (std::abs(angle - kPi / 2) > worst) {
        worst = std::abs(angle - kPi / 2);
        worst_angle = angle;
        first = i;
        second = j;
      }
    }
  }
  return format("its columns %.0f and %.0f are %.1f° apart instead of 90°", first + 1.0,
                second + 1.0, worst_angle / kDegree);
}

[[noreturn]] void refuse(const std::string& why, double value) {
  Problem problem;
  problem.code = ErrorCode::kNotARotation;
  problem.message = "the 3x3 block of the pose is not a rotation: " + why;
  problem.value = value;
  problem.limit = kRotationRounding;
  problem.ways_out = {
      "check the signs and the order of the elements; a matrix rounded to two decimals is accepted "
      "and projected on the nearest rotation"};
  throw MotionError(std::move(problem));
}

}  // namespace

CheckedPose checked_pose(const Eigen::Matrix4d& matrix) {
  if (!matrix.allFinite()) {
    throw MotionError(ErrorCode::kBadArgument, "the pose has an element that is not finite");
  }
  if (!matrix.row(3).isApprox(Eigen::RowVector4d(0, 0, 0, 1), 1e-9)) {
    throw MotionError(ErrorCode::kBadArgument,
                      "the bottom row of the pose must be 0 0 0 1; a transposed matrix has the "
                      "position there");
  }
  const Eigen::Matrix3d given = matrix.topLeftCorner<3, 3>();
  // Nearest rotation in the Frobenius norm: the orthogonal polar factor (Higham 1986).
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(given, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d nearest = svd.matrixU() * svd.matrixV().transpose();
  const double correction = (nearest - given).cwiseAbs().maxCoeff();
  if (correction > kRotationRounding) {
    refuse(worst_columns(given) + format(", its determinant is %.2f", given.determinant()) +
               format(", the nearest rotation differs by %.3f in an element", correction),
           correction);
  }
  if (nearest.determinant() < 0.0) refuse("it is a reflection (determinant -1)", correction);

  CheckedPose checked;
  checked.pose = Pose::Identity();
  // A matrix that is a rotation to rounding passes through unchanged, to the last bit.
  constexpr double kExact = 1e-12;
  checked.pose.linear() = correction <= kExact ? given : nearest;
  checked.pose.translation() = matrix.topRightCorner<3, 1>();
  checked.correction = correction <= kExact ? 0.0 : correction;
  return checked;
}

Eigen::Vector3d rotation_log(const Eigen::Matrix3d& rotation) {
  // Through the unit quaternion (Shepperd 1978 in Eigen): exact near 0 and near π alike.
  const Eigen::Quaterniond quaternion(rotation);
  Eigen::Vector3d imaginary = quaternion.vec();
  double real = quaternion.w();
  if (real < 0.0) {
    imaginary = -imaginary;
    real = -real;
  }
  const double sine = imaginary.norm();
  if (sine < 1e-12) return 2.0 * imaginary;
  return imaginary * (2.0 * std::atan2(sine, real) / sine);
}

Eigen::Matrix3d rotation_exp(const Eigen::Vector3d& vector) {
  const double angle = vector.norm();
  if (angle < 1e-12) {
    Eigen::Matrix3d small;
    small << 1.0, -vector.z(), vector.y(), vector.z(), 1.0, -vector.x(), -vector.y(), vector.x(),
        1.0;
    return small;
  }
  return Eigen::AngleAxisd(angle, vector / angle).toRotationMatrix();
}

double rotation_distance(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return rotation_log(a.transpose() * b).norm();
}

}  // namespace viapoint
