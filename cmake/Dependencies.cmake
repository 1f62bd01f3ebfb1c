# SPDX-License-Identifier: GPL-3.0-or-later
# Every outside library ramify uses, as imported targets named deps::NAME. All are Debian 12 packages.
find_package(PkgConfig REQUIRED)
find_package(Eigen3 REQUIRED NO_MODULE)
find_package(OpenCV REQUIRED COMPONENTS core imgproc)
find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)
find_package(Threads REQUIRED)
find_package(OpenSSL REQUIRED COMPONENTS Crypto)
pkg_check_modules(VIPS REQUIRED IMPORTED_TARGET vips)
pkg_check_modules(OPENEXR REQUIRED IMPORTED_TARGET OpenEXR)
pkg_check_modules(FFTW REQUIRED IMPORTED_TARGET fftw3f)
pkg_check_modules(PUGIXML REQUIRED IMPORTED_TARGET pugixml)
pkg_check_modules(MAXFLOW REQUIRED IMPORTED_TARGET maxflow)
find_path(SVM_INCLUDE_DIR svm.h PATH_SUFFIXES libsvm REQUIRED)
find_library(SVM_LIBRARY svm REQUIRED)

# OpenCV's imported targets drag in every module's include path only; core and imgproc are all we link.
add_library(deps_opencv INTERFACE)
target_link_libraries(deps_opencv INTERFACE opencv_core opencv_imgproc)
target_include_directories(deps_opencv SYSTEM INTERFACE ${OpenCV_INCLUDE_DIRS})
add_library(deps::opencv ALIAS deps_opencv)

add_library(deps_svm INTERFACE)
target_include_directories(deps_svm SYSTEM INTERFACE ${SVM_INCLUDE_DIR})
target_link_libraries(deps_svm INTERFACE ${SVM_LIBRARY})
add_library(deps::svm ALIAS deps_svm)

add_library(deps::vips ALIAS PkgConfig::VIPS)
add_library(deps::openexr ALIAS PkgConfig::OPENEXR)
add_library(deps::fftw ALIAS PkgConfig::FFTW)
add_library(deps::pugixml ALIAS PkgConfig::PUGIXML)
add_library(deps::maxflow ALIAS PkgConfig::MAXFLOW)
