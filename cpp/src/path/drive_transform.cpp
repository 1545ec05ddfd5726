#include "viapoint/path/drive_transform.hpp"

#include <algorithm>
#include <cmath>

#include "viapoint/core/units.hpp"
#include "viapoint/profile/quartic_transition.hpp"

namespace viapoint {
namespace {

/// Below this sin(theta) the axis of the approach turn is lost in rounding, and any will do.
constexpr double kNoTurn = 1e-12;
/// A line left over between two transitions shorter than this share of its segment is rounding.
constexpr double kTimeRounding = 1e-12;

Eigen::Matrix3d turn(double angle, const Eigen::Vector3d& axis) {
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

/// Into (−π, π].
double wrapped(double angle) {
  const double rest = std::remainder(angle, 2.0 * kPi);
  return rest <= -kPi ? kPi : rest;
}

Polynomial line(double start, double end, double value, double slope) {
  return {start, end, {value, slope, 0.0, 0.0, 0.0, 0.0}};
}

}  // namespace

DriveTransform DriveTransform::between(const Pose& from, const Pose& to) {
  const Eigen::Matrix3d rotation = from.linear().transpose() * to.linear();
  DriveTransform drive;
  drive.position = from.linear().transpose() * (to.translation() - from.translation());
  const Eigen::Vector3d approach = rotation.col(2);
  const double across = std::hypot(approach.x(), approach.y());
  drive.theta = std::atan2(across, approach.z());
  if (across > kNoTurn) drive.psi = std::atan2(approach.y(), approach.x());
  const Eigen::Vector3d axis(-std::sin(drive.psi), std::cos(drive.psi), 0.0);
  const Eigen::Matrix3d about_approach = turn(-drive.theta, axis) * rotation;
  drive.phi = std::atan2(about_approach(1, 0), about_approach(1, 1));
  return drive;
}

Pose DriveTransform::pose() const {
  const Eigen::Vector3d axis(-std::sin(psi), std::cos(psi), 0.0);
  Pose result = Pose::Identity();
  result.translation() = position;
  result.linear() = turn(theta, axis) * turn(phi, Eigen::Vector3d::UnitZ());
  return result;
}

DriveMotion::DriveMotion(std::span<const Pose> poses, std::span<const double> durations,
                         double t_acc) {
  check_transitions(poses.size(), durations, t_acc);
  double point_time = 0.0;  // at which segment i would leave its first pose
  for (size_t i = 0; i < durations.size(); ++i) {
    const bool turns_before = i > 0, turns_after = i + 1 < durations.size();
    const double start = point_time + (turns_before ? t_acc : 0.0);
    const double end = point_time + durations[i] - (turns_after ? t_acc : 0.0);
    if (turns_before) {
      const DriveTransform drive = DriveTransform::between(poses[i - 1], poses[i]);
      const double share = 1.0 - t_acc / durations[i - 1];
      const DriveTransform part{share * drive.position, drive.psi, share * drive.theta,
                                share * drive.phi};
      add_transition(poses[i - 1] * part.pose(), poses[i], poses[i + 1], point_time, durations[i],
                     t_acc);
    }
    if (end - start > kTimeRounding * durations[i]) {
      add_line(poses[i], poses[i + 1], point_time, durations[i], start, end);
    }
    point_time += durations[i];
  }
}

void DriveMotion::add_line(const Pose& from, const Pose& to, double point_time, double duration,
                           double start, double end) {
  const DriveTransform drive = DriveTransform::between(from, to);
  const auto coordinate = [&](double whole) {
    return line(start, end, whole * (start - point_time) / duration, whole / duration);
  };
  Part part{start, end, from, {}, {}, {}, {}};
  for (int k = 0; k < 3; ++k) part.position[static_cast<size_t>(k)] = coordinate(drive.position[k]);
  part.psi = line(start, end, drive.psi, 0.0);
  part.theta = coordinate(drive.theta);
  part.phi = coordinate(drive.phi);
  parts_.push_back(part);
}

void DriveMotion::add_transition(const Pose& before, const Pose& here, const Pose& after,
                                 double point_time, double duration_after, double t_acc) {
  DriveTransform from = DriveTransform::between(here, before);
  DriveTransform to = DriveTransform::between(here, after);
  // (psi + π, −theta) is the same turn as (psi, theta): take the form nearer to the next leg's.
  double change = wrapped(to.psi - from.psi);
  if (std::abs(change) > 0.5 * kPi) {
    from.psi += kPi;
    from.theta = -from.theta;
    change = wrapped(to.psi - from.psi);
  }
  const double start = point_time - t_acc, end = point_time + t_acc;
  const auto coordinate = [&](double past, double next) {
    return Polynomial{start, end, quartic_transition(past, next, duration_after, t_acc)};
  };
  Part part{start, end, here, {}, {}, {}, {}};
  for (int k = 0; k < 3; ++k) {
    part.position[static_cast<size_t>(k)] = coordinate(from.position[k], to.position[k]);
  }
  part.psi = line(start, end, from.psi, 0.5 * change / t_acc);
  part.theta = coordinate(from.theta, to.theta);
  part.phi = coordinate(from.phi, to.phi);
  parts_.push_back(part);
}

ToolState DriveMotion::at(size_t index, double t) const {
  const Part& part = parts_[index];
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  const AxisState psi = part.psi.at(t), theta = part.theta.at(t), phi = part.phi.at(t);
  Eigen::Vector3d p, pd, pdd;
  for (int k = 0; k < 3; ++k) {
    const AxisState x = part.position[static_cast<size_t>(k)].at(t);
    p[k] = x.q, pd[k] = x.qd, pdd[k] = x.qdd;
  }
  // Ra Ro = Rz(psi) Ry(theta) Rz(phi − psi): rates about three axes, of which the second turns with
  // the first, and the third with both.
  const Eigen::Vector3d second = turn(psi.q, z) * Eigen::Vector3d::UnitY();
  const Eigen::Matrix3d tilt = turn(psi.q, z) * turn(theta.q, Eigen::Vector3d::UnitY());
  const Eigen::Vector3d third = tilt * z;
  const double spin = phi.qd - psi.qd;
  const Eigen::Vector3d first_rate = psi.qd * z;
  const Eigen::Vector3d second_rate = first_rate + theta.qd * second;
  const Eigen::Vector3d w = second_rate + spin * third;
  const Eigen::Vector3d wd = psi.qdd * z + theta.qdd * second + (phi.qdd - psi.qdd) * third +
                             theta.qd * first_rate.cross(second) + spin * second_rate.cross(third);

  const Eigen::Matrix3d base = part.seen_from.linear();
  ToolState state;
  state.pose.translation() = part.seen_from.translation() + base * p;
  state.pose.linear() = base * tilt * turn(phi.q - psi.q, z);
  state.velocity = base * pd;
  state.acceleration = base * pdd;
  state.angular_velocity = base * w;
  state.angular_acceleration = base * wd;
  return state;
}

ToolState DriveMotion::at(double t) const {
  t = std::clamp(t, 0.0, duration());
  size_t part = parts_.size() - 1;
  while (part > 0 && t < parts_[part].start) --part;
  return at(part, t);
}

}  // namespace viapoint
