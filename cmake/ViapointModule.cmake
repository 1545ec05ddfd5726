# viapoint_module(<name> [DEPENDS <module>...] [PUBLIC <target>...] [PRIVATE <target>...])
# One static library a module; DEPENDS is the layering table of the design, and
# tools/check_layers.py holds the #includes against it.
function(viapoint_module name)
  cmake_parse_arguments(arg "" "" "DEPENDS;PUBLIC;PRIVATE" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/*.cpp")
  if(NOT sources)  # a module that has not landed yet
    file(WRITE "${CMAKE_CURRENT_BINARY_DIR}/empty.cpp" "")
    set(sources "${CMAKE_CURRENT_BINARY_DIR}/empty.cpp")
  endif()
  add_library(viapoint_${name} STATIC ${sources})
  add_library(viapoint::${name} ALIAS viapoint_${name})
  target_include_directories(viapoint_${name}
    PUBLIC "${PROJECT_SOURCE_DIR}/cpp/include" PRIVATE "${PROJECT_SOURCE_DIR}/cpp/src")
  list(TRANSFORM arg_DEPENDS PREPEND viapoint::)
  target_link_libraries(viapoint_${name}
    PUBLIC ${arg_DEPENDS} ${arg_PUBLIC} Eigen3::Eigen
    PRIVATE ${arg_PRIVATE} $<BUILD_INTERFACE:viapoint_compiler>)
endfunction()

# viapoint_test(<module> [LINKS <module>...]): one GoogleTest executable out of the *.cpp of the folder.
function(viapoint_test name)
  cmake_parse_arguments(arg "" "" "LINKS;PRIVATE" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/*.cpp")
  if(NOT sources)
    return()
  endif()
  add_executable(test_${name} ${sources})
  list(TRANSFORM arg_LINKS PREPEND viapoint::)
  target_include_directories(test_${name} PRIVATE "${PROJECT_SOURCE_DIR}/tests/cpp")
  # Paths of the checkout come from a file and not from -D, so that ccache serves one checkout's
  # objects to another.
  set(paths "${PROJECT_BINARY_DIR}/tests/checkout_paths.hpp")
  file(CONFIGURE OUTPUT "${paths}" CONTENT [[
#define VIAPOINT_TEST_DATA "@PROJECT_SOURCE_DIR@/tests/data"
#define VIAPOINT_TEST_ROBOTS "@PROJECT_SOURCE_DIR@/python/viapoint/robots"
]] @ONLY)
  target_compile_options(test_${name} PRIVATE "SHELL:-include ${paths}")
  target_link_libraries(test_${name} PRIVATE
    ${arg_LINKS} ${arg_PRIVATE} viapoint_compiler GTest::gtest_main)
  gtest_discover_tests(test_${name} DISCOVERY_TIMEOUT 60 PROPERTIES LABELS ${name})
endfunction()
