# OpenCV by module. Debian keeps OpenCVConfig.cmake in libopencv-dev, which brings a gigabyte of packages that
# nothing here needs; the few -dev packages of single modules come without one, so their files are found here.
find_package(OpenCV ${OpenCV_FIND_VERSION} CONFIG QUIET COMPONENTS ${OpenCV_FIND_COMPONENTS})
if(OpenCV_FOUND)
  return()
endif()

find_path(OpenCV_INCLUDE_DIR opencv2/core/version.hpp PATH_SUFFIXES opencv4)
mark_as_advanced(OpenCV_INCLUDE_DIR)
if(OpenCV_INCLUDE_DIR)
  file(STRINGS ${OpenCV_INCLUDE_DIR}/opencv2/core/version.hpp PARTS REGEX "#define CV_VERSION_(MAJOR|MINOR|REVISION) ")
  list(TRANSFORM PARTS REPLACE "[^0-9]*([0-9]+).*" "\\1")
  list(JOIN PARTS "." OpenCV_VERSION)
endif()
foreach(MODULE ${OpenCV_FIND_COMPONENTS})
  find_library(OpenCV_${MODULE}_LIBRARY opencv_${MODULE})
  mark_as_advanced(OpenCV_${MODULE}_LIBRARY)
  if(OpenCV_INCLUDE_DIR AND OpenCV_${MODULE}_LIBRARY)
    set(OpenCV_${MODULE}_FOUND TRUE)
    if(NOT TARGET opencv_${MODULE})
      add_library(opencv_${MODULE} UNKNOWN IMPORTED)
      set_target_properties(opencv_${MODULE} PROPERTIES
        IMPORTED_LOCATION ${OpenCV_${MODULE}_LIBRARY}
        INTERFACE_INCLUDE_DIRECTORIES ${OpenCV_INCLUDE_DIR})
    endif()
  endif()
endforeach()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenCV REQUIRED_VARS OpenCV_INCLUDE_DIR VERSION_VAR OpenCV_VERSION
  HANDLE_COMPONENTS)
