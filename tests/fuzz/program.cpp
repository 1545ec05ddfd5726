#include <string>

#include "fuzz/broken_promise.hpp"
#include "fuzz/targets.hpp"
#include "viapoint/core/error.hpp"
#include "viapoint/program/motion_program.hpp"

namespace viapoint::fuzz {

void program(std::string_view bytes) {
  MotionProgram read;
  try {
    read = program_from_json(std::string(bytes), "fuzz.json");
  } catch (const MotionError&) {
    return;
  }
  const std::string text = to_json(read);
  promise(to_json(program_from_json(text, "again.json")) == text,
          "a program that was read does not read back");
}

}  // namespace viapoint::fuzz
