// One target as libFuzzer wants it: built once for each, with its name in VIAPOINT_FUZZ_TARGET.
#include <cstddef>
#include <cstdint>

#include "fuzz/targets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  viapoint::fuzz::VIAPOINT_FUZZ_TARGET({reinterpret_cast<const char*>(data), size});
  return 0;
}

// liburdfdom 3.0 forgets the links of a model that it refuses where they form a ring.
// NOLINTNEXTLINE(bugprone-reserved-identifier,readability-identifier-naming): LeakSanitizer's
extern "C" const char* __lsan_default_suppressions() { return "leak:liburdfdom_model"; }
