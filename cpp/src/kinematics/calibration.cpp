#include "viapoint/kinematics/calibration.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <string>
#include <utility>

#include "viapoint/core/error.hpp"
#include "viapoint/core/units.hpp"

namespace viapoint {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr size_t kLeastPoses = 4;
constexpr size_t kLeastPoints = 3;
constexpr double kMillimetres = 1e3;

[[gnu::format(printf, 1, 2)]] std::string text(const char* pattern, ...) {
  char out[400];
  va_list values;
  va_start(values, pattern);
  std::vsnprintf(out, sizeof out, pattern, values);
  va_end(values);
  return out;
}

[[noreturn]] void refuse(std::string message, double value, double limit, std::string way_out) {
  Problem problem;
  problem.code = ErrorCode::kDegeneratePoints;
  problem.message = std::move(message);
  problem.value = value;
  problem.limit = limit;
  problem.ways_out = {std::move(way_out)};
  throw MotionError(std::move(problem));
}

void require_poses(std::span<const Pose> poses, const char* name) {
  for (size_t i = 0; i < poses.size(); ++i) {
    const Matrix3d off = poses[i].linear().transpose() * poses[i].linear() - Matrix3d::Identity();
    if (poses[i].matrix().allFinite() && off.cwiseAbs().maxCoeff() < 1e-6 &&
        poses[i].linear().determinant() > 0.0) {
      continue;
    }
    throw MotionError(ErrorCode::kBadArgument,
                      text("%s %zu is no pose: not finite, or no rotation", name, i + 1));
  }
}

Fit fit_of(std::vector<double> residuals) {
  Fit fit;
  double sum = 0.0;
  for (size_t i = 0; i < residuals.size(); ++i) {
    sum += residuals[i] * residuals[i];
    if (residuals[i] > fit.largest) {
      fit.largest = residuals[i];
      fit.worst = static_cast<int>(i);
    }
  }
  fit.rms = std::sqrt(sum / static_cast<double>(residuals.size()));
  fit.residuals = std::move(residuals);
  return fit;
}

/// The two orientations that differ most.
struct Widest {
  double angle = 0.0;  ///< [rad]
  size_t first = 0;
  size_t second = 0;
};

Widest widest_of(std::span<const Pose> poses) {
  Widest widest;
  for (size_t i = 0; i < poses.size(); ++i) {
    for (size_t j = i + 1; j < poses.size(); ++j) {
      const double angle = rotation_distance(poses[i].linear(), poses[j].linear());
      if (angle > widest.angle) widest = {angle, i, j};
    }
  }
  return widest;
}

/// @param singular of the linear problem, descending; the growth of an error is 1 over them
/// @param weakest direction in the flange frame that belongs to the last
void require_spread(std::span<const Pose> poses, const Vector3d& singular,
                    const Vector3d& weakest) {
  const double least = 1.0 / kMostSensitivity;
  if (singular[2] >= least) return;
  const double growth = singular[2] > 0.0 ? 1.0 / singular[2] : HUGE_VAL;
  const std::string grows =
      text("1 mm of error at a touch can become %.3g mm in the tool, allowed are %g", growth,
           kMostSensitivity);
  const Widest widest = widest_of(poses);
  if (singular[1] < least) {
    refuse(text("the orientations are too much alike: the widest apart, of poses %zu and %zu, "
                "differ by %.3g°; ",
                widest.first + 1, widest.second + 1, widest.angle / kDegree) +
               grows,
           growth, kMostSensitivity,
           "touch the point with orientations 30° and more apart, turned about two axes");
  }
  refuse(text("the orientations are parallel: all turn about one axis of the flange, "
              "(%.3f, %.3f, %.3f), and the tool is not known along it; ",
              weakest.x(), weakest.y(), weakest.z()) +
             grows,
         growth, kMostSensitivity, "tilt that axis by 30° or more in at least one of the poses");
}

/// Refuses a way too short to tell a direction, by its name.
void require_travel(const Vector3d& way, const char* name) {
  const double length = way.norm();
  if (length >= kLeastTravel) return;
  refuse(text("%s is %.3g mm long; it must be at least %g mm to tell a direction", name,
              kMillimetres * length, kMillimetres * kLeastTravel),
         length, kLeastTravel, "touch points farther apart: 100 mm and more tell it well");
}

double angle_between(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Refuses two ways that lie nearly on one line.
double require_angle(const Vector3d& a, const Vector3d& b, const char* what, const char* way_out) {
  const double angle = angle_between(a, b);
  const double off_line = std::min(angle, kPi - angle);
  if (off_line >= kLeastAngle) return angle;
  refuse(text("%s: they are %.3g° from one line; it must be at least %.3g°", what,
              off_line / kDegree, kLeastAngle / kDegree),
         off_line, kLeastAngle, way_out);
}

/// Refuses points too near to one another, or to one line, to tell how a frame is turned.
void require_spread(std::span<const Vector3d> points, const Vector3d& mean, const char* which) {
  Matrix3d spread = Matrix3d::Zero();
  for (const Vector3d& point : points) {
    spread += (point - mean) * (point - mean).transpose() / static_cast<double>(points.size());
  }
  // How far the points are from their best line, beside how far along it.
  const Vector3d extent = Eigen::JacobiSVD<Matrix3d>(spread).singularValues().cwiseSqrt();
  if (!(extent[0] >= kLeastTravel)) {
    refuse(text("the %s points are %.3g mm apart; it must be at least %g mm", which,
                kMillimetres * extent[0], kMillimetres * kLeastTravel),
           extent[0], kLeastTravel, "touch points farther apart");
  }
  const double off_line = std::atan2(extent[1], extent[0]);
  if (!(off_line >= kLeastAngle)) {
    refuse(text("the %s points lie on one line: they are %.3g° from it; it must be at least %.3g°",
                which, off_line / kDegree, kLeastAngle / kDegree),
           off_line, kLeastAngle, "touch a point off that line");
  }
}

}  // namespace

TcpCalibration calibrate_tcp(std::span<const Pose> poses) {
  if (poses.size() < kLeastPoses) {
    throw MotionError(
        ErrorCode::kBadArgument,
        text("%zu poses touch the point; at least %zu are needed", poses.size(), kLeastPoses));
  }
  require_poses(poses, "pose");
  const auto n = static_cast<double>(poses.size());
  Matrix3d mean_rotation = Matrix3d::Zero();
  Vector3d mean_position = Vector3d::Zero();
  for (const Pose& pose : poses) {
    mean_rotation += pose.linear() / n;
    mean_position += pose.translation() / n;
  }
  Eigen::MatrixXd left(3 * poses.size(), 3);
  Eigen::VectorXd right(3 * poses.size());
  for (size_t i = 0; i < poses.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(3 * i);
    left.middleRows<3>(row) = poses[i].linear() - mean_rotation;
    right.segment<3>(row) = mean_position - poses[i].translation();
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(left, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Vector3d singular = svd.singularValues();
  require_spread(poses, singular, svd.matrixV().col(2));

  TcpCalibration found;
  found.tcp = svd.solve(right);
  found.point = mean_rotation * found.tcp + mean_position;
  std::vector<double> residuals;
  double sum = 0.0;
  for (const Pose& pose : poses) {
    residuals.push_back((pose * found.tcp - found.point).norm());
    sum += residuals.back() * residuals.back();
  }
  found.fit = fit_of(std::move(residuals));
  found.sensitivity = 1.0 / singular[2];
  // Six of the 3 n coordinates went into the tool's point and the fixed one.
  found.uncertainty = found.sensitivity * std::sqrt(sum / (3.0 * n - 6.0));
  return found;
}

ToolCalibration calibrate_tool(std::span<const Pose> poses, const Pose& along_x,
                               const Pose& along_z) {
  ToolCalibration found;
  found.tcp = calibrate_tcp(poses);
  const Pose ways[] = {along_x, along_z};
  require_poses(ways, "the pose after a way along an axis, number");
  const Vector3d& tcp = found.tcp.tcp;
  const Pose& reference = poses.back();
  // As the flange stood at the reference: what the arm turned on the way does not count.
  const auto in_flange = [&](const Pose& to) -> Vector3d {
    return reference.linear().transpose() * (to * tcp - reference * tcp);
  };
  const Vector3d x = in_flange(along_x);
  const Vector3d z = in_flange(along_z);
  require_travel(x, "the way along the tool's x");
  require_travel(z, "the way along the tool's z");
  found.angle =
      require_angle(x, z, "the ways along x and z show one direction",
                    "from the last touch move along the tool's +x, go back, and move along its +z");
  Matrix3d rotation;
  rotation.col(2) = z.normalized();
  rotation.col(1) = z.cross(x).normalized();
  rotation.col(0) = rotation.col(1).cross(rotation.col(2));
  found.pose_flange_tool = Pose::Identity();
  found.pose_flange_tool.linear() = rotation;
  found.pose_flange_tool.translation() = tcp;
  return found;
}

Pose frame_from_points(const Vector3d& origin, const Vector3d& on_x, const Vector3d& on_xy) {
  if (!origin.allFinite() || !on_x.allFinite() || !on_xy.allFinite()) {
    throw MotionError(ErrorCode::kBadArgument, "a point of the frame is not finite");
  }
  const Vector3d x = on_x - origin;
  const Vector3d in_plane = on_xy - origin;
  require_travel(x, "the way from the origin to the point on x");
  require_travel(in_plane, "the way from the origin to the point in the plane");
  require_angle(x, in_plane, "the three points lie on one line",
                "touch the third point off the x axis, on the side of +y");
  Pose pose = Pose::Identity();
  pose.translation() = origin;
  pose.linear().col(0) = x.normalized();
  pose.linear().col(2) = x.cross(in_plane).normalized();
  pose.linear().col(1) = pose.linear().col(2).cross(pose.linear().col(0));
  return pose;
}

FrameFit frame_from_known_points(std::span<const Vector3d> known,
                                 std::span<const Vector3d> touched) {
  if (known.size() != touched.size() || known.size() < kLeastPoints) {
    throw MotionError(ErrorCode::kBadArgument,
                      text("%zu known points and %zu touched ones; as many of both are needed, "
                           "and at least %zu",
                           known.size(), touched.size(), kLeastPoints));
  }
  const auto n = static_cast<double>(known.size());
  Vector3d mean_known = Vector3d::Zero();
  Vector3d mean_touched = Vector3d::Zero();
  for (size_t i = 0; i < known.size(); ++i) {
    if (!known[i].allFinite() || !touched[i].allFinite()) {
      throw MotionError(ErrorCode::kBadArgument, text("point %zu is not finite", i + 1));
    }
    mean_known += known[i] / n;
    mean_touched += touched[i] / n;
  }
  Matrix3d covariance = Matrix3d::Zero();
  for (size_t i = 0; i < known.size(); ++i) {
    covariance += (touched[i] - mean_touched) * (known[i] - mean_known).transpose();
  }
  require_spread(known, mean_known, "known");
  require_spread(touched, mean_touched, "touched");
  const Eigen::JacobiSVD<Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vector3d sign = Vector3d::Ones();
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0) sign[2] = -1.0;

  FrameFit found;
  found.pose_base_frame = Pose::Identity();
  found.pose_base_frame.linear() = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
  found.pose_base_frame.translation() = mean_touched - found.pose_base_frame.linear() * mean_known;
  std::vector<double> residuals;
  for (size_t i = 0; i < known.size(); ++i) {
    residuals.push_back((found.pose_base_frame * known[i] - touched[i]).norm());
  }
  found.fit = fit_of(std::move(residuals));
  return found;
}

}  // namespace viapoint
