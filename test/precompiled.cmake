# What makes tests compile sooner.

# Most of the time goes into headers of others, which can be read once for all tests. A source that includes too little
# compiles then even so, and ccache finds nothing again: so test/run asks for it only where there is no compiler launcher.
option(BOX_QUERY_PRECOMPILE "Read headers of others once for all tests" OFF)

# Tests of what knows ROS wait most of the time, and judge none: they need not be fast.
set(bq_optimize_less)
if(bq_build_type STREQUAL RELEASE AND NOT CMAKE_CXX_FLAGS MATCHES "-fsanitize|-O")
  set(bq_optimize_less -O1)
endif()

#   bq_precompile(KIND HEADER...)   reads headers, for targets of that kind
function(bq_precompile kind)
  if(BOX_QUERY_PRECOMPILE AND COMMAND target_precompile_headers)
    add_library(${PROJECT_NAME}_${kind}_headers STATIC EXCLUDE_FROM_ALL precompiled.cpp)
    bq_configure(${PROJECT_NAME}_${kind}_headers)
    target_link_libraries(${PROJECT_NAME}_${kind}_headers ${GTEST_LIBRARIES})
    target_precompile_headers(${PROJECT_NAME}_${kind}_headers PRIVATE ${ARGN})
  endif()
endfunction()
set(headers <Eigen/Geometry> <algorithm> <gtest/gtest.h> <random> <sstream> <thread> <variant>)
bq_precompile(core ${headers} <boost/multiprecision/cpp_int.hpp>)
bq_precompile(ros ${headers} <ros/ros.h>)

# Takes these headers into a target of a kind, core or ros. It must not be hardened: its macros would be others.
function(bq_read_sooner target kind)
  set(headers ${PROJECT_NAME}_${kind}_headers)
  if(TARGET ${headers})
    # With the same options, for libraries and programs alike, with gtest or without.
    target_compile_options(${target} PRIVATE -fPIC $<TARGET_PROPERTY:${headers},COMPILE_OPTIONS>)
    target_precompile_headers(${target} REUSE_FROM ${headers})
  endif()
endfunction()

# What tests and tools of the core, or of what knows ROS, are compiled with.
function(bq_configure_for_tests target kind)
  bq_configure(${target})
  bq_read_sooner(${target} ${kind})
endfunction()

# The same for a gtest.
function(bq_configure_gtest target kind)
  bq_configure_for_tests(${target} ${kind})
  if(kind STREQUAL ros)
    target_compile_options(${target} PRIVATE ${bq_optimize_less})
  endif()
endfunction()

# What is installed is compiled as its users compile it, with the headers that it includes; once more under sanitizers, where
# it is not hardened, this need not be shown again.
if(CMAKE_CXX_FLAGS MATCHES "-fsanitize")
  bq_read_sooner(${PROJECT_NAME} core)
  foreach(name ros node nodelet probe publish_boxes)
    bq_read_sooner(${PROJECT_NAME}_${name} ros)
  endforeach()
endif()
