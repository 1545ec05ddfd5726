#include "viapoint/profile/constrained_polynomial.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "problem_count.hpp"
#include "viapoint/core/error.hpp"

namespace viapoint {
namespace {

double of_order(const AxisState& state, int derivative) {
  return std::array{state.q, state.qd, state.qdd, state.qddd}[static_cast<size_t>(derivative)];
}

void expect_same(const Polynomial& a, const Polynomial& b) {
  EXPECT_EQ(a.t0, b.t0);
  EXPECT_EQ(a.t1, b.t1);
  for (size_t k = 0; k < a.c.size(); ++k) {
    EXPECT_NEAR(a.c[k], b.c[k], 1e-12 * (1.0 + std::abs(b.c[k]))) << "power " << k;
  }
}

TEST(ConstrainedPolynomial, IsTheCubicAndTheQuinticOfTheirConditions) {
  const AxisState from{0.3, -1.0, 2.0, 0.0}, to{1.2, 0.4, -3.0, 0.0};
  const std::vector<Condition> four{{2, 0, 0.3}, {2, 1, -1.0}, {2.7, 0, 1.2}, {2.7, 1, 0.4}};
  expect_same(constrained_polynomial(four), cubic(from, to, 2.0, 2.7));
  std::vector<Condition> six = four;
  six.insert(six.begin(), {{2.7, 2, -3.0}, {2, 2, 2.0}});  // in any order
  expect_same(constrained_polynomial(six), quintic(from, to, 2.0, 2.7));
}

TEST(ConstrainedPolynomial, SepticFromRestToRestIsTheTextbooks) {
  // q = h (35 u⁴ − 84 u⁵ + 70 u⁶ − 20 u⁷) with u = t/T (Biagiotti & Melchiorri 2008, §2.1.7).
  const double h = 1.5, time = 2.0;
  std::vector<Condition> conditions{{0, 0, 0.0}, {time, 0, h}};
  for (int order = 1; order <= 3; ++order) {
    conditions.push_back({0, order, 0.0});
    conditions.push_back({time, order, 0.0});
  }
  const Polynomial law = constrained_polynomial(conditions);
  const std::array wanted{0.0, 0.0, 0.0, 0.0, 35.0, -84.0, 70.0, -20.0};
  for (size_t k = 0; k < law.c.size(); ++k) {
    const double value = k < wanted.size() ? h * wanted[k] / std::pow(time, k) : 0.0;
    EXPECT_NEAR(law.c[k], value, 1e-13) << "power " << k;
  }
}

TEST(ConstrainedPolynomial, MeetsRandomConditionsInside) {
  for (int seed = 0; seed < problems(3000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    std::uniform_real_distribution<double> any(-3.0, 3.0);
    const double unit = std::pow(10.0, any(random));
    std::vector<Condition> conditions;
    const auto times = 2 + random() % 4;
    for (size_t i = 0; i < times; ++i) {
      const double t = unit * (static_cast<double>(i) + 0.03 * any(random));
      const auto orders = 1 + random() % 3;  // q; q, qd; or q, qd, qdd: always solvable (Hermite)
      for (size_t order = 0; order < orders && conditions.size() < 10; ++order) {
        conditions.push_back(
            {t, static_cast<int>(order), any(random) / std::pow(unit, static_cast<double>(order))});
      }
    }
    const Polynomial law = constrained_polynomial(conditions);
    for (const Condition& condition : conditions) {
      const double scale = 3.0 / std::pow(unit, condition.derivative);
      EXPECT_NEAR(of_order(law.at(condition.t), condition.derivative), condition.value,
                  1e-8 * scale);
    }
    for (size_t k = conditions.size(); k < law.c.size(); ++k) EXPECT_EQ(law.c[k], 0.0);
    if (testing::Test::HasFailure()) return;
  }
}

void expect_refused(const std::vector<Condition>& conditions, const char* word) {
  try {
    static_cast<void>(constrained_polynomial(conditions));
    ADD_FAILURE() << "accepted, instead of: " << word;
  } catch (const MotionError& error) {
    EXPECT_NE(std::string(error.what()).find(word), std::string::npos) << error.what();
  }
}

TEST(ConstrainedPolynomial, RefusesWhatDoesNotSettleIt) {
  expect_refused({{0, 1, 1.0}, {1, 1, 2.0}}, "do not settle");
  // q(0), q̇(½), q(1): every parabola through both ends has the same velocity half way.
  expect_refused({{0, 0, 0.0}, {0.5, 1, 2.0}, {1, 0, 1.0}}, "do not settle");
  // The same where rounding hides it.
  expect_refused({{0.1, 0, 0.0}, {0.1 + 0.1, 1, 2.0}, {0.3, 0, 1.0}}, "do not settle");
  expect_refused({{0, 0, 0.0}, {0, 0, 1.0}, {1, 0, 1.0}}, "same derivative");
  expect_refused({{1, 0, 0.0}, {1, 1, 0.0}}, "span some time");
  expect_refused({{0, 0, 0.0}}, "2 to 12");
  expect_refused(std::vector<Condition>(13, Condition{0, 0, 0.0}), "2 to 12");
  expect_refused({{0, 0, 0.0}, {1, 4, 0.0}}, "0 (position) to 3 (jerk)");
  expect_refused({{0, 0, std::nan("")}, {1, 0, 0.0}}, "finite");
  expect_refused({{0, 0, -1e308}, {1e-300, 0, 1e308}}, "do not settle");
}

}  // namespace
}  // namespace viapoint
