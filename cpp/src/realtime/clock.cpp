#include "viapoint/realtime/clock.hpp"

#include <cerrno>
#include <ctime>

namespace viapoint {
namespace {

constexpr std::int64_t kNanoseconds = 1'000'000'000;

}  // namespace

std::int64_t MonotonicClock::now() const noexcept {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return static_cast<std::int64_t>(time.tv_sec) * kNanoseconds + time.tv_nsec;
}

void MonotonicClock::sleep_until(std::int64_t instant) noexcept {
  const timespec time{static_cast<time_t>(instant / kNanoseconds),
                      static_cast<long>(instant % kNanoseconds)};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, nullptr) == EINTR) {
  }
}

}  // namespace viapoint
