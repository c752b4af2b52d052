# Fails when the simulator finds anything, or when it did not run the registration to its end.
if(NOT OCLGRIND)
  message("SKIPPED: oclgrind is not installed")
  return()
endif()
# One thread and unoptimised kernels: the simulator's own record of what was written is neither safe with several
# threads nor complete for vectors that live across loops (version 21.10).
execute_process(
  COMMAND ${OCLGRIND} --num-threads 1 ${CHECKS} --build-options -cl-opt-disable
          ${PROGRAM} run ${EXPERIMENT} --out ${OUT}
  OUTPUT_VARIABLE PRINTED ERROR_VARIABLE PRINTED RESULT_VARIABLE CODE)
message("${PRINTED}")
if(NOT CODE EQUAL 0)
  message(FATAL_ERROR "the registration ended with ${CODE}")
endif()
if(PRINTED MATCHES "Invalid|Uninitiali[sz]ed|race|Oclgrind:")
  message(FATAL_ERROR "the simulator found an error")
endif()
file(READ ${OUT}/result.json RESULT)
string(JSON DEVICE GET "${RESULT}" environment device)
if(NOT DEVICE MATCHES "Oclgrind")
  message(FATAL_ERROR "the registration ran on ${DEVICE}, not in the simulator")
endif()
