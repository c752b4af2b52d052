# `cmake --install` puts the libraries, the public headers and the program below the prefix.
include(CMakePackageConfigHelpers)
include(PliantPublicHeaders)
get_property(ROOMS GLOBAL PROPERTY PLIANT_ROOMS)

add_library(pliant_all INTERFACE)
set_target_properties(pliant_all PROPERTIES EXPORT_NAME pliant)
add_library(Pliant::pliant ALIAS pliant_all)
target_link_libraries(pliant_all INTERFACE ${ROOMS})
target_include_directories(pliant_all INTERFACE
  $<BUILD_INTERFACE:${PLIANT_PUBLIC_FOLDER}>
  $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)

install(TARGETS pliant_all ${ROOMS} EXPORT PliantTargets)
if(TARGET pliant)
  install(TARGETS pliant RUNTIME)
endif()
install(EXPORT PliantTargets NAMESPACE Pliant:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Pliant)
install(DIRECTORY ${PLIANT_PUBLIC_FOLDER}/pliant DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
set(PLIANT_EXPERIMENTS ${CMAKE_INSTALL_DATADIR}/pliant/experiments)
file(GLOB EXPERIMENTS CONFIGURE_DEPENDS experiments/*.yaml)
install(FILES ${EXPERIMENTS} DESTINATION ${PLIANT_EXPERIMENTS})
install(DIRECTORY experiments/methods experiments/chapter5 experiments/chapter6 DESTINATION ${PLIANT_EXPERIMENTS})
install(FILES experiments/README.md DESTINATION ${PLIANT_EXPERIMENTS})
configure_package_config_file(cmake/PliantConfig.cmake.in PliantConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Pliant PATH_VARS PLIANT_EXPERIMENTS)
write_basic_package_version_file(PliantConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/PliantConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/PliantConfigVersion.cmake
  cmake/FindOpenCV.cmake cmake/PliantEmbed.cmake cmake/Embed.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Pliant)
