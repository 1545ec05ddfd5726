#include "path/turning.hpp"

#include <algorithm>

#include "viapoint/core/units.hpp"

namespace viapoint {

Turning turning_about(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& w,
                      const Eigen::Vector3d& w1, double sup_w2, double half) {
  return {rotation,
          w,
          w1,
          w.norm() + half * (w1.norm() + 0.5 * half * sup_w2),
          w1.norm() + half * sup_w2,
          sup_w2};
}

double quadratic_bound(const Eigen::Vector3d& e, const Eigen::Vector3d& e1,
                       const Eigen::Vector3d& e2, double half) {
  const Eigen::Vector3d bend = 0.5 * half * half * e2;
  return std::max(
      {(e - half * e1 + bend).norm(), (e - bend).norm(), (e + half * e1 + bend).norm()});
}

double angle_bound(const Eigen::Vector3d& phi, const Turning& a, const Turning& b, double half) {
  // In the base frame first: u = w_a − w_b has the size of v, its derivatives do not turn.
  const Eigen::Vector3d u = a.w - b.w;
  const Eigen::Vector3d u1 = a.w1 - b.w1;
  const double sup_u2 = a.sup_w2 + b.sup_w2;
  const double sup_u1 = u1.norm() + half * sup_u2;
  const double sup_u = u.norm() + half * (u1.norm() + 0.5 * half * sup_u2);
  const double crude = std::min(phi.norm() + half * sup_u, kPi);
  if (crude > 1.0) return crude;
  // v' and v'' in the frame of b, which turns at w_b.
  const Eigen::Matrix3d to_b = b.rotation.transpose();
  const Eigen::Vector3d v = to_b * u;
  const Eigen::Vector3d v1 = to_b * (u1 - b.w.cross(u));
  const double sup_v2 = sup_u2 + 2.0 * b.sup_w * sup_u1 + (b.sup_w1 + b.sup_w * b.sup_w) * sup_u;
  const double refined = quadratic_bound(phi, v, v1, half) + half * half * half * sup_v2 / 6.0 +
                         0.585 * crude * sup_u * half;
  return std::min(crude, refined);
}

}  // namespace viapoint
