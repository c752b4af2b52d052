# Does what docs/adding-a-component.md tells its reader to do, to copies of the room `energies` and of the list of
# reports, and runs the tests there. Variables: SOURCE (the project), WORK (a folder to work in), ROOMS (the exported libraries) and
# CONFIGURE (arguments for configuring, separated by |).
cmake_minimum_required(VERSION 3.25)
file(READ ${SOURCE}/docs/adding-a-component.md DOCUMENT)

# The code block that follows the line "<TITLE>:".
function(code_block TITLE LANGUAGE OUTPUT)
  set(OPENING "${TITLE}:\n\n```${LANGUAGE}\n")
  string(FIND "${DOCUMENT}" "${OPENING}" BEGIN)
  if(BEGIN LESS 0)
    message(FATAL_ERROR "the document has no block of ${LANGUAGE} after '${TITLE}:'")
  endif()
  string(LENGTH "${OPENING}" LENGTH)
  math(EXPR BEGIN "${BEGIN} + ${LENGTH}")
  string(SUBSTRING "${DOCUMENT}" ${BEGIN} -1 REST)
  string(FIND "${REST}" "```" END)
  string(SUBSTRING "${REST}" 0 ${END} BLOCK)
  set(${OUTPUT} "${BLOCK}" PARENT_SCOPE)
endfunction()

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# The source file that the document shows as `FILE`, written to the tree; tests/adding_a_component/EXAMPLE is the
# same.
function(write_source FILE EXAMPLE)
  code_block("`${FILE}`" cpp TEXT)
  file(WRITE ${TREE}/${FILE} "${TEXT}")
  file(READ ${SOURCE}/tests/adding_a_component/${EXAMPLE} EXPECTED)
  if(NOT TEXT STREQUAL EXPECTED)
    message(FATAL_ERROR "the document and tests/adding_a_component/${EXAMPLE} differ")
  endif()
endfunction()

# What the document adds to the list MACRO(ITEM) of a file.
function(add_to_list FILE MACRO ITEM)
  code_block("In `${FILE}`, in the list `${MACRO}`" cpp NAME)
  string(STRIP "${NAME}" NAME)
  file(READ ${TREE}/${FILE} LIST_FILE)
  string(REPLACE "#define ${MACRO}(${ITEM})" "#define ${MACRO}(${ITEM}) ${NAME}" CHANGED "${LIST_FILE}")
  if(CHANGED STREQUAL LIST_FILE)
    message(FATAL_ERROR "${FILE} has no list ${MACRO}")
  endif()
  file(WRITE ${TREE}/${FILE} "${CHANGED}")
endfunction()

set(TREE ${WORK}/tree)
file(REMOVE_RECURSE ${TREE})
file(COPY ${SOURCE}/energies ${SOURCE}/cmake DESTINATION ${TREE})
file(COPY ${SOURCE}/experiments/report/reports.h ${SOURCE}/experiments/report/reports.cpp
  DESTINATION ${TREE}/experiments/report)
file(COPY ${SOURCE}/tests/adding_a_component/project/CMakeLists.txt DESTINATION ${TREE})

write_source(energies/stillness/equation.h stillness/equation.h)
write_source(energies/stillness/energy.cpp stillness/energy.cpp)
add_to_list(energies/energies.h PLIANT_ENERGIES ENERGY)
code_block("In an experiment file" yaml EXPERIMENT)
file(WRITE ${WORK}/experiment.yaml "${EXPERIMENT}")

write_source(experiments/report/csv.cpp csv/csv.cpp)
add_to_list(experiments/report/reports.h PLIANT_REPORTS REPORT)
code_block("Among the reports of an experiment" yaml REPORTS)
file(WRITE ${WORK}/reports.yaml "${REPORTS}")

string(REPLACE "|" ";" CONFIGURE "${CONFIGURE}")
run(${CMAKE_COMMAND} -S ${TREE} -B ${WORK}/build ${CONFIGURE} -DPLIANT_ROOMS=${ROOMS} -DPLIANT_SOURCE=${SOURCE})
run(${CMAKE_COMMAND} --build ${WORK}/build --parallel 2)
run(${CMAKE_COMMAND} -E env PLIANT_EXAMPLE=${WORK}/experiment.yaml ${WORK}/build/follow)
run(${CMAKE_COMMAND} -E env PLIANT_REPORT_EXAMPLE=${WORK}/reports.yaml ${WORK}/build/follow_report)
