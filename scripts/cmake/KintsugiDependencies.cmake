# The packages Kintsugi is built from, as imported targets. scripts/build installs them on Debian 12.

find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
pkg_check_modules(LCM REQUIRED IMPORTED_TARGET lcm)
pkg_check_modules(OPENNI2 REQUIRED IMPORTED_TARGET libopenni2)
pkg_check_modules(LIBAV REQUIRED IMPORTED_TARGET libavformat libavcodec libavutil libswscale)
pkg_check_modules(HTTPLIB REQUIRED IMPORTED_TARGET cpp-httplib)
find_program(LCM_GEN lcm-gen REQUIRED)
find_package(Eigen3 REQUIRED NO_MODULE)
find_package(OpenCV 4.6 REQUIRED COMPONENTS core imgproc imgcodecs videoio calib3d features2d)
find_package(CLI11 REQUIRED)
find_package(spdlog REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(TBB REQUIRED)
find_package(ZLIB REQUIRED)
find_package(flann REQUIRED CONFIG)
find_package(Ceres 2.1 REQUIRED)
find_library(LZ4_LIBRARY lz4 REQUIRED)  # packs blocks; FLANN's headers call it, too

# OpenCV's own targets carry no SYSTEM includes before CMake 3.25; ours do.
add_library(kintsugi_opencv INTERFACE)
target_include_directories(kintsugi_opencv SYSTEM INTERFACE ${OpenCV_INCLUDE_DIRS})
target_link_libraries(kintsugi_opencv INTERFACE ${OpenCV_LIBS})

add_library(kintsugi_flann INTERFACE)
target_link_libraries(kintsugi_flann INTERFACE flann::flann_cpp ${LZ4_LIBRARY})
