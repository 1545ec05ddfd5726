#include "controller/config.hpp"

#include <string>

#include "fuzz/broken_promise.hpp"
#include "fuzz/targets.hpp"
#include "viapoint/core/error.hpp"

namespace viapoint::fuzz {

void config(std::string_view bytes) {
  controller::Config config;
  try {
    config = controller::config_from_yaml(std::string(bytes), "fuzz.yaml");
  } catch (const MotionError&) {
    return;
  }
  promise(config.cycle.count() > 0 && config.heartbeat >= config.cycle, "a loop that cannot be");
  promise(config.port >= 0 && config.port <= 65535, "a port that is none");
  promise(config.is_loopback() || config.tls.has_value(), "open to others without TLS");
}

}  // namespace viapoint::fuzz
