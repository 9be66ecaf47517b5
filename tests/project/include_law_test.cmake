# Plants one breach of the include law at a time in a copy of the sources. The law must find each breach and name it.
#   cmake -DROOT=<source folder> -DWORK=<scratch folder> -P tests/project/include_law_test.cmake
cmake_minimum_required(VERSION 3.25)
set(failures)

file(REMOVE_RECURSE "${WORK}")
foreach(module scenes technique gl raytrace compare app tests)  # only what the law reads
  file(COPY "${ROOT}/${module}" DESTINATION "${WORK}" FILES_MATCHING
       PATTERN "*.h" PATTERN "*.hpp" PATTERN "*.cpp" PATTERN "*.cc" PATTERN "CMakeLists.txt")
endforeach()

# check(LABEL EXPECTED [FILE LINE]...): adds LINE to the end of FILE in a copy of the sources. This must break the law, and
# the message must contain EXPECTED. If EXPECTED is "", the law must hold.
function(check label expected)
  set(plants ${ARGN})
  while(plants)
    list(POP_FRONT plants file line)
    file(APPEND "${WORK}/${file}" "\n${line}\n")
    list(APPEND planted ${file})
  endwhile()
  execute_process(COMMAND "${CMAKE_COMMAND}" "-DROOT=${WORK}" -P "${ROOT}/cmake/include_law.cmake"
                  RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  foreach(file ${planted})  # restore the file
    if(EXISTS "${ROOT}/${file}")
      file(COPY_FILE "${ROOT}/${file}" "${WORK}/${file}")
    else()
      file(REMOVE "${WORK}/${file}")
    endif()
  endforeach()
  string(REGEX REPLACE "[ \n]+" " " output "${output}")  # CMake wraps long messages
  string(FIND "${output}" "${expected}" at)
  if(expected STREQUAL "" AND NOT status EQUAL 0)
    list(APPEND failures "${label}: should hold, but: ${output}")
  elseif(NOT expected STREQUAL "" AND status EQUAL 0)
    list(APPEND failures "${label}: was not found")
  elseif(at EQUAL -1)
    list(APPEND failures "${label}: expected '${expected}', but: ${output}")
  endif()
  set(failures "${failures}" PARENT_SCOPE)
endfunction()

check("the sources as they are" "")
check("scenes knows gl" "scenes/ may not include gl/" scenes/planted.cpp "#include \"gl/renderer.h\"")
check("gl knows raytrace" "gl/ may not include raytrace/" gl/planted.cpp "  #  include <raytrace/tracer.h>")
check("raytrace knows gl" "raytrace/ may not include gl/" raytrace/planted.cpp "#include \"gl/renderer.h\"")
check("compare knows raytrace" "compare/ may not include raytrace/" compare/store/planted.h "#include \"raytrace/tracer.h\"")
check("compare knows app" "compare/ may not include app/" compare/judge/planted.cpp "#include \"app/experiment.h\"")
check("the store knows the report" "compare/store/ may not include compare/report/" compare/store/planted.cpp "#include \"compare/report/text.h\"")
check("the ladder knows who judges" "compare/ladder/ may not include compare/judge/" compare/ladder/planted.cpp "#include \"compare/judge/laws.h\"")
check("a file of compare in no folder of it" "stands in none of compare's folders" compare/planted.cpp "#include \"compare/judge/laws.h\"")
check("app knows tests" "app/ may not include tests/" app/planted.cpp "#include \"tests/closed_forms.h\"")
check("a path with dots" "without dots" gl/planted.cpp "#include \"../raytrace/tracer.h\"")
check("a folder below a module" "gl/ may not include compare/" gl/deeper/planted.cpp "#include \"compare/store/metrics.h\"")
check("OpenGL in app" "OpenGL headers stay inside gl/" app/planted.cpp "#include <epoxy/gl.h>")
check("EGL in raytrace" "OpenGL headers stay inside gl/" raytrace/planted.cpp "#include <EGL/egl.h>")
check("Embree in compare" "Embree headers stay inside raytrace/" compare/ladder/planted.cpp "#include <embree3/rtcore.h>")
check("tinygltf in app" "tinygltf headers stay inside scenes/" app/planted.cpp "#include <tiny_gltf.h>")
check("OpenGL in gl's public header" "gl/renderer.h is public, yet brings in OpenGL" gl/renderer.h "#include <epoxy/gl.h>")
check("Embree in raytrace's public header" "raytrace/tracer.h is public, yet brings in Embree"
      raytrace/tracer.h "#include <embree3/rtcore.h>")
check("tinygltf in a header that others include" "technique/settings.h is public, yet brings in tinygltf"
      technique/settings.h "#include <tiny_gltf.h>")
check("Embree through a second header" "raytrace/tracer.h is public, yet brings in Embree (<embree3/rtcore.h> in raytrace/planted.h)"
      raytrace/tracer.h "#include \"raytrace/planted.h\"" raytrace/planted.h "#include <embree3/rtcore.h>")
check("an inner header of gl that app includes" "gl/planted.h is public, yet brings in OpenGL"
      gl/planted.h "#include <epoxy/gl.h>" app/planted.cpp "#include \"gl/planted.h\"")
check("linking gl to raytrace" "gl/ may not use raytrace/"
      gl/CMakeLists.txt "target_link_libraries(noonmark_gl PRIVATE noonmark_raytrace)")
check("OpenGL in gl's own sources" "" gl/planted.cpp "#include <epoxy/gl.h>")
check("an include in a comment" "" gl/planted.cpp "// #include \"raytrace/tracer.h\"")
check("tests use everything" "" tests/planted.cpp "#include \"gl/renderer.h\"" tests/planted.cpp "#include \"raytrace/tracer.h\""
      tests/planted.cpp "#include \"app/experiment.h\"")

file(REMOVE_RECURSE "${WORK}")
if(failures)
  list(JOIN failures "\n  " text)
  message(FATAL_ERROR "The include law misses what it must find:\n  ${text}\n")
endif()
