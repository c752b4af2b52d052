# `cmake --install` puts the libraries, their headers and the program below the prefix.
include(CMakePackageConfigHelpers)
get_property(ROOMS GLOBAL PROPERTY PLIANT_ROOMS)

add_library(pliant_all INTERFACE)
set_target_properties(pliant_all PROPERTIES EXPORT_NAME pliant)
add_library(Pliant::pliant ALIAS pliant_all)
target_link_libraries(pliant_all INTERFACE ${ROOMS})

install(TARGETS pliant_all ${ROOMS} EXPORT PliantTargets)
if(TARGET pliant)
  install(TARGETS pliant RUNTIME)
endif()
install(EXPORT PliantTargets NAMESPACE Pliant:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Pliant)
install(DIRECTORY framework energies graphs samplers solvers
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/pliant FILES_MATCHING PATTERN "*.h")
install(DIRECTORY experiments/datasets experiments/report experiments/tasks experiments/runner
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/pliant/experiments FILES_MATCHING PATTERN "*.h")
set(PLIANT_EXPERIMENTS ${CMAKE_INSTALL_DATADIR}/pliant/experiments)
file(GLOB EXPERIMENTS CONFIGURE_DEPENDS experiments/*.yaml)
install(FILES ${EXPERIMENTS} DESTINATION ${PLIANT_EXPERIMENTS})
install(DIRECTORY experiments/methods DESTINATION ${PLIANT_EXPERIMENTS})
configure_package_config_file(cmake/PliantConfig.cmake.in PliantConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Pliant PATH_VARS PLIANT_EXPERIMENTS)
write_basic_package_version_file(PliantConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/PliantConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/PliantConfigVersion.cmake
  cmake/FindOpenCV.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/Pliant)
