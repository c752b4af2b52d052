function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE FAILED)
  if(FAILED)
    message(FATAL_ERROR "failed: ${ARGN}")
  endif()
endfunction()

file(REMOVE_RECURSE ${WORK}/prefix ${WORK}/outside)
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/outside -G ${GENERATOR} -DCMAKE_PREFIX_PATH=${WORK}/prefix
    -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_CXX_FLAGS=${FLAGS})
run(${CMAKE_COMMAND} --build ${WORK}/outside)
run(${WORK}/outside/bend)
run(${WORK}/prefix/bin/pliant check ${WORK}/prefix/share/pliant/experiments/sheet.yaml)
