# Tests: each tests/test_*.c is one cmocka program, each tests/test_*.sh one bash script. Exit 77 is
# a skip. Names that end in _slow get the label "slow", which the asan preset leaves out; those that end in _long
# the label "long" as well, which only the preset of that name runs: minutes, beside what others test in seconds.
pkg_check_modules(CMOCKA REQUIRED IMPORTED_TARGET cmocka)

# Tests run side by side: threads that spin while they wait would take the cores from each other.
set(test_environment
    "OMP_WAIT_POLICY=passive"
    "LACQUER=$<TARGET_FILE:lacquer-program>" "LACQUER_SOURCE=${PROJECT_SOURCE_DIR}"
    "LACQUER_BUILD=${PROJECT_BINARY_DIR}" "CMAKE_COMMAND=${CMAKE_COMMAND}" "CC=${CMAKE_C_COMPILER}")

function(lacquer_test_properties name)
  set_tests_properties(${name} PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 300
                                          ENVIRONMENT "${test_environment}")
  if(name MATCHES "_slow$")
    set_tests_properties(${name} PROPERTIES LABELS slow)
  elseif(name MATCHES "_long$")
    set_tests_properties(${name} PROPERTIES LABELS "slow;long" TIMEOUT 900)
  endif()
endfunction()

file(GLOB test_programs CONFIGURE_DEPENDS "tests/test_*.c")
foreach(source IN LISTS test_programs)
  get_filename_component(name ${source} NAME_WE)
  if(LACQUER_QUICK_TESTS AND name MATCHES "_(slow|long)$")
    continue() # the preset runs none of these
  endif()
  add_executable(${name} ${source})
  lacquer_warnings(${name})
  target_compile_definitions(${name} PRIVATE ${system_interfaces})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR} ${RANDOM123_INCLUDE_DIR})
  target_link_libraries(${name} PRIVATE lacquer-inside PkgConfig::CMOCKA PkgConfig::JANSSON PkgConfig::CAIRO
                                        OpenEXR::OpenEXRCore ZLIB::ZLIB OpenMP::OpenMP_C m)
  add_test(NAME ${name} COMMAND ${name} WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
  lacquer_test_properties(${name})
endforeach()

# A software GPU for the textures and shaders of a pack; without it those tests are skips.
pkg_check_modules(EGL IMPORTED_TARGET egl glesv2)
if(EGL_FOUND)
  foreach(name test_pack_gl test_pack_gl_shipped test_scene_decode_slow)
    if(NOT TARGET ${name})
      continue()
    endif()
    target_link_libraries(${name} PRIVATE PkgConfig::EGL ${CMAKE_DL_LIBS})
    target_compile_definitions(${name} PRIVATE LACQUER_EGL)
  endforeach()
endif()

file(GLOB test_scripts CONFIGURE_DEPENDS "tests/test_*.sh")
foreach(source IN LISTS test_scripts)
  get_filename_component(name ${source} NAME_WE)
  add_test(NAME ${name} COMMAND bash ${source} WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
  lacquer_test_properties(${name})
endforeach()

include(cmake/fuzz.cmake)

# What one computes the other finds in the cache.
if(TEST test_readme_slow)
  set_tests_properties(test_readme_slow PROPERTIES DEPENDS test_pack_recipes_slow)
endif()
