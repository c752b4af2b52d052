# pliant_npm_install(FOLDER SOURCE): puts what SOURCE/package-lock.json names into FOLDER/node_modules, unless it is
# there. Sets PLIANT_NODE to the program that runs it; where it cannot be had, PLIANT_NODE is empty and
# FOLDER/missing says why. Configuring again tries again.
function(pliant_npm_install FOLDER SOURCE)
  set(PLIANT_NODE "" PARENT_SCOPE)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${SOURCE}/package-lock.json)
  file(MAKE_DIRECTORY ${FOLDER})
  find_program(NODE_PROGRAM node NO_CACHE)
  find_program(NPM_PROGRAM npm NO_CACHE)
  if(NOT NODE_PROGRAM OR NOT NPM_PROGRAM)
    file(WRITE ${FOLDER}/missing "node and npm are not installed")
    return()
  endif()
  execute_process(COMMAND ${NODE_PROGRAM} --version OUTPUT_VARIABLE VERSION ERROR_QUIET)
  string(REGEX REPLACE "^v([0-9.]+).*" "\\1" VERSION "${VERSION}")
  if(VERSION VERSION_LESS 18)
    file(WRITE ${FOLDER}/missing "node is older than version 18")
    return()
  endif()
  file(SHA256 ${SOURCE}/package-lock.json WANTED)
  if(EXISTS ${FOLDER}/installed)
    file(READ ${FOLDER}/installed INSTALLED)
  endif()
  if(NOT "${INSTALLED}" STREQUAL "${WANTED}")
    file(REMOVE ${FOLDER}/installed)
    file(COPY ${SOURCE}/package.json ${SOURCE}/package-lock.json DESTINATION ${FOLDER})
    message(STATUS "Installing what ${SOURCE}/package-lock.json names")
    execute_process(COMMAND ${NPM_PROGRAM} ci --ignore-scripts --no-audit --no-fund --prefer-offline
        --fetch-retries=1 --fetch-retry-mintimeout=1000 --fetch-timeout=30000
      WORKING_DIRECTORY ${FOLDER} RESULT_VARIABLE FAILED OUTPUT_VARIABLE LOG ERROR_VARIABLE LOG TIMEOUT 180)
    file(WRITE ${FOLDER}/npm.log "${LOG}")
    if(NOT FAILED STREQUAL "0")
      file(WRITE ${FOLDER}/missing "npm could not install what it should (${FOLDER}/npm.log says why)")
      return()
    endif()
    file(WRITE ${FOLDER}/installed ${WANTED})
  endif()
  file(REMOVE ${FOLDER}/missing)
  set(PLIANT_NODE ${NODE_PROGRAM} PARENT_SCOPE)
endfunction()

# pliant_web_bundle(TARGET FOLDER): makes the scripts and styles of FOLDER one of each and embeds them as
# "web/report.js" and "web/report.css". Without npm both are empty.
function(pliant_web_bundle TARGET FOLDER)
  cmake_path(ABSOLUTE_PATH FOLDER NORMALIZE OUTPUT_VARIABLE SOURCE)
  set(BUNDLE ${PROJECT_BINARY_DIR}/web)
  set(OUTPUTS ${BUNDLE}/report.js ${BUNDLE}/report.css)
  pliant_npm_install(${BUNDLE} ${SOURCE})
  if(PLIANT_NODE)
    file(GLOB SCRIPTS CONFIGURE_DEPENDS ${SOURCE}/*.js ${SOURCE}/*.mjs)
    add_custom_command(OUTPUT ${OUTPUTS}
      COMMAND ${CMAKE_COMMAND} -E copy ${SCRIPTS} ${BUNDLE}
      COMMAND ${PLIANT_NODE} bundle.mjs
      DEPENDS ${SCRIPTS} ${BUNDLE}/installed WORKING_DIRECTORY ${BUNDLE}
      COMMENT "Bundling the scripts of the pages" VERBATIM)
  else()
    file(READ ${BUNDLE}/missing REASON)
    message(WARNING "The figures of the pages will be pictures: ${REASON}.")
    add_custom_command(OUTPUT ${OUTPUTS}
      COMMAND ${CMAKE_COMMAND} -E rm -f ${OUTPUTS}
      COMMAND ${CMAKE_COMMAND} -E touch ${OUTPUTS}
      DEPENDS ${BUNDLE}/missing
      COMMENT "Doing without the scripts of the pages" VERBATIM)
  endif()
  foreach(NAME report.js report.css)
    pliant_embed_as(${TARGET} ${BUNDLE}/${NAME} web/${NAME})
  endforeach()
endfunction()
