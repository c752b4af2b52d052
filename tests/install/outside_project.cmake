function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE FAILED)
  if(FAILED)
    message(FATAL_ERROR "failed: ${ARGN}")
  endif()
endfunction()

# The README's one block of C++.
file(READ ${README} TEXT)
if(NOT TEXT MATCHES "\n```cpp\n([^`]+)```\n")
  message(FATAL_ERROR "${README} has no block of C++")
endif()
file(WRITE ${WORK}/readme.cpp "${CMAKE_MATCH_1}")

file(REMOVE_RECURSE ${WORK}/prefix ${WORK}/outside)
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/outside -G ${GENERATOR} -DCMAKE_PREFIX_PATH=${WORK}/prefix
    -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_CXX_FLAGS=${FLAGS} -DREADME_EXAMPLE=${WORK}/readme.cpp)
run(${CMAKE_COMMAND} --build ${WORK}/outside)
run(${WORK}/outside/readme)
run(${WORK}/outside/own_energy)
run(${WORK}/prefix/bin/pliant check ${WORK}/prefix/share/pliant/experiments/sheet.yaml)
