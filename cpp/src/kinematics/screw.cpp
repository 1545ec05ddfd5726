#include "kinematics/screw.hpp"

#include <algorithm>
#include <cmath>

#include "viapoint/core/units.hpp"

namespace viapoint {
namespace {

/// @param angle less than 3π from zero @return it by a whole turn to within π [rad]
double within_a_turn(double angle) {
  if (std::abs(angle) <= kPi) return angle;
  return angle - std::copysign(2.0 * kPi, angle);
}

}  // namespace

Eigen::Matrix3d Screw::rotation(double q) const {
  if (type == JointType::kPrismatic) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(q, axis).toRotationMatrix();
}

Pose Screw::motion(double q) const {
  Pose out = Pose::Identity();
  if (type == JointType::kPrismatic) {
    out.translation() = q * axis;
  } else {
    out.linear() = rotation(q);
    out.translation() = origin - out.linear() * origin;
  }
  return out;
}

Track Track::still(const Eigen::Vector3d& point) {
  Track track;
  track.fixed = point;
  return track;
}

Track Track::of(const Screw& joint, const Eigen::Vector3d& point) {
  Track track;
  track.type = joint.type;
  if (joint.type == JointType::kPrismatic) {
    track.fixed = point;
    track.first = joint.axis;
    return track;
  }
  const Eigen::Vector3d arm = point - joint.origin;
  const Eigen::Vector3d along = joint.axis.dot(arm) * joint.axis;
  track.fixed = joint.origin + along;
  track.first = arm - along;
  track.second = joint.axis.cross(arm);
  return track;
}

Track Track::back(const Screw& joint, const Eigen::Vector3d& point) {
  Track track = of(joint, point);
  (joint.type == JointType::kPrismatic ? track.first : track.second) *= -1.0;
  return track;
}

Eigen::Vector3d Track::at(double q) const {
  if (type == JointType::kPrismatic) return fixed + q * first;
  return fixed + std::cos(q) * first + std::sin(q) * second;
}

JointTerm JointTerm::height(const Track& track, const Eigen::Vector3d& direction) {
  return {track.type, direction.dot(track.fixed), direction.dot(track.first),
          direction.dot(track.second)};
}

JointTerm JointTerm::square(const Track& track, const Eigen::Vector3d& centre) {
  const Eigen::Vector3d fixed = track.fixed - centre;
  const double spread = track.first.squaredNorm();
  if (track.type == JointType::kPrismatic) {
    return {track.type, fixed.squaredNorm(), 2.0 * fixed.dot(track.first), spread};
  }
  // first and second are square to one another and of one length.
  return {track.type, fixed.squaredNorm() + spread, 2.0 * fixed.dot(track.first),
          2.0 * fixed.dot(track.second)};
}

double JointTerm::at(double q) const {
  if (type == JointType::kPrismatic) return constant + q * (first + q * second);
  return constant + first * std::cos(q) + second * std::sin(q);
}

double JointTerm::weight() const { return std::max(std::abs(first), std::abs(second)); }

Roots JointTerm::solve(double value, double slack, double least) const {
  Roots roots;
  const double rest = value - constant;
  if (weight() < least) {
    roots.missing = std::abs(rest);
    if (roots.missing > std::max(slack, least)) return roots;
    roots.missing = 0.0;
    roots.free = true;
    roots.count = 1;
    return roots;
  }
  if (type == JointType::kRevolute) {
    const double size = std::sqrt(first * first + second * second);
    const double beyond = std::abs(rest) - size;
    if (beyond > slack) {
      roots.missing = beyond;
      return roots;
    }
    // cos δ = rest / size; its factors vanish at the ends, so that no digits are lost there.
    const double sine = std::sqrt(std::max(0.0, size - rest) * std::max(0.0, size + rest));
    const double delta = std::atan2(sine, rest);
    const double middle = std::atan2(second, first);
    roots.q = {within_a_turn(middle + delta), within_a_turn(middle - delta)};
    roots.apart = std::min(delta, kPi - delta);
    roots.count = roots.apart == 0.0 ? 1 : 2;
    return roots;
  }
  if (std::abs(second) < least) {
    roots.q[0] = rest / first;
    roots.count = 1;
    roots.apart = 1.0;
    return roots;
  }
  const double middle = -0.5 * first / second;
  const double under = middle * middle + rest / second;
  if (under < -slack / std::abs(second)) {
    roots.missing = -under * std::abs(second);
    return roots;
  }
  roots.apart = std::sqrt(std::max(0.0, under));
  roots.q = {middle + roots.apart, middle - roots.apart};
  roots.count = roots.apart == 0.0 ? 1 : 2;
  return roots;
}

double angle_about(const Eigen::Vector3d& axis, const Eigen::Vector3d& from,
                   const Eigen::Vector3d& to) {
  const Eigen::Vector3d a = from - axis.dot(from) * axis;
  const Eigen::Vector3d b = to - axis.dot(to) * axis;
  return std::atan2(axis.dot(a.cross(b)), a.dot(b));
}

}  // namespace viapoint
