# The public headers: what others include as "pliant/NAME.h". They may include each other, the standard library,
# Eigen and, in make_equation.h alone, Ceres. All other headers are private and not installed.
set(PUBLIC_HEADERS
  experiments/api/pliant.h
  experiments/api/register_depth.h
  experiments/runner/components.h
  framework/core/error.h
  framework/core/log.h
  framework/core/parameters.h
  framework/core/registry.h
  framework/device/kernel_math.h
  framework/geometry/camera.h
  framework/problem/energy.h
  framework/problem/equation.h
  framework/problem/make_equation.h)

# Published as copies whose includes say where the others are then.
set(PLIANT_PUBLIC_FOLDER ${PROJECT_BINARY_DIR}/include)
file(REMOVE_RECURSE ${PLIANT_PUBLIC_FOLDER})
foreach(HEADER ${PUBLIC_HEADERS})
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${HEADER})
  file(READ ${PROJECT_SOURCE_DIR}/${HEADER} TEXT)
  foreach(OTHER ${PUBLIC_HEADERS})
    cmake_path(GET OTHER FILENAME NAME)
    string(REPLACE "#include \"${OTHER}\"" "#include \"pliant/${NAME}\"" TEXT "${TEXT}")
  endforeach()
  string(REGEX MATCH "#include \"(framework|energies|graphs|samplers|solvers|experiments)/[^\"]*\"" PRIVATE "${TEXT}")
  if(PRIVATE)
    message(FATAL_ERROR "${HEADER} is public and must not have ${PRIVATE}, which is private")
  endif()
  cmake_path(GET HEADER FILENAME NAME)
  file(WRITE ${PLIANT_PUBLIC_FOLDER}/pliant/${NAME} "${TEXT}")
endforeach()
