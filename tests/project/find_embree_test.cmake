# Which Embree the build takes, of packages that say no more than their version.
#   cmake -DROOT=<source folder> -DWORK=<scratch folder> -P tests/project/find_embree_test.cmake
cmake_minimum_required(VERSION 3.25)

if(FIND)  # one search, in a process of its own
  set(CMAKE_FIND_USE_CMAKE_SYSTEM_PATH OFF)  # not the one that is installed here
  set(CMAKE_FIND_USE_SYSTEM_ENVIRONMENT_PATH OFF)
  set(CMAKE_FIND_USE_PACKAGE_REGISTRY OFF)
  set(CMAKE_PREFIX_PATH ${FIND})
  include(${ROOT}/cmake/embree.cmake)
  message(STATUS "took ${embree_VERSION}")
  return()
endif()

# The version file is what Embree 2.17 to 4.3 install: the same major version, and no older one.
file(REMOVE_RECURSE ${WORK})
foreach(version 2.17.7 3.12.2 3.13.0 3.13.5 4.0.0 4.3.3 5.0.0)
  string(REGEX MATCH "^[0-9]+" major ${version})
  set(folder ${WORK}/${version}/lib/cmake/embree-${version})
  file(WRITE ${folder}/embree-config.cmake "")
  file(WRITE ${folder}/embree-config-version.cmake "set(PACKAGE_VERSION ${version})
    if(PACKAGE_FIND_VERSION_MAJOR EQUAL ${major} AND PACKAGE_FIND_VERSION VERSION_LESS_EQUAL PACKAGE_VERSION)
      set(PACKAGE_VERSION_COMPATIBLE 1)
    endif()")
endforeach()

# expect(ANSWER VERSION...): with the packages of these versions, in this order, the search ends so.
function(expect answer)
  list(TRANSFORM ARGN PREPEND ${WORK}/)
  execute_process(COMMAND ${CMAKE_COMMAND} -DROOT=${ROOT} "-DFIND=${ARGN}" -P ${CMAKE_CURRENT_FUNCTION_LIST_FILE}
                  RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  string(REGEX REPLACE "[ \n]+" " " output "${output}")
  string(FIND "${output}" "${answer}" at)
  if(at EQUAL -1 OR (answer MATCHES "^took" AND NOT status EQUAL 0) OR (status EQUAL 0 AND NOT answer MATCHES "^took"))
    message(SEND_ERROR "of ${ARGN} expected '${answer}', but: ${output}")
  endif()
endfunction()
expect("took 3.13.0" 3.13.0)
expect("took 3.13.5" 3.13.5)
expect("took 4.0.0" 4.0.0)
expect("took 4.3.3" 4.3.3)
expect("took 4.3.3" 3.13.5 4.3.3)  # as the header chooses
expect("CMake finds 2.17.7." 2.17.7)
expect("CMake finds 3.12.2." 3.12.2)
expect("CMake finds 5.0.0." 5.0.0)
expect("CMake finds nothing." none)
file(REMOVE_RECURSE ${WORK})
