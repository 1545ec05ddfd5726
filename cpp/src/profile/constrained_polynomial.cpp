#include "viapoint/profile/constrained_polynomial.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>

#include "profile/argument_check.hpp"

namespace viapoint {
namespace {

// The matrix has entries up to 11·10·9 and its inverse grows with the degree: extended precision
// leaves what double shows.
using Real = long double;
using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic, 0, 12, 12>;
using Column = Eigen::Matrix<Real, Eigen::Dynamic, 1, 0, 12, 1>;

/// How nearly conditions must be met, as a share of the largest, all by unit time. Conditions that
/// all but follow from one another ask for coefficients so large that rounding alone breaks this.
constexpr Real kMet = 1e-9L;

void require_conditions(std::span<const Condition> conditions) {
  constexpr size_t kMost = Polynomial::kMaxDegree + 1;
  if (conditions.size() < 2 || conditions.size() > kMost) {
    refuse(std::to_string(conditions.size()) + " conditions were given; they must be 2 to " +
               std::to_string(kMost) + ", one for each coefficient",
           static_cast<double>(conditions.size()), static_cast<double>(kMost));
  }
  for (size_t i = 0; i < conditions.size(); ++i) {
    const Condition& here = conditions[i];
    require_finite(here.t, "time of a condition");
    require_finite(here.value, "value of a condition");
    if (here.derivative < 0 || here.derivative > 3) {
      refuse("condition " + std::to_string(i) + " is on derivative " +
                 std::to_string(here.derivative) + "; it must be 0 (position) to 3 (jerk)",
             here.derivative, here.derivative < 0 ? 0.0 : 3.0);
    }
    for (size_t k = 0; k < i; ++k) {
      if (conditions[k].t != here.t || conditions[k].derivative != here.derivative) continue;
      refuse("conditions " + std::to_string(k) + " and " + std::to_string(i) +
                 " are on the same derivative at the same time, " + written(here.t) + " s",
             here.t, here.t, {"leave one of them out"});
    }
  }
}

/// d^order/dx^order of x^k.
Real power(int k, int order, Real x) {
  if (k < order) return 0.0L;
  Real result = 1.0L;
  for (int m = 0; m < order; ++m) result *= static_cast<Real>(k - m);
  for (int m = order; m < k; ++m) result *= x;
  return result;
}

[[noreturn]] void refuse_open(size_t conditions) {
  refuse("the " + std::to_string(conditions) +
             " conditions do not settle one polynomial of degree " +
             std::to_string(conditions - 1) +
             " in numbers that doubles hold: some conditions follow from the others, or times are "
             "too near to tell apart",
         static_cast<double>(conditions), static_cast<double>(conditions),
         {"give at least one position", "give conditions that are independent of one another"});
}

}  // namespace

Polynomial constrained_polynomial(std::span<const Condition> conditions) {
  require_conditions(conditions);
  const auto by_time = [](const Condition& a, const Condition& b) { return a.t < b.t; };
  const auto [first, last] = std::minmax_element(conditions.begin(), conditions.end(), by_time);
  Polynomial law{first->t, last->t, {}};
  if (!(law.t1 > law.t0)) {
    refuse("all conditions are at " + written(law.t0) + " s; they must span some time",
           law.t1 - law.t0, 0.0);
  }
  // In x = (t − t0)/(t1 − t0), so that nothing depends on the unit of time.
  const Real length = static_cast<Real>(law.t1) - static_cast<Real>(law.t0);
  const auto size = static_cast<Eigen::Index>(conditions.size());
  Matrix rows(size, size);
  Column values(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const Condition& condition = conditions[static_cast<size_t>(i)];
    const Real x = (static_cast<Real>(condition.t) - static_cast<Real>(law.t0)) / length;
    values[i] = condition.value;
    for (int m = 0; m < condition.derivative; ++m) values[i] *= length;
    for (int k = 0; k < size; ++k) rows(i, k) = power(k, condition.derivative, x);
  }
  const Eigen::FullPivLU<Matrix> solver(rows);
  if (!solver.isInvertible()) refuse_open(conditions.size());
  const Column solution = solver.solve(values);
  Real scale = 1.0L;
  for (int k = 0; k < size; ++k) {
    law.c[static_cast<size_t>(k)] = static_cast<double>(solution[k] / scale);
    scale *= length;
  }
  const Real largest = values.cwiseAbs().maxCoeff();
  for (const Condition& condition : conditions) {
    const AxisState state = law.at(condition.t);
    const std::array reached{state.q, state.qd, state.qdd, state.qddd};
    Real miss = reached[static_cast<size_t>(condition.derivative)] - condition.value;
    for (int m = 0; m < condition.derivative; ++m) miss *= length;
    if (!(std::abs(miss) <= kMet * largest)) refuse_open(conditions.size());
  }
  return law;
}

}  // namespace viapoint
