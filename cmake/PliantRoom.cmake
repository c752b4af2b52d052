include(GNUInstallDirs)
include(PliantEmbed)

# pliant_room(NAME SOURCES file... [LINK target...] [PRIVATE_LINK target...])
# One library per room of the house, called pliant_NAME, exported as Pliant::NAME.
function(pliant_room NAME)
  cmake_parse_arguments(ROOM "" "" "SOURCES;LINK;PRIVATE_LINK" ${ARGN})
  add_library(pliant_${NAME} STATIC ${ROOM_SOURCES})
  add_library(Pliant::${NAME} ALIAS pliant_${NAME})
  set_target_properties(pliant_${NAME} PROPERTIES EXPORT_NAME ${NAME})
  target_include_directories(pliant_${NAME} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
  target_compile_features(pliant_${NAME} PUBLIC cxx_std_20)
  target_link_libraries(pliant_${NAME} PUBLIC ${ROOM_LINK}
    PRIVATE ${ROOM_PRIVATE_LINK} $<BUILD_INTERFACE:pliant_options>)
  set_property(GLOBAL APPEND PROPERTY PLIANT_ROOMS pliant_${NAME})
endfunction()
