# One interface target carries what every target of the project compiles with.
add_library(viapoint_compiler INTERFACE)
target_compile_options(viapoint_compiler INTERFACE
  -Wall -Wextra -Wconversion -Wshadow -Werror
  # g++ 12 warns falsely on string concatenation (GCC bug 105651) and on moved variants (80635).
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict -Wno-maybe-uninitialized>
  # Planner and controller must agree to the last bit: no fused multiply-add of the compiler's choosing.
  -ffp-contract=off)
if(VIAPOINT_BUILD_FUZZ)  # by another compiler: warnings are the business of the main build
  target_compile_options(viapoint_compiler INTERFACE -w)
endif()
if(VIAPOINT_SANITIZE)
  target_compile_options(viapoint_compiler INTERFACE
    -fsanitize=${VIAPOINT_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(viapoint_compiler INTERFACE -fsanitize=${VIAPOINT_SANITIZE})
  # These three double the time to compile, and a null, misaligned or outgrown pointer makes the
  # address sanitizer or the processor stop in the same place.
  if(VIAPOINT_SANITIZE MATCHES undefined)
    target_compile_options(viapoint_compiler INTERFACE -fno-sanitize=null,alignment,object-size)
  endif()
endif()

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER "${CCACHE_PROGRAM}")
endif()
