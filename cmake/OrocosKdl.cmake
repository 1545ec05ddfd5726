# Debian's package sets variables only; this is the one place that turns them into a target.
find_package(orocos_kdl REQUIRED)
add_library(viapoint_orocos_kdl INTERFACE)
target_include_directories(viapoint_orocos_kdl SYSTEM INTERFACE ${orocos_kdl_INCLUDE_DIRS})
target_link_libraries(viapoint_orocos_kdl INTERFACE ${orocos_kdl_LIBRARIES})
