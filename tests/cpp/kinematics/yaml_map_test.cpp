#include "kinematics/yaml_map.hpp"

#include <gtest/gtest.h>

namespace viapoint {
namespace {

/// What the reader of a map that may hold `known` says where "lower" is not there.
Problem problem_of(const std::string& text, const std::vector<std::string>& known) {
  try {
    static_cast<void>(
        YamlMap(YamlValue(YAML::Load(text), "a.yaml", ""), known).at("lower", "\"lower: 0\""));
  } catch (const MotionError& error) {
    return error.problem();
  }
  ADD_FAILURE() << "lower is there";
  return {};
}

TEST(YamlMap, TakesAKeyThatNobodyKnowsForASlipOfTheMissingOne) {
  const Problem problem = problem_of("upper: 1\nlowre: 0", {"lower", "upper"});
  EXPECT_EQ(problem.message, "key \"lower\" is missing, there is \"lowre\"");
  EXPECT_EQ(problem.ways_out.front(), "write \"lower\" for \"lowre\"");
  EXPECT_EQ(problem.line, 2);
}

TEST(YamlMap, TakesNoKeyThatItKnowsForASlipOfAnother) {
  for (const char* text : {"tower: 1", "tower: 1\nnonsense: 2"}) {
    const Problem problem = problem_of(text, {"lower", "tower"});
    EXPECT_EQ(problem.message, "key \"lower\" is missing");
    EXPECT_EQ(problem.ways_out, std::vector<std::string>{"add \"lower: 0\""});
  }
  EXPECT_EQ(problem_of("tower: 1\nlowr: 0", {"lower", "tower"}).ways_out.front(),
            "write \"lower\" for \"lowr\"");
}

}  // namespace
}  // namespace viapoint
