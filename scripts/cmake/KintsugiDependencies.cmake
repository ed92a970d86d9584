# The packages Kintsugi is built from, as imported targets. scripts/build installs them on Debian 12.

find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
pkg_check_modules(LCM REQUIRED IMPORTED_TARGET lcm)
pkg_check_modules(SODIUM REQUIRED IMPORTED_TARGET libsodium)
pkg_check_modules(SYSTEMD REQUIRED IMPORTED_TARGET libsystemd)
pkg_check_modules(LZF REQUIRED IMPORTED_TARGET liblzf)
pkg_check_modules(OPENNI2 REQUIRED IMPORTED_TARGET libopenni2)
pkg_check_modules(OPENEXR REQUIRED IMPORTED_TARGET OpenEXR)
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

# Not find_package(PCL), which looks for VTK and Qt too.
pkg_check_modules(PCL REQUIRED IMPORTED_TARGET pcl_features)
add_library(kintsugi_pcl INTERFACE)
target_include_directories(kintsugi_pcl SYSTEM INTERFACE ${PCL_INCLUDE_DIRS})
target_link_libraries(kintsugi_pcl INTERFACE pcl_features pcl_search pcl_kdtree pcl_common kintsugi_flann)

# Debian's pkg-config file of librosbag-storage names packages that have none, and its headers look
# for those of others without their folder.
add_library(kintsugi_rosbag INTERFACE)
foreach(header pluginlib/class_loader.hpp class_loader/class_loader.hpp rcpputils/shared_library.hpp
        rcutils/allocator.h ament_index_cpp/get_package_prefix.hpp rosbag/bag.h sensor_msgs/Image.h
        geometry_msgs/Pose.h tf2_msgs/TFMessage.h)
  get_filename_component(package ${header} DIRECTORY)
  find_path(ROSBAG_INCLUDE_${package} ${header} PATH_SUFFIXES ${package} REQUIRED)
  mark_as_advanced(ROSBAG_INCLUDE_${package})
  target_include_directories(kintsugi_rosbag SYSTEM INTERFACE ${ROSBAG_INCLUDE_${package}})
endforeach()
foreach(library rosbag_storage roscpp_serialization rostime cpp_common console_bridge roslz4)
  find_library(ROSBAG_LIBRARY_${library} ${library} REQUIRED)
  mark_as_advanced(ROSBAG_LIBRARY_${library})
  target_link_libraries(kintsugi_rosbag INTERFACE ${ROSBAG_LIBRARY_${library}})
endforeach()
