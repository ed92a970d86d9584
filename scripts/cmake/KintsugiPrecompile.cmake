# Precompiled headers: what most sources include of the standard library, Eigen, OpenCV and
# GoogleTest is parsed once instead of some five hundred times. Everything compiles without them too.
option(KINTSUGI_PRECOMPILE "Use precompiled headers" ON)

# ccache, where it is installed, keeps what was compiled, for other clones too: it is told to ignore
# the clone's path and the dates of headers, and that it may keep precompiled headers.
find_program(KINTSUGI_CCACHE ccache)
if(KINTSUGI_CCACHE AND NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER env CCACHE_BASEDIR=${CMAKE_SOURCE_DIR}
      CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime
      ${KINTSUGI_CCACHE})
endif()

# kintsugi_add_precompiled(KIND LIBRARIES library... [HEADERS header...] [OPTIONS option...])
# precompiles precompiled.hpp and the headers named, as KIND. GCC accepts the result only in a
# compilation with the same options and at least the same definitions, so it is compiled with the
# options of the targets that use it.
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
  # <>, so that the file CMake writes names no folder, and ccache knows it again in another clone.
  target_precompile_headers(${target} PRIVATE <scripts/cmake/precompiled.hpp> ${arg_HEADERS})
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

# kintsugi_targets(RESULT TYPE folder...): the targets of this type in these folders and below.
function(kintsugi_targets result type)
  set(found)
  foreach(folder IN LISTS ARGN)
    get_property(targets DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
    foreach(target IN LISTS targets)
      get_target_property(target_type ${target} TYPE)
      if(target_type STREQUAL type)
        list(APPEND found ${target})
      endif()
    endforeach()
    get_property(folders DIRECTORY ${folder} PROPERTY SUBDIRECTORIES)
    kintsugi_targets(below ${type} ${folders})
    list(APPEND found ${below})
  endforeach()
  set(${result} ${found} PARENT_SCOPE)
endfunction()
