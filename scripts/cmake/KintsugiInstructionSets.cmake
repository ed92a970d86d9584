# Sources compiled for an instruction set wider than the build's.

if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  set(KINTSUGI_X86_KERNELS TRUE)
else()
  set(KINTSUGI_X86_KERNELS FALSE)
endif()

# <prefix>_avx2.cpp and <prefix>_avx512.cpp are compiled for what their names say, or not at all
# where the processor is of another family. To be called from where their target is made.
function(kintsugi_instruction_set_sources prefix)
  if(KINTSUGI_X86_KERNELS)
    set_source_files_properties(${prefix}_avx2.cpp PROPERTIES COMPILE_OPTIONS "-mavx2")
    set_source_files_properties(${prefix}_avx512.cpp PROPERTIES COMPILE_OPTIONS
                                "-mavx512f;-mavx512bw;-mavx512dq;-mavx512vl")
    # Headers precompiled for the build's own instruction set do not fit these.
    set_source_files_properties(${prefix}_avx2.cpp ${prefix}_avx512.cpp
                                PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
  else()
    set_source_files_properties(${prefix}_avx2.cpp ${prefix}_avx512.cpp
                                PROPERTIES HEADER_FILE_ONLY ON)
  endif()
endfunction()
