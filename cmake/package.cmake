# The Debian package of the program, for the distribution that it is built on:
#   cmake --build build/release --target noonmark && cpack --preset release    # build/release/noonmark_0.1.0-1_amd64.deb
#   apt install ./build/release/noonmark_0.1.0-1_amd64.deb
# It has what `cmake --install --component program` installs, and what cmake/package/debian.cmake adds: the files that
# Debian asks of a package. Headers and archives for other projects are not in it.
set(CPACK_GENERATOR DEB)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_PACKAGE_NAME noonmark)
set(CPACK_INSTALL_CMAKE_PROJECTS "${PROJECT_BINARY_DIR};noonmark;program;/")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
# Whatever the builder's umask is.
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/package/debian.cmake)
set(CPACK_NOONMARK_SOURCE ${PROJECT_SOURCE_DIR})  # the names that begin so are read by that script
set(CPACK_NOONMARK_STRIP ${CMAKE_STRIP})

set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "measures shadow maps against ray-traced truth")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
    "Noonmark renders the shadows of a scene twice, with OpenGL shadow maps and with
Embree shadow rays. For every wrong pixel it reports why the pixel is wrong
(acne, Peter Panning, aliasing, filter, precision, coverage), how large the
error is, and which setting would be enough.

An experiment is one TOML file: a built-in scene or a glTF model, settings to
sweep, and bounds that must hold. The result is one HTML page, tables, and an
exit code for continuous integration. No display and no GPU are needed.")
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

# dpkg-shlibdeps finds the libraries that program and picture library are linked with. What is opened at run time by its
# name it cannot see: the section "run time" of scripts/packages.txt.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
file(STRINGS scripts/packages.txt lines)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/scripts/packages.txt)
set(section)
set(opened)
foreach(line IN LISTS lines)
  if(line MATCHES "^# (.+)")
    set(section "${CMAKE_MATCH_1}")
  elseif(section MATCHES "^run time" AND line MATCHES "^([a-z0-9][a-z0-9.+-]+)")
    list(APPEND opened ${CMAKE_MATCH_1})
  endif()
endforeach()
if(NOT opened)
  message(FATAL_ERROR "scripts/packages.txt has no packages in a section 'run time'; the package needs their names")
endif()
list(JOIN opened ", " CPACK_DEBIAN_PACKAGE_DEPENDS)
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "python3-renderdoc, python3-numpy, renderdoc")  # to read captures

# Whom to ask about the package: as in Debian's own tools, who builds it; otherwise the author of the commit.
set(CPACK_PACKAGE_CONTACT "$ENV{DEBFULLNAME} <$ENV{DEBEMAIL}>")
find_program(GIT git)
if("$ENV{DEBFULLNAME}" STREQUAL "" OR "$ENV{DEBEMAIL}" STREQUAL "")
  set(CPACK_PACKAGE_CONTACT)
  if(GIT)
    execute_process(COMMAND ${GIT} -c safe.directory=${PROJECT_SOURCE_DIR} -C ${PROJECT_SOURCE_DIR} log -1 "--format=%an <%ae>"
                    OUTPUT_VARIABLE CPACK_PACKAGE_CONTACT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  endif()
  if(NOT CPACK_PACKAGE_CONTACT)
    cmake_host_system_information(RESULT host QUERY FQDN)
    set(CPACK_PACKAGE_CONTACT "Whoever built it <root@${host}>")
  endif()
endif()
include(CPack)
