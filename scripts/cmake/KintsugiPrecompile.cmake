# Precompiled headers: what most sources include of the standard library, Eigen, OpenCV and
# GoogleTest is parsed once instead of some five hundred times. They hold no header of our own, so a
# change of ours never rebuilds them. Every source includes what it uses all the same: it compiles
# with -DKINTSUGI_PRECOMPILE=OFF too, and scripts/lint reads it that way.
option(KINTSUGI_PRECOMPILE "Use precompiled headers" ON)

# ccache, where it is installed, keeps what was compiled across clones. It is told not to look at the
# dates of headers (a fresh clone has new ones), and that precompiled headers say all that matters.
find_program(KINTSUGI_CCACHE ccache)
if(KINTSUGI_CCACHE AND NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER env
      CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime
      ${KINTSUGI_CCACHE})
endif()

# The headers that a library or a test most often includes.
set(KINTSUGI_COMMON_HEADERS
  <algorithm> <array> <atomic> <chrono> <cmath> <condition_variable> <cstdint> <cstring> <deque>
  <filesystem> <fstream> <functional> <limits> <map> <memory> <mutex> <numeric> <optional> <random>
  <set> <span> <sstream> <stdexcept> <string> <string_view> <thread> <tuple> <unordered_map>
  <utility> <variant> <vector> <Eigen/Core> <Eigen/Geometry>)

# kintsugi_add_precompiled(KIND HEADERS header... LIBRARIES library... [OPTIONS option...])
# defines the precompiled headers KIND. GCC accepts them only in a compilation that has the same
# options and at least the same definitions, so they get the options of the targets that use them.
function(kintsugi_add_precompiled kind)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "HEADERS;LIBRARIES;OPTIONS")
  if(NOT KINTSUGI_PRECOMPILE)
    return()
  endif()
  # CMake wants a source in each target.
  set(source ${CMAKE_BINARY_DIR}/precompiled/${kind}.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "// Left empty on purpose.\n")
  set(target kintsugi_precompiled_${kind})
  add_library(${target} OBJECT ${source})
  target_link_libraries(${target} PRIVATE kintsugi_options ${arg_LIBRARIES})
  target_compile_options(${target} PRIVATE ${arg_OPTIONS})
  target_precompile_headers(${target} PRIVATE ${arg_HEADERS})
endfunction()

# kintsugi_precompile(KIND target...): these targets use the precompiled headers KIND.
function(kintsugi_precompile kind)
  if(NOT KINTSUGI_PRECOMPILE)
    return()
  endif()
  foreach(target IN LISTS ARGN)
    target_precompile_headers(${target} REUSE_FROM kintsugi_precompiled_${kind})
  endforeach()
endfunction()
