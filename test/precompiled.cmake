# What makes tests compile sooner.

# Most of the time goes into headers of others, which can be read once for all tests. A source that includes too little
# compiles then even so, and ccache finds nothing again: so test/run asks for it only where there is no compiler launcher.
option(BOX_QUERY_PRECOMPILE "Read headers of others once for all tests" OFF)

# Tests of what knows ROS wait most of the time, and judge none: they need not be fast.
set(bq_optimize_less)
if(bq_build_type STREQUAL RELEASE AND NOT CMAKE_CXX_FLAGS MATCHES "-fsanitize|-O")
  set(bq_optimize_less -O1)
endif()

#   bq_precompile(NAME OPTION HEADER...)   reads headers, for targets with that option and no other (or "")
function(bq_precompile name option)
  if(BOX_QUERY_PRECOMPILE AND COMMAND target_precompile_headers)
    #catkin_lint: ignore_once uninstalled_target
    add_executable(${PROJECT_NAME}_${name} EXCLUDE_FROM_ALL precompiled.cpp)
    bq_configure(${PROJECT_NAME}_${name})
    target_compile_options(${PROJECT_NAME}_${name} PRIVATE ${option})
    target_link_libraries(${PROJECT_NAME}_${name} ${GTEST_LIBRARIES})
    target_precompile_headers(${PROJECT_NAME}_${name} PRIVATE ${ARGN})
  endif()
endfunction()
set(headers <Eigen/Geometry> <algorithm> <gtest/gtest.h> <random> <sstream> <thread> <variant>)
bq_precompile(core_headers "" ${headers})
bq_precompile(ros_headers "${bq_optimize_less}" ${headers} <ros/ros.h>)

# For a gtest of the core, or of what knows ROS.
function(bq_compile_sooner target kind)
  if(kind STREQUAL ros)
    target_compile_options(${target} PRIVATE ${bq_optimize_less})
  endif()
  if(TARGET ${PROJECT_NAME}_${kind}_headers)
    target_precompile_headers(${target} REUSE_FROM ${PROJECT_NAME}_${kind}_headers)
  endif()
endfunction()
