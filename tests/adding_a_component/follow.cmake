# Does what docs/adding-a-component.md tells its reader to do, to a copy of the room `energies`, and runs the
# tests there. Variables: SOURCE (the project), WORK (a folder to work in), ROOMS (the exported libraries) and
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

set(TREE ${WORK}/tree)
file(REMOVE_RECURSE ${TREE})
file(COPY ${SOURCE}/energies ${SOURCE}/cmake DESTINATION ${TREE})
file(COPY ${SOURCE}/tests/adding_a_component/project/CMakeLists.txt DESTINATION ${TREE})

foreach(FILE equation.h energy.cpp)
  code_block("`energies/stillness/${FILE}`" cpp TEXT)
  file(WRITE ${TREE}/energies/stillness/${FILE} "${TEXT}")
  file(READ ${SOURCE}/tests/adding_a_component/stillness/${FILE} EXAMPLE)
  if(NOT TEXT STREQUAL EXAMPLE)
    message(FATAL_ERROR "the document and tests/adding_a_component/stillness/${FILE} differ")
  endif()
endforeach()

code_block("In `energies/energies.h`, in the list `PLIANT_ENERGIES`" cpp NAME)
string(STRIP "${NAME}" NAME)
file(READ ${TREE}/energies/energies.h LIST_FILE)
string(REPLACE "#define PLIANT_ENERGIES(ENERGY)" "#define PLIANT_ENERGIES(ENERGY) ${NAME}" CHANGED "${LIST_FILE}")
if(CHANGED STREQUAL LIST_FILE)
  message(FATAL_ERROR "energies.h has no list PLIANT_ENERGIES")
endif()
file(WRITE ${TREE}/energies/energies.h "${CHANGED}")

code_block("In an experiment file" yaml EXPERIMENT)
file(WRITE ${WORK}/experiment.yaml "${EXPERIMENT}")

string(REPLACE "|" ";" CONFIGURE "${CONFIGURE}")
run(${CMAKE_COMMAND} -S ${TREE} -B ${WORK}/build ${CONFIGURE} -DPLIANT_ROOMS=${ROOMS} -DPLIANT_SOURCE=${SOURCE})
run(${CMAKE_COMMAND} --build ${WORK}/build --parallel 2)
run(${CMAKE_COMMAND} -E env PLIANT_EXAMPLE=${WORK}/experiment.yaml ${WORK}/build/follow)
