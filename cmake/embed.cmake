# noonmark_embed(TARGET NAMESPACE OUT.cpp FILE...): compiles text files into TARGET as
#   namespace NAMESPACE { std::string_view embedded(std::string_view name); }   // empty when there is no such file
# where name is the file's path below the folder that calls (for an absolute path: its last part). The header is written
# beside OUT.cpp as OUT.h.
function(noonmark_embed target namespace out)
  set(header ${CMAKE_CURRENT_BINARY_DIR}/${out}.h)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/${out}.cpp)
  set(absolute)
  foreach(file ${ARGN})
    cmake_path(ABSOLUTE_PATH file BASE_DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR} OUTPUT_VARIABLE path)
    list(APPEND absolute ${path})
  endforeach()
  add_custom_command(
    OUTPUT ${source} ${header}
    COMMAND ${CMAKE_COMMAND} -DNAMESPACE=${namespace} -DSOURCE=${source} -DHEADER=${header}
            -DROOT=${CMAKE_CURRENT_SOURCE_DIR} "-DFILES=${ARGN}" -P ${PROJECT_SOURCE_DIR}/cmake/embed_script.cmake
    DEPENDS ${absolute} ${PROJECT_SOURCE_DIR}/cmake/embed_script.cmake
    VERBATIM)
  target_sources(${target} PRIVATE ${source})
  target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_BINARY_DIR})
endfunction()
