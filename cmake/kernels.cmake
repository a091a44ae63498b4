# Flags of single files: the wide copies of the solver's kernels. The rest of the library runs on any
# x86-64 (no -march=native anywhere); the dispatcher picks a copy at run time by what the processor
# has. On another processor these files compile without flags and must guard their bodies with
# #ifdef __AVX2__ or __AVX512F__.
#   *_avx2.c    AVX2 and fused multiply-add: Intel Haswell, AMD Excavator and later
#   *_avx512.c  AVX-512 F, DQ, VL: Intel Skylake-X, AMD Zen 4 and later; GCC prefers 256-bit vectors
#               unless told otherwise, which would halve the lanes of a batch
function(lacquer_kernel_flags)
  if(NOT CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64)$")
    return()
  endif()
  # sqrt without errno and selects without traps let loops vectorise; neither assumes finite numbers.
  set(shared "-fno-math-errno;-fno-trapping-math;-ffp-contract=fast")
  foreach(source IN LISTS ARGN)
    if(source MATCHES "_avx2\\.c$")
      set_source_files_properties(${source} PROPERTIES COMPILE_OPTIONS "${shared};-mavx2;-mfma")
    elseif(source MATCHES "_avx512\\.c$")
      set_source_files_properties(
        ${source} PROPERTIES COMPILE_OPTIONS
        "${shared};-mavx512f;-mavx512dq;-mavx512vl;-mfma;-mprefer-vector-width=512")
    elseif(source MATCHES "kernels_base\\.c$")
      set_source_files_properties(${source} PROPERTIES COMPILE_OPTIONS "${shared}")
    endif()
  endforeach()
endfunction()
