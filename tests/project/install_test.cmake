# Tests an installed Noonmark as another project and a user use it. STEP is one of:
#   prefix    installs the build into WORK/prefix and checks the files; the other steps need it
#   runpath   no binary, built or installed, searches libraries in a folder that depends on where it is started
#   program   the installed program does what the built one does, and writes pictures
#   consumer  tests/project/consumer configures, builds and runs against it
#   headers   every installed header compiles, every component links, and what app/ includes is among them
#   cmake -DSTEP=... -DSOURCE=... -DBUILD=... -DWORK=... -DPROGRAM=... -DREADELF=... -DBUILD_TYPE=... -DGENERATOR=... -DCXX=... -DCXX_FLAGS=... -P
cmake_minimum_required(VERSION 3.25)
set(prefix ${WORK}/prefix)

# run(WHAT command...): runs the command and fails the test if it fails. `output` is what it printed.
macro(run what)
  execute_process(COMMAND ${ARGN} WORKING_DIRECTORY ${WORK} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE errors)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${what} ended with ${result}:\n${output}${errors}")
  endif()
endmacro()

# build(NAME SOURCE): configures and builds SOURCE against the prefix, in WORK/NAME.
macro(build name source)
  file(REMOVE_RECURSE ${WORK}/${name})
  run("configuring ${name}" ${CMAKE_COMMAND} -S ${source} -B ${WORK}/${name} -G ${GENERATOR} -DCMAKE_PREFIX_PATH=${prefix}
      -DCMAKE_BUILD_TYPE=${BUILD_TYPE} -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_CXX_FLAGS=${CXX_FLAGS})
  run("building ${name}" ${CMAKE_COMMAND} --build ${WORK}/${name})
endmacro()

if(STEP STREQUAL "prefix")
  file(REMOVE_RECURSE ${WORK})
  file(MAKE_DIRECTORY ${WORK})
  run("cmake --install" ${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/first)
  # The prefix is moved, so that everything that contains the old path breaks.
  file(RENAME ${WORK}/first ${prefix})
  foreach(file bin/noonmark share/man/man1/noonmark.1 share/bash-completion/completions/noonmark
               include/noonmark/compare/ladder/ladder.h include/noonmark/technique/surface.glsl)
    if(NOT EXISTS ${prefix}/${file})
      message(SEND_ERROR "${file} is not installed")
    endif()
  endforeach()
  # Debug information may contain the paths of the sources.
  set(places ${prefix})
  if(NOT BUILD_TYPE STREQUAL Release)
    set(places ${prefix}/include ${prefix}/share)
    file(GLOB_RECURSE cmake_files ${prefix}/*.cmake)
    list(APPEND places ${cmake_files})
  endif()
  foreach(folder ${SOURCE} ${BUILD} ${WORK}/first)
    string(REGEX REPLACE "([][+.*^$(){}|?\\])" "\\\\\\1" pattern ${folder})
    execute_process(COMMAND grep -arlE "(^|[^A-Za-z0-9._}/-])${pattern}(/|$)" ${places} OUTPUT_VARIABLE found)
    if(found)
      message(SEND_ERROR "these name ${folder}, which need not be there when they are used:\n${found}")
    endif()
  endforeach()

elseif(STEP STREQUAL "runpath")
  if(NOT READELF)
    message("SKIPPED: there is no readelf")
    return()
  endif()
  # The loader takes an empty element for the current folder, and a relative one from there on.
  set(element "(/[^:]*|[$]ORIGIN(/[^:]*)?)")
  file(GLOB_RECURSE files ${BUILD}/* ${prefix}/*)
  list(FILTER files EXCLUDE REGEX "/CMakeFiles/|[.](o|a|gch)$")
  set(with_path)
  foreach(file ${files})
    file(READ ${file} magic LIMIT 4 HEX)
    if(NOT magic STREQUAL "7f454c46")  # ELF
      continue()
    endif()
    run("readelf of ${file}" ${READELF} -d ${file})
    string(REGEX MATCHALL "\\((RPATH|RUNPATH)\\)[^\n]*" lines "${output}")
    foreach(line ${lines})
      string(REGEX REPLACE ".*\\[(.*)\\].*" "\\1" path "${line}")
      list(APPEND with_path ${file})
      if(NOT path MATCHES "^${element}(:${element})*$")
        message(SEND_ERROR "${file} has the library path '${path}'")
      endif()
    endforeach()
  endforeach()
  foreach(file ${PROGRAM} ${prefix}/bin/noonmark)
    if(NOT file IN_LIST with_path)
      message(SEND_ERROR "${file} names no folder for its picture library")
    endif()
  endforeach()

elseif(STEP STREQUAL "program")
  set(installed ${prefix}/bin/noonmark)
  foreach(arguments --version scenes settings)
    run("the built ${arguments}" ${PROGRAM} ${arguments})
    set(expected "${output}")
    run("the installed ${arguments}" ${installed} ${arguments})
    if(NOT output STREQUAL expected)
      message(FATAL_ERROR "the installed program's ${arguments} differs from the built one's:\n${output}")
    endif()
  endforeach()
  execute_process(COMMAND ${PROGRAM} doctor RESULT_VARIABLE result OUTPUT_VARIABLE output)
  if(NOT result EQUAL 0)
    message("SKIPPED: this machine cannot measure:\n${output}")
    return()
  endif()
  run("the installed doctor" ${installed} doctor)
  file(REMOVE_RECURSE ${WORK}/pictures)
  run("the installed render" ${installed} render --out ${WORK}/pictures --set scene.name=plate --set view.width_px=64 --set view.height_px=36)
  file(GLOB pngs ${WORK}/pictures/*.png ${WORK}/pictures/*/*.png)
  file(GLOB exrs ${WORK}/pictures/*.exr ${WORK}/pictures/*/*.exr)
  if(NOT pngs OR NOT exrs)
    message(FATAL_ERROR "the installed program wrote no PNG or no EXR:\n${output}")
  endif()
  # The installed program must open its own picture library, not that of the build.
  file(GLOB_RECURSE library ${prefix}/noonmark_images.so)
  file(RENAME ${library} ${WORK}/taken_away.so)
  execute_process(COMMAND ${installed} doctor RESULT_VARIABLE result OUTPUT_VARIABLE output)
  file(RENAME ${WORK}/taken_away.so ${library})
  if(NOT result EQUAL 4 OR NOT output MATCHES "noonmark_images.so: .*it belongs")
    message(FATAL_ERROR "without its picture library the installed doctor ended with ${result}:\n${output}")
  endif()

elseif(STEP STREQUAL "consumer")
  # The project is built outside the sources, so that no header of them is found by chance.
  file(REMOVE_RECURSE ${WORK}/consumer_source)
  file(COPY ${SOURCE}/tests/project/consumer/ DESTINATION ${WORK}/consumer_source)
  build(consumer ${WORK}/consumer_source)
  run("the consumer" ${WORK}/consumer/consumer)
  set(expected "pixel 0: none
pixel 1: acne
pixel 2: peter_panning
pixel 3: aliasing_dark
free of acne from a bias of 0.125 on
acne <= 1%: broken
")
  if(NOT output STREQUAL expected)
    message(FATAL_ERROR "the consumer said\n${output}instead of\n${expected}")
  endif()

elseif(STEP STREQUAL "headers")
  file(GLOB_RECURSE headers RELATIVE ${prefix}/include/noonmark ${prefix}/include/noonmark/*.h)
  # base/digest.h needs fmt, which is linked privately.
  set(not_installed base/digest.h)
  file(GLOB sources ${SOURCE}/app/*.h ${SOURCE}/app/*.cpp)
  foreach(source ${sources})
    file(STRINGS ${source} lines REGEX "^#include \"(scenes|technique|gl|raytrace|frames|compare)/")
    foreach(line ${lines})
      string(REGEX REPLACE ".*\"(.*)\".*" "\\1" header ${line})
      if(NOT header IN_LIST headers AND NOT header IN_LIST not_installed)
        list(APPEND missing ${header})
      endif()
    endforeach()
  endforeach()
  if(missing)
    list(REMOVE_DUPLICATES missing)
    message(FATAL_ERROR "app/ includes what is not installed: ${missing}; add it to noonmark_library() in its folder's CMakeLists.txt")
  endif()
  list(TRANSFORM headers REPLACE "(.+)" "#include \"\\1\"\n" OUTPUT_VARIABLE includes)
  list(JOIN includes "" includes)
  file(WRITE ${WORK}/headers_source/main.cpp "${includes}
int main() {
  using namespace noonmark;
  const bool all = !builtin_scenes().empty() && !settings_table().empty() && !metrics_table().empty() &&
                   !gl::shader_file(\"shaders/compare.glsl\").empty() && !raytrace::tracer_info().version.empty() &&
                   !frame_checks().empty();
  return all ? 0 : 1;
}
")
  file(WRITE ${WORK}/headers_source/CMakeLists.txt [[
cmake_minimum_required(VERSION 3.25)
project(headers LANGUAGES CXX)
find_package(noonmark QUIET COMPONENTS compare no_such_component)
if(noonmark_FOUND)
  message(FATAL_ERROR "a component that does not exist is found")
endif()
find_package(noonmark REQUIRED)
get_target_property(options noonmark::options INTERFACE_COMPILE_OPTIONS)
if(NOT "-ffp-contract=off" IN_LIST options OR options MATCHES "-W|-fno-tree")
  message(FATAL_ERROR "the compile options that travel are ${options}")
endif()
add_executable(headers main.cpp)
target_link_libraries(headers PRIVATE noonmark::scenes noonmark::technique noonmark::gl noonmark::raytrace noonmark::judge noonmark::compare)
]])
  build(headers ${WORK}/headers_source)
  run("the program of all headers" ${WORK}/headers/headers)

else()
  message(FATAL_ERROR "there is no STEP '${STEP}'")
endif()
