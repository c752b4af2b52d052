# Headers of other projects that most sources have, compiled once for all of them: for who builds everything anew with
# Clang, as .ci/run does. They hide includes that are missing, which a build without them finds.
option(PLIANT_PRECOMPILED_HEADERS "Compile headers of other projects once for all" OFF)

# pliant_precompile(OWNER HEADER): OWNER, a target without anything of its own, compiles what HEADER includes.
function(pliant_precompile OWNER HEADER)
  if(PLIANT_PRECOMPILED_HEADERS)
    target_precompile_headers(${OWNER} PRIVATE ${HEADER})
    target_link_libraries(${OWNER} PRIVATE Eigen3::Eigen OpenCL::OpenCL fmt::fmt nlohmann_json::nlohmann_json
      pliant_options)
  endif()
endfunction()

# pliant_reuse_precompiled(TARGET OWNER): TARGET has them too; it must be of OWNER's kind and optimised as OWNER is.
function(pliant_reuse_precompiled TARGET OWNER)
  if(PLIANT_PRECOMPILED_HEADERS)
    target_precompile_headers(${TARGET} REUSE_FROM ${OWNER})
    target_link_libraries(${TARGET} PRIVATE OpenCL::OpenCL) # for what is inline in its header
  endif()
endfunction()
