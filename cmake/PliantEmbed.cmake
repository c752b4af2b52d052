# pliant_embed(TARGET file...): makes each text file (a kernel, an equation) available to C++ as the
# constant `pliant::embedded::<folders>_<stem>_<extension>`, declared in "<path of the file>.embed.h"; the path starts
# at the project's top folder.
function(pliant_embed TARGET)
  foreach(FILE ${ARGN})
    cmake_path(ABSOLUTE_PATH FILE BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} NORMALIZE OUTPUT_VARIABLE INPUT)
    cmake_path(RELATIVE_PATH INPUT BASE_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE RELATIVE)
    pliant_embed_as(${TARGET} ${INPUT} ${RELATIVE})
  endforeach()
endfunction()

# pliant_embed_as(TARGET INPUT RELATIVE): the same of a file that the build makes, as if it were at RELATIVE.
function(pliant_embed_as TARGET INPUT RELATIVE)
  set(OUTPUT ${PROJECT_BINARY_DIR}/embedded/${RELATIVE}.embed.h)
  set(SCRIPT ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/Embed.cmake)
  add_custom_command(OUTPUT ${OUTPUT}
    COMMAND ${CMAKE_COMMAND} -DINPUT=${INPUT} -DOUTPUT=${OUTPUT} -DRELATIVE=${RELATIVE} -P ${SCRIPT}
    DEPENDS ${INPUT} ${SCRIPT}
    COMMENT "Embedding ${RELATIVE}" VERBATIM)
  target_sources(${TARGET} PRIVATE ${OUTPUT})
  target_include_directories(${TARGET} PRIVATE ${PROJECT_BINARY_DIR}/embedded)
endfunction()
