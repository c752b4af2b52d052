# Compiler settings that every target of the project shares.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()

add_library(pliant_options INTERFACE)
target_compile_options(pliant_options INTERFACE -Wall -Wextra
  "$<$<CXX_COMPILER_ID:Clang>:-Wreserved-identifier;-Wreserved-macro-identifier>")
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # GCC bug 105651: `"text" + std::string` warns of copies that cannot happen.
  target_compile_options(pliant_options INTERFACE -Wno-restrict)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(pliant_options INTERFACE -Wno-subobject-linkage) # takes sources that are joined for headers
endif()
if(PLIANT_WARNINGS_AS_ERRORS)
  target_compile_options(pliant_options INTERFACE -Werror)
endif()
if(PLIANT_COVERAGE)
  # Counters in the functions of system headers, of tests and of experiments, which nobody reads, cost a sixth of a build.
  target_compile_options(pliant_options INTERFACE --coverage -fprofile-update=atomic
    "-fprofile-filter-files=^${PROJECT_SOURCE_DIR}/(framework|energies|graphs|samplers|solvers)/")
  target_link_options(pliant_options INTERFACE --coverage)
endif()
