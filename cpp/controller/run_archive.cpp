#include "controller/run_archive.hpp"

#include <spdlog/fmt/chrono.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <ctime>
#include <filesystem>
#include <memory>

#include "controller/log_file.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/realtime/log_csv.hpp"

namespace viapoint::controller {
namespace {

constexpr std::chrono::milliseconds kPeriod{50};

std::string file_of(const std::string& folder, std::uint64_t number) {
  const std::string name =
      fmt::format("{:%Y%m%dT%H%M%SZ}-run{}.csv", fmt::gmtime(std::time(nullptr)), number);
  return std::filesystem::path(folder) / name;
}

}  // namespace

RunArchive::RunArchive(const ArmHost& host, const std::string& folder)
    : host_(host), folder_(folder) {
  check_log_can_be_written(file_of(folder, 0));
  thread_ = std::jthread([this](const std::stop_token& stop) { follow(stop); });
}

RunArchive::~RunArchive() = default;

void RunArchive::follow(const std::stop_token& stop) {
  std::uint64_t next = 1;
  bool was_asked = false;
  while (!was_asked) {
    was_asked = stop.stop_requested();  // one look more after that
    while (next <= host_.status().run && archive(next)) ++next;
    if (!was_asked) std::this_thread::sleep_for(kPeriod);
  }
}

bool RunArchive::archive(std::uint64_t number) const {
  std::shared_ptr<Job> job;
  try {
    job = host_.job(number);
  } catch (const MotionError&) {
    spdlog::error("the log of run {} was dropped before it could be written", number);
    return true;
  }
  try {
    if (!job->wait(0.0)) return false;
  } catch (const MotionError& error) {
    spdlog::error("run {}: {}", number, error.problem().message);
  }
  try {
    write_log_csv(file_of(folder_, number), job->log());
  } catch (const MotionError& error) {
    spdlog::error("the log of run {} was not written: {}", number, error.problem().describe());
  }
  return true;
}

}  // namespace viapoint::controller
