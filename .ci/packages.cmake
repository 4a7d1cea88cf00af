# Finds the libraries and programs that Selvage is built with, in the versions that today's systems have. If some are
# missing, one message says all of them and how their packages are called.

set(missing "")

# Notes a library that is not there under the names of its packages.
function(selvage_need found what debian fedora arch)
    if(NOT found)
        set(missing "${missing}\n    ${what}\n        ${debian} | ${fedora} | ${arch}" PARENT_SCOPE)
    endif()
endfunction()

find_package(Eigen3 QUIET)
selvage_need("${Eigen3_FOUND}" "Eigen" libeigen3-dev eigen3-devel eigen)
find_package(TBB QUIET)
selvage_need("${TBB_FOUND}" "oneTBB" libtbb-dev tbb-devel onetbb)
find_package(tomlplusplus QUIET)
selvage_need("${tomlplusplus_FOUND}" "toml++" libtomlplusplus-dev tomlplusplus-devel tomlplusplus)
find_package(nlohmann_json QUIET)
selvage_need("${nlohmann_json_FOUND}" "JSON for Modern C++" nlohmann-json3-dev json-devel nlohmann-json)
find_package(CLI11 QUIET)
selvage_need("${CLI11_FOUND}" "CLI11" libcli11-dev cli11-devel cli11)
find_package(ZLIB QUIET)
selvage_need("${ZLIB_FOUND}" "zlib" zlib1g-dev zlib-devel zlib)
find_package(fmt QUIET)
selvage_need("${fmt_FOUND}" "fmt" libfmt-dev fmt-devel fmt)
find_package(benchmark QUIET)
selvage_need("${benchmark_FOUND}" "Google Benchmark" libbenchmark-dev google-benchmark-devel benchmark)
find_program(PYTHON python3 HINTS /usr/bin)   # the one that python3-h5py belongs to
selvage_need("${PYTHON}" "Python 3 and, for the end-to-end tests, h5py"
    "python3 python3-h5py" "python3 python3-h5py" "python python-h5py")

# Catch2 2 is a header; version 3 brings the test runner as a library, and fails by itself where no test is selected.
find_package(Catch2 QUIET)
selvage_need("${Catch2_FOUND}" "Catch2 2 or 3" catch2 catch-devel catch2)
add_library(selvage_catch INTERFACE)
if(Catch2_VERSION VERSION_LESS 3)
    target_link_libraries(selvage_catch INTERFACE Catch2::Catch2)
    set(catch_options --warn NoTests)
else()
    target_link_libraries(selvage_catch INTERFACE Catch2::Catch2WithMain)
    set(catch_options "")
endif()

# Both versions set these variables; only some packages have a target. Where there are both, headers and library have
# to be those of version 4.
set(CMAKE_FIND_PACKAGE_SORT_ORDER NATURAL)
set(CMAKE_FIND_PACKAGE_SORT_DIRECTION DEC)
find_package(embree QUIET)
if(embree_FOUND AND NOT EMBREE_VERSION_MAJOR MATCHES "^[34]$")
    set(embree_FOUND FALSE)
endif()
selvage_need("${embree_FOUND}" "Embree 3 or 4" libembree-dev embree-devel embree)
add_library(selvage_embree INTERFACE)
target_link_libraries(selvage_embree INTERFACE ${EMBREE_LIBRARY})
target_include_directories(selvage_embree SYSTEM INTERFACE ${EMBREE_INCLUDE_DIRS})

# Debian calls the variant without MPI hdf5-serial. Where there is no file for pkg-config, CMake asks h5cc.
add_library(selvage_hdf5 INTERFACE)
find_package(PkgConfig QUIET)
if(PkgConfig_FOUND)
    pkg_search_module(hdf5 QUIET IMPORTED_TARGET hdf5-serial hdf5)
endif()
if(hdf5_FOUND)
    target_link_libraries(selvage_hdf5 INTERFACE PkgConfig::hdf5)
else()
    enable_language(C)   # of which CMake's search makes use
    find_package(HDF5 QUIET COMPONENTS C)
    target_link_libraries(selvage_hdf5 INTERFACE ${HDF5_C_LIBRARIES})
    target_include_directories(selvage_hdf5 SYSTEM INTERFACE ${HDF5_C_INCLUDE_DIRS})
    set(hdf5_FOUND ${HDF5_FOUND})
endif()
selvage_need("${hdf5_FOUND}" "HDF5 and pkg-config"
    "libhdf5-dev pkg-config" "hdf5-devel pkgconf-pkg-config" "hdf5 pkgconf")

# Debian's libopencv-core-dev and its siblings bring no CMake file; that one pulls in all of OpenCV.
add_library(selvage_opencv INTERFACE)
find_path(OPENCV_INCLUDE opencv2/core.hpp PATH_SUFFIXES opencv4)
set(opencv_FOUND ${OPENCV_INCLUDE})
target_include_directories(selvage_opencv SYSTEM INTERFACE ${OPENCV_INCLUDE})
foreach(module core imgproc imgcodecs)
    find_library(OPENCV_${module} opencv_${module})
    if(NOT OPENCV_${module})
        set(opencv_FOUND FALSE)
    endif()
    target_link_libraries(selvage_opencv INTERFACE ${OPENCV_${module}})
endforeach()
selvage_need("${opencv_FOUND}" "OpenCV 4 (core, imgproc, imgcodecs)"
    "libopencv-core-dev libopencv-imgproc-dev libopencv-imgcodecs-dev" opencv-devel opencv)

if(missing)
    message(FATAL_ERROR "Selvage is not built, since this is missing; below each, its packages on "
        "Debian and Ubuntu | Fedora | Arch:${missing}")
endif()
