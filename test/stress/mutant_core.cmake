# A copy of the core in which error bounds are variables and decisions can be spoilt, so that a test can show that the
# stress suite notices. Made when CMake configures, again when a source changes; a patch that finds no place is an error.

set(mutant_dir ${CMAKE_CURRENT_BINARY_DIR}/mutant)
file(GLOB_RECURSE core_files RELATIVE ${PROJECT_SOURCE_DIR}
  ${PROJECT_SOURCE_DIR}/src/exact/*.h ${PROJECT_SOURCE_DIR}/src/exact/*.cpp
  ${PROJECT_SOURCE_DIR}/src/geometry/*.h ${PROJECT_SOURCE_DIR}/src/geometry/*.cpp
  ${PROJECT_SOURCE_DIR}/src/kernels/*.h ${PROJECT_SOURCE_DIR}/src/kernels/*.cpp
  ${PROJECT_SOURCE_DIR}/src/scene/*.h ${PROJECT_SOURCE_DIR}/src/scene/*.cpp)
foreach(file ${core_files})
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${file})
  file(READ ${PROJECT_SOURCE_DIR}/${file} text)
  # Constants made of a bound cannot be constants where the bound is none.
  string(REGEX REPLACE "constexpr double ([A-Za-z]+) = ((exact::)?bounds::)" "const double \\1 = \\2" text "${text}")
  set(text_of_${file} "${text}")
endforeach()

# Every bound of a file becomes a variable.
function(bq_free_bounds file)
  string(REPLACE "\nconstexpr double k" "\ninline double k" text "${text_of_${file}}")
  if(text STREQUAL text_of_${file})
    message(FATAL_ERROR "test/stress/mutant_core.cmake: ${file} has no bounds")
  endif()
  set(text_of_${file} "${text}" PARENT_SCOPE)
endfunction()

function(bq_patch file from to)
  string(FIND "${text_of_${file}}" "${from}" place)
  if(place EQUAL -1)
    message(FATAL_ERROR "test/stress/mutant_core.cmake: ${file} does not contain: ${from}")
  endif()
  string(REPLACE "${from}" "${to}" text "${text_of_${file}}")
  string(REPLACE "#pragma once\n" "#pragma once\n#include \"stress/mutation.h\"\n" text "${text}")
  set(text_of_${file} "${text}" PARENT_SCOPE)
endfunction()

bq_free_bounds(src/exact/bounds.h)
bq_free_bounds(src/exact/distance_bounds.h)
bq_free_bounds(src/kernels/float_bounds.h)
bq_patch(src/exact/clip.h "if (!outside && order <= 0) {" "if (!outside && order <= (mutation.touching_misses ? -1 : 0)) {")
bq_patch(src/exact/clip.h "if (enters >= 0) {" "if (enters >= (mutation.ties_name_one_face ? 1 : 0)) {")
bq_patch(src/exact/clip.h "  return order != kUnknownSign;" "  return mutation.skip_exact_stage || order != kUnknownSign;")
bq_patch(src/exact/estimate.h "return above == below &&" "return (mutation.skip_rounding_test || above == below) &&")
bq_patch(src/geometry/distance_refine.cpp "if (kernels::active().refine !=" "if (!mutation.refine_by_axes && kernels::active().refine !=")
bq_patch(src/geometry/solve.cpp "return meetsSlowly(" "return mutation.skip_slow_stages || meetsSlowly(")

# Only what has changed is written, and compiled, again.
foreach(file ${core_files})
  file(GENERATE OUTPUT ${mutant_dir}/${file} CONTENT "${text_of_${file}}")
endforeach()
get_target_property(core_sources ${PROJECT_NAME} SOURCES)
set(mutant_sources)
foreach(file ${core_sources})
  list(APPEND mutant_sources ${mutant_dir}/${file})
endforeach()
add_library(${PROJECT_NAME}_mutant STATIC EXCLUDE_FROM_ALL ${mutant_sources})
bq_configure_for_tests(${PROJECT_NAME}_mutant core)
target_link_libraries(${PROJECT_NAME}_mutant ${TBB_LIBRARY})
#catkin_lint: ignore_once missing_directory
target_include_directories(${PROJECT_NAME}_mutant BEFORE PRIVATE ${mutant_dir}/src)
