# What `cmake --install` puts where: bin/noonmark, its picture library, man page and completion (app/CMakeLists.txt), and
# the experiments as examples, and the adapters of engines: together the component `program`, of which cpack makes a package (cmake/package.cmake); the
# libraries with their public headers; and the package with which another project finds them (cmake/noonmarkConfig.cmake.in):
#   find_package(noonmark REQUIRED COMPONENTS compare)
#   target_link_libraries(theirs PRIVATE noonmark::compare)
# All of it may be moved afterwards: nothing names the folder it was installed to.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(NOONMARK_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/noonmark)
set(NOONMARK_HEADER_DIR ${CMAKE_INSTALL_INCLUDEDIR}/noonmark)  # "compare/ladder/ladder.h" lies below it
set(NOONMARK_MODULE_DIR ${CMAKE_INSTALL_LIBDIR}/noonmark)      # what the program opens at run time

# noonmark_library(NAME HEADER...): installs the library noonmark_NAME as noonmark::NAME with its public headers, paths
# from its own folder: those that other folders include, what they include in turn, and what an outside project has a
# use for. None of them may need a library that the target links privately. The test install.headers compiles them all.
function(noonmark_library name)
  list(TRANSFORM ARGN PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/ OUTPUT_VARIABLE headers)
  target_sources(noonmark_${name} PUBLIC FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES ${headers})
  set_target_properties(noonmark_${name} PROPERTIES EXPORT_NAME ${name})
  add_library(noonmark::${name} ALIAS noonmark_${name})
  install(TARGETS noonmark_${name} EXPORT noonmarkTargets
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} FILE_SET HEADERS DESTINATION ${NOONMARK_HEADER_DIR})
endfunction()

set_target_properties(noonmark_options PROPERTIES EXPORT_NAME options)
install(TARGETS noonmark_options EXPORT noonmarkTargets)
install(DIRECTORY experiments/ DESTINATION ${CMAKE_INSTALL_DOCDIR}/examples COMPONENT program)
# What `noonmark recommend --engine` runs.
install(DIRECTORY examples/engines/ DESTINATION ${CMAKE_INSTALL_DATADIR}/noonmark/engines COMPONENT program
        PATTERN node_modules EXCLUDE PATTERN package-lock.json EXCLUDE)
# What `noonmark capture` runs.
install(DIRECTORY captures/ DESTINATION ${CMAKE_INSTALL_DATADIR}/noonmark/captures COMPONENT program
        PATTERN __pycache__ EXCLUDE)
install(EXPORT noonmarkTargets NAMESPACE noonmark:: DESTINATION ${NOONMARK_PACKAGE_DIR})
configure_package_config_file(cmake/noonmarkConfig.cmake.in ${PROJECT_BINARY_DIR}/noonmarkConfig.cmake
                              INSTALL_DESTINATION ${NOONMARK_PACKAGE_DIR} NO_SET_AND_CHECK_MACRO)
# Before 1.0 a minor version may break what uses it (semver.org, 4).
write_basic_package_version_file(${PROJECT_BINARY_DIR}/noonmarkConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/noonmarkConfig.cmake ${PROJECT_BINARY_DIR}/noonmarkConfigVersion.cmake
        DESTINATION ${NOONMARK_PACKAGE_DIR})
