# noonmark_build_facts(TARGET): compiles the definition of base/build_facts.h into TARGET.
function(noonmark_build_facts target)
  # Versions as each folder's find_package or pkg_check_modules left them: name, folder, variable.
  set(libraries)
  foreach(row "Embree raytrace embree_VERSION" "libepoxy gl EPOXY_VERSION" "GLM . glm_VERSION" "OpenEXR app OpenEXR_VERSION" "OpenImageIO app OPENIMAGEIO_VERSION"
              "tinygltf scenes TinyGLTF_VERSION" "Draco scenes draco_VERSION" "meshoptimizer scenes meshoptimizer_VERSION" "CLI11 app CLI11_VERSION" "toml++ app tomlplusplus_VERSION"
              "nlohmann-json . nlohmann_json_VERSION" "fmt . fmt_VERSION" "SQLite . SQLite3_VERSION"
              "oneTBB . TBB_VERSION")
    separate_arguments(row)
    list(POP_FRONT row name folder variable)
    get_directory_property(version DIRECTORY ${PROJECT_SOURCE_DIR}/${folder} DEFINITION ${variable})
    if(NOT version)
      message(FATAL_ERROR "build facts: ${variable} is not known in ${folder}/; correct the row of ${name}")
    endif()
    list(APPEND libraries "${name}=${version}")
  endforeach()
  set(source ${CMAKE_CURRENT_BINARY_DIR}/build_facts.cpp)
  list(JOIN libraries "," libraries)
  # A target, not a command with dependencies: nothing in the tree says when HEAD moves. The file is touched only when
  # it changes.
  add_custom_target(build_facts
    COMMAND ${CMAKE_COMMAND} -DROOT=${PROJECT_SOURCE_DIR} -DSOURCE=${source} -DVERSION=${PROJECT_VERSION}
            "-DCOMPILER=${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}" -DBUILD_TYPE=${CMAKE_BUILD_TYPE} -DLIBRARIES=${libraries}
            -P ${PROJECT_SOURCE_DIR}/cmake/build_facts_script.cmake
    BYPRODUCTS ${source} COMMENT "Looking up the commit" VERBATIM)
  target_sources(${target} PRIVATE ${source})
  add_dependencies(${target} build_facts)
endfunction()
