include(GNUInstallDirs)

# pliant_room(NAME SOURCES file... [LINK target...] [PRIVATE_LINK target...])
# One library per room of the house, called pliant_NAME, exported as Pliant::NAME.
function(pliant_room NAME)
  cmake_parse_arguments(ROOM "" "" "SOURCES;LINK;PRIVATE_LINK" ${ARGN})
  add_library(pliant_${NAME} STATIC ${ROOM_SOURCES})
  add_library(Pliant::${NAME} ALIAS pliant_${NAME})
  set_target_properties(pliant_${NAME} PROPERTIES EXPORT_NAME ${NAME})
  target_include_directories(pliant_${NAME} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/pliant>)
  target_compile_features(pliant_${NAME} PUBLIC cxx_std_20)
  target_link_libraries(pliant_${NAME} PUBLIC ${ROOM_LINK}
    PRIVATE ${ROOM_PRIVATE_LINK} $<BUILD_INTERFACE:pliant_options>)
  set_property(GLOBAL APPEND PROPERTY PLIANT_ROOMS pliant_${NAME})
endfunction()

# pliant_embed(TARGET file...): makes each text file (a kernel, an equation) available to C++ as the
# constant `pliant::embedded::<folder>_<stem>_<extension>`, declared in "<path of the file>.embed.h".
function(pliant_embed TARGET)
  foreach(FILE ${ARGN})
    set(INPUT ${CMAKE_CURRENT_SOURCE_DIR}/${FILE})
    cmake_path(RELATIVE_PATH INPUT BASE_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE RELATIVE)
    set(OUTPUT ${PROJECT_BINARY_DIR}/embedded/${RELATIVE}.embed.h)
    add_custom_command(OUTPUT ${OUTPUT}
      COMMAND ${CMAKE_COMMAND} -DINPUT=${INPUT} -DOUTPUT=${OUTPUT} -DRELATIVE=${RELATIVE}
              -P ${PROJECT_SOURCE_DIR}/cmake/Embed.cmake
      DEPENDS ${INPUT} ${PROJECT_SOURCE_DIR}/cmake/Embed.cmake
      COMMENT "Embedding ${RELATIVE}" VERBATIM)
    target_sources(${TARGET} PRIVATE ${OUTPUT})
  endforeach()
  target_include_directories(${TARGET} PRIVATE ${PROJECT_BINARY_DIR}/embedded)
endfunction()
