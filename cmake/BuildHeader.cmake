# Writes what the program tells of its own build into OUTPUT (see experiments/runner).
execute_process(COMMAND git describe --always --dirty --exclude=* --abbrev=12
  WORKING_DIRECTORY "${SOURCE}" OUTPUT_VARIABLE COMMIT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET
  RESULT_VARIABLE FAILED)
if(FAILED)
  set(COMMIT unknown) # no git, or not a checkout
endif()
execute_process(COMMAND git diff HEAD WORKING_DIRECTORY "${SOURCE}" OUTPUT_VARIABLE CHANGES ERROR_QUIET)
string(SHA1 CHANGES "${CHANGES}")
if(FAILED)
  string(TIMESTAMP CHANGES "%s") # nothing tells one state of the sources from another
endif()
file(CONFIGURE OUTPUT "${OUTPUT}" @ONLY CONTENT [[
// Made by cmake/BuildHeader.cmake; do not edit.
#pragma once
#define PLIANT_VERSION "@VERSION@"
#define PLIANT_COMMIT "@COMMIT@"
#define PLIANT_CHANGES "@CHANGES@"
#define PLIANT_CERES_VERSION "@CERES@"
#define PLIANT_EIGEN_VERSION "@EIGEN@"
#define PLIANT_FLANN_VERSION "@FLANN@"
#define PLIANT_OPENCV_VERSION "@OPENCV@"
#define PLIANT_YAML_CPP_VERSION "@YAML_CPP@"
]])
