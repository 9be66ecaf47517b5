# Plants breaches of the include law in a copy of the sources, all at once, each in a file of its own. The law must name
# each of them, and nothing of what it allows. That the sources hold as they are is include_law.holds.
#   cmake -DROOT=<source folder> -DWORK=<scratch folder> -P tests/project/include_law_test.cmake
cmake_minimum_required(VERSION 3.25)
set(failures)

file(REMOVE_RECURSE "${WORK}")
foreach(module base scenes technique gl raytrace compare measure app tests)  # only what the law reads
  file(COPY "${ROOT}/${module}" DESTINATION "${WORK}" FILES_MATCHING
       PATTERN "*.h" PATTERN "*.hpp" PATTERN "*.cpp" PATTERN "*.cc" PATTERN "CMakeLists.txt")
endforeach()

# The law's answer on the copy: its exit status, and its text on one line, because CMake wraps long messages.
macro(ask_the_law)
  execute_process(COMMAND "${CMAKE_COMMAND}" "-DROOT=${WORK}" -P "${ROOT}/cmake/include_law.cmake"
                  RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  string(REGEX REPLACE "[ \n]+" " " output "${output}")
endmacro()

# plant(FILE LINE [FILE LINE]...): adds LINE to the end of FILE.
function(plant)
  set(plants ${ARGN})
  while(plants)
    list(POP_FRONT plants file line)
    file(APPEND "${WORK}/${file}" "\n${line}\n")
  endwhile()
endfunction()

# breach(LABEL EXPECTED FILE LINE...): plants what the law must name with the text EXPECTED, which names the file.
set(labels)
set(texts)
function(breach label expected)
  plant(${ARGN})
  set(labels ${labels} "${label}" PARENT_SCOPE)
  set(texts ${texts} "${expected}" PARENT_SCOPE)
endfunction()

# allowed(FILE LINE...): plants what the law allows, so that it must not name FILE.
set(innocent)
function(allowed file)
  plant(${file} ${ARGN})
  set(innocent ${innocent} ${file} PARENT_SCOPE)
endfunction()

breach("scenes knows gl" "scenes/planted_1.cpp includes \"gl/renderer.h\": scenes/ may not include gl/"
       scenes/planted_1.cpp "#include \"gl/renderer.h\"")
breach("gl knows raytrace" "gl/planted_2.cpp includes \"raytrace/tracer.h\": gl/ may not include raytrace/"
       gl/planted_2.cpp "  #  include <raytrace/tracer.h>")
breach("raytrace knows gl" "raytrace/planted_3.cpp includes \"gl/renderer.h\": raytrace/ may not include gl/"
       raytrace/planted_3.cpp "#include \"gl/renderer.h\"")
breach("compare knows raytrace" "compare/store/planted_4.h includes \"raytrace/tracer.h\": compare/store/ may not include raytrace/"
       compare/store/planted_4.h "#include \"raytrace/tracer.h\"")
breach("compare knows app" "compare/judge/planted_5.cpp includes \"app/definition/experiment.h\": compare/judge/ may not include app/definition/"
       compare/judge/planted_5.cpp "#include \"app/definition/experiment.h\"")
breach("the store knows the report" "compare/store/planted_6.cpp includes \"compare/report/text.h\": compare/store/ may not include compare/report/"
       compare/store/planted_6.cpp "#include \"compare/report/text.h\"")
breach("the ladder knows who judges" "compare/ladder/planted_7.cpp includes \"compare/judge/laws.h\": compare/ladder/ may not include compare/judge/"
       compare/ladder/planted_7.cpp "#include \"compare/judge/laws.h\"")
breach("a file of compare in no folder of it" "compare/planted_8.cpp stands in none of compare's rooms"
       compare/planted_8.cpp "#include \"compare/judge/laws.h\"")
breach("app knows tests" "app/verbs/planted_9.cpp includes \"tests/closed_forms.h\": app/verbs/ may not include tests/"
       app/verbs/planted_9.cpp "#include \"tests/closed_forms.h\"")
breach("a path with dots" "gl/planted_10.cpp includes \"../raytrace/tracer.h\": write the path from the source folder, without dots"
       gl/planted_10.cpp "#include \"../raytrace/tracer.h\"")
breach("a folder below a module" "gl/deeper/planted_11.cpp includes \"compare/results/metrics.h\": gl/ may not include compare/results/"
       gl/deeper/planted_11.cpp "#include \"compare/results/metrics.h\"")
breach("OpenGL in app" "app/verbs/planted_12.cpp includes <epoxy/gl.h>: OpenGL headers stay inside gl/"
       app/verbs/planted_12.cpp "#include <epoxy/gl.h>")
breach("EGL in raytrace" "raytrace/planted_13.cpp includes <EGL/egl.h>: OpenGL headers stay inside gl/"
       raytrace/planted_13.cpp "#include <EGL/egl.h>")
breach("Embree in compare" "compare/ladder/planted_14.cpp includes <embree3/rtcore.h>: Embree headers stay inside raytrace/"
       compare/ladder/planted_14.cpp "#include <embree3/rtcore.h>")
breach("tinygltf in app" "app/verbs/planted_15.cpp includes <tiny_gltf.h>: tinygltf headers stay inside scenes/"
       app/verbs/planted_15.cpp "#include <tiny_gltf.h>")
breach("OpenGL in gl's public header" "gl/renderer.h is public, yet brings in OpenGL"
       gl/renderer.h "#include <epoxy/gl.h>")
breach("Embree in raytrace's public header" "raytrace/tracer.h is public, yet brings in Embree"
       raytrace/tracer.h "#include <embree3/rtcore.h>")
breach("tinygltf in a header that others include" "technique/settings.h is public, yet brings in tinygltf"
       technique/settings.h "#include <tiny_gltf.h>")
breach("Embree through a second header" "raytrace/tracer.h is public, yet brings in Embree (<embree3/rtcore.h> in raytrace/planted_19.h)"
       raytrace/tracer.h "#include \"raytrace/planted_19.h\"" raytrace/planted_19.h "#include <embree3/rtcore.h>")
breach("an inner header of gl that app includes" "gl/planted_20.h is public, yet brings in OpenGL"
       gl/planted_20.h "#include <epoxy/gl.h>" app/verbs/planted_20.cpp "#include \"gl/planted_20.h\"")
breach("linking gl to raytrace" "gl/ may not use raytrace/"
       gl/CMakeLists.txt "target_link_libraries(noonmark_gl PRIVATE noonmark_raytrace)")
breach("base knows scenes" "base/planted_25.h includes \"scenes/scene.h\": base/ may not include scenes/"
       base/planted_25.h "#include \"scenes/scene.h\"")
breach("arithmetic knows the store" "compare/ladder/planted_26.cpp includes \"compare/store/store.h\": compare/ladder/ may not include compare/store/"
       compare/ladder/planted_26.cpp "#include \"compare/store/store.h\"")
breach("measure knows the experiment" "measure/planted_27.cpp includes \"app/definition/experiment.h\": measure/ may not include app/definition/"
       measure/planted_27.cpp "#include \"app/definition/experiment.h\"")
breach("measure knows the report" "measure/planted_28.h includes \"compare/report/report.h\": measure/ may not include compare/report/"
       measure/planted_28.h "#include \"compare/report/report.h\"")
breach("pictures know the sweep" "app/pictures/planted_29.cpp includes \"app/sweep/sweep.h\": app/pictures/ may not include app/sweep/"
       app/pictures/planted_29.cpp "#include \"app/sweep/sweep.h\"")
breach("the sweep knows the verbs" "app/sweep/planted_30.cpp includes \"app/verbs/verbs.h\": app/sweep/ may not include app/verbs/"
       app/sweep/planted_30.cpp "#include \"app/verbs/verbs.h\"")
breach("a file of app in no room of it" "app/planted_31.cpp stands in none of app's rooms"
       app/planted_31.cpp "#include \"base/error.h\"")
breach("linking measure to the app" "measure/ may not use app/"
       measure/CMakeLists.txt "target_link_libraries(noonmark_measure PRIVATE noonmark_app)")
allowed(measure/planted_32.cpp "#include \"compare/ladder/ladder.h\"" measure/planted_32.cpp "#include \"gl/renderer.h\"")
allowed(gl/planted_22.cpp "#include <epoxy/gl.h>")  # OpenGL in gl's own sources
allowed(gl/planted_23.cpp "// #include \"raytrace/tracer.h\"")  # an include in a comment
allowed(tests/planted_24.cpp "#include \"gl/renderer.h\"" tests/planted_24.cpp "#include \"raytrace/tracer.h\"" tests/planted_24.cpp "#include \"app/definition/experiment.h\"")  # tests use everything

ask_the_law()
if(status EQUAL 0)
  list(APPEND failures "no breach was found")
endif()
foreach(label expected IN ZIP_LISTS labels texts)
  string(FIND "${output}" "${expected}" at)
  if(at EQUAL -1)
    list(APPEND failures "${label}: expected '${expected}', but: ${output}")
  endif()
endforeach()
foreach(file ${innocent})
  string(FIND "${output}" "${file}" at)
  if(NOT at EQUAL -1)
    list(APPEND failures "${file} breaks nothing, but: ${output}")
  endif()
endforeach()

file(REMOVE_RECURSE "${WORK}")
if(failures)
  list(JOIN failures "\n  " text)
  message(FATAL_ERROR "The include law misses what it must find:\n  ${text}\n")
endif()
