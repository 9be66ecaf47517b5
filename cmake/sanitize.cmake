# NOONMARK_SANITIZED_TESTS compiles scenes a second time, with AddressSanitizer and UndefinedBehaviorSanitizer (casts from
# floats included), and links the tests that use nothing else with it. This library reads what comes from outside: models
# and images. The others are left out, because their second compilation took a quarter of the time that CI has; run the
# preset asan, which compiles everything with the sanitizers, for all tests, after a change there. The tests' own files are
# compiled without sanitizers, because that halves the time to build. CI sets this option (preset ci). The checks of each
# single pointer (null, alignment, object-size, vptr, pointer-overflow) are left to that preset: they take half of
# the time to compile, and a null or wild pointer stops AddressSanitizer too.
set(NOONMARK_SANITIZE -fsanitize=address,undefined,float-cast-overflow -fno-sanitize=null,alignment,object-size,vptr,pointer-overflow)
set(NOONMARK_SANITIZED_LIBRARIES noonmark_base noonmark_scenes)

# noonmark_sanitized(OUT item...): the items with the names of the sanitized libraries; other names stay as they are. Another
# library of the program is an error: it would bring the code without sanitizers.
function(noonmark_sanitized out)
  foreach(item ${ARGN})
    if(item MATCHES "^noonmark_" AND NOT item IN_LIST NOONMARK_SANITIZED_LIBRARIES AND NOT item STREQUAL noonmark_options)
      message(FATAL_ERROR "${item} has no sanitized twin (cmake/sanitize.cmake), so nothing that links it is sanitized")
    endif()
  endforeach()
  list(JOIN NOONMARK_SANITIZED_LIBRARIES "|" names)
  list(TRANSFORM ARGN REPLACE "(${names})" "\\1_sanitized")
  set(${out} ${ARGN} PARENT_SCOPE)
endfunction()

# noonmark_sanitized_twin(LIBRARY): LIBRARY_sanitized, of the same sources and with the same options. To be called in
# the folder of LIBRARY, because generated files are known there alone.
function(noonmark_sanitized_twin library)
  if(NOT NOONMARK_SANITIZED_TESTS)
    return()
  endif()
  set(twin ${library}_sanitized)
  get_target_property(sources ${library} SOURCES)
  add_library(${twin} STATIC EXCLUDE_FROM_ALL ${sources})
  foreach(property COMPILE_OPTIONS COMPILE_DEFINITIONS INCLUDE_DIRECTORIES INTERFACE_INCLUDE_DIRECTORIES PRECOMPILE_HEADERS LINK_LIBRARIES
                   INTERFACE_LINK_LIBRARIES)
    get_target_property(value ${library} ${property})
    if(value)
      noonmark_sanitized(value ${value})
      set_target_properties(${twin} PROPERTIES ${property} "${value}")
    endif()
  endforeach()
  # With the sanitizers GCC 12 takes values for uninitialized that are not. The first compilation has found the rest.
  target_compile_options(${twin} PRIVATE ${NOONMARK_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all -O1 -g1
                         -Wno-maybe-uninitialized)
  target_link_options(${twin} PUBLIC ${NOONMARK_SANITIZE})
endfunction()
