// Every target on its corpus: as it is, cut short, and changed at random. What libFuzzer finds goes
// into the corpus, and so is tried for ever.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "fuzz/targets.hpp"

namespace viapoint::fuzz {
namespace {

/// Longer ones are for the fuzzer, which has time.
constexpr std::size_t kLongest = 16'384;
constexpr int kCuts = 60;
constexpr int kChanges = 400;

std::string content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<std::filesystem::path> corpus(std::string_view target) {
  std::vector<std::filesystem::path> files;
  const auto folder = std::filesystem::path(VIAPOINT_TEST_DATA) / "../fuzz/corpus" / target;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

/// A few bytes turned, doubled, dropped, or put where others were.
std::string changed(std::string text, std::mt19937& random) {
  for (int k = 1 + static_cast<int>(random() % 4); k > 0 && !text.empty(); --k) {
    const std::size_t at = random() % text.size();
    const std::size_t length = std::min(text.size() - at, std::size_t{1} + random() % 8);
    switch (random() % 5) {
      case 0:
        text[at] = static_cast<char>(random() % 256);
        break;
      case 1:
        text[at] = static_cast<char>(text[at] ^ static_cast<char>(1U << random() % 8));
        break;
      case 2:
        text.erase(at, length);
        break;
      case 3:
        text.insert(at, text.substr(random() % text.size(), length));
        break;
      default:
        text.replace(at, length, std::to_string(random() % 1000));
    }
  }
  return text;
}

class Corpus : public ::testing::TestWithParam<std::string> {};

TEST_P(Corpus, IsTakenOrRefusedByNameWhateverBecomesOfIt) {
  const Target target = *std::ranges::find(kTargets, GetParam(), &Target::name);
  const std::vector<std::filesystem::path> files = corpus(target.name);
  ASSERT_FALSE(files.empty());
  const auto run = [&](const std::string& bytes) {
    try {
      target.run(bytes);
    } catch (const std::exception& error) {
      FAIL() << error.what() << "\n" << bytes;
    }
  };
  run("");
  for (const auto& file : files) {
    SCOPED_TRACE(file.filename());
    const std::string bytes = content(file);
    ASSERT_FALSE(bytes.empty());
    run(bytes);
    if (bytes.size() > kLongest) continue;
    for (std::size_t cut = 0; cut < kCuts; ++cut) run(bytes.substr(0, bytes.size() * cut / kCuts));
    for (unsigned seed = 0; seed < kChanges; ++seed) {
      SCOPED_TRACE(seed);
      std::mt19937 random(seed);
      run(changed(bytes, random));
      if (HasFailure()) return;
    }
  }
}

std::vector<std::string> names() {
  std::vector<std::string> names;
  for (const Target& target : kTargets) names.emplace_back(target.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Targets, Corpus, ::testing::ValuesIn(names()),
                         [](const auto& target) { return target.param; });

}  // namespace
}  // namespace viapoint::fuzz
