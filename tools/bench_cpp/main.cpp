#include <charconv>
#include <exception>
#include <iostream>
#include <string_view>

#include "benches.hpp"

namespace {

constexpr std::string_view kUsage =
    "usage: viapoint-bench tick [TICKS] | commands [SEQUENCES] | plan [PROGRAMS] |\n"
    "                      certificate [PROGRAMS] | walk [PATHS] | growth [MOVES] |\n"
    "                      stream [MOVES] | insertion [PROBLEMS] | kinematics [POSES] | tracking "
    "[LINES] |\n"
    "                      all | programs [PROGRAMS] | stops [STOPS] | soak [SECONDS]\n"
    "Prints one JSON object a line; times as its keys say.\n";

constexpr int kTicks = 2'500'000;  ///< of each case: 10^7 together
constexpr int kSequences = 10'000;
constexpr int kPrograms = 100;
constexpr int kPoses = 1'000'000;
constexpr int kPaths = 20;
constexpr int kMoves = 10'000;
constexpr int kStreamMoves = 300'000;
constexpr int kProblems = 1000;
constexpr int kLines = 300;
constexpr int kSeconds = 15 * 60;

int count_of(int argc, char** argv, int otherwise) {
  if (argc < 3) return otherwise;
  const std::string_view text = argv[2];
  int count = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  return error == std::errc{} && end == text.data() + text.size() ? count : 0;
}

int default_count(std::string_view command) {
  if (command == "tick") return kTicks;
  if (command == "commands") return kSequences;
  if (command == "kinematics") return kPoses;
  if (command == "growth") return kMoves;
  if (command == "stream") return kStreamMoves;
  if (command == "insertion") return kProblems;
  if (command == "tracking") return kLines;
  if (command == "soak") return kSeconds;
  return command == "walk" ? kPaths : kPrograms;
}

}  // namespace

int main(int argc, char** argv) {
  using namespace viapoint::bench;
  const std::string_view command = argc > 1 ? argv[1] : "";
  const int count = count_of(argc, argv, default_count(command));
  if (argc > 3 || count < 1) {
    std::cerr << kUsage;
    return 2;
  }
  try {
    if (command == "tick") {
      bench_tick(count);
    } else if (command == "commands") {
      bench_commands(count);
    } else if (command == "plan") {
      bench_plan(count);
    } else if (command == "certificate") {
      bench_certificate(count);
    } else if (command == "walk") {
      bench_walk(count);
    } else if (command == "growth") {
      bench_growth(count);
    } else if (command == "stream") {
      bench_stream(count);
    } else if (command == "insertion") {
      bench_insertion(count);
    } else if (command == "kinematics") {
      bench_kinematics(count);
    } else if (command == "tracking") {
      bench_tracking(count);
    } else if (command == "programs") {
      print_random_programs(count);
    } else if (command == "stops") {
      print_stops(count);
    } else if (command == "soak") {
      bench_soak(count);
    } else if (command == "all" && argc == 2) {
      bench_kinematics(kPoses);
      bench_tracking(kLines);
      bench_tick(kTicks);
      bench_commands(kSequences);
      bench_plan(kPrograms);
      bench_certificate(kPrograms);
      bench_walk(kPaths);
      bench_growth(kMoves);
      bench_stream(kStreamMoves);
      bench_insertion(kProblems);
    } else {
      std::cerr << kUsage;
      return 2;
    }
  } catch (const std::exception& error) {
    std::cerr << "viapoint-bench: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
