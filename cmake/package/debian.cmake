# Run by cpack before it makes the package: adds the files that Debian asks of a package to those that were installed.
# They are copyright, changelogs, the man page compressed, and lintian's overrides.
if(NOT CPACK_GENERATOR STREQUAL "DEB")
  return()
endif()
set(usr ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/usr)
set(doc ${usr}/share/doc/noonmark)
set(here ${CPACK_NOONMARK_SOURCE}/cmake/package)
file(GLOB_RECURSE images ${usr}/lib/noonmark_images.so)
if(NOT EXISTS ${usr}/bin/noonmark OR NOT images)
  message(FATAL_ERROR "cpack: the component 'program' installed no bin/noonmark or no noonmark_images.so; look at the "
                      "COMPONENT of the rules in app/CMakeLists.txt")
endif()
# Without these cpack makes a package that depends on nothing, and says so in one line among others.
foreach(tool dpkg-shlibdeps file gzip)
  find_program(found_${tool} ${tool})
  if(NOT found_${tool})
    message(FATAL_ERROR "cpack: ${tool} is not here, so the package's dependencies are not known; on Debian, apt install dpkg-dev file")
  endif()
endforeach()

# What no program reads. The build id stays, by which a sweep knows its program (app/sweep/identity.h).
foreach(file ${usr}/bin/noonmark ${images})
  execute_process(COMMAND ${CPACK_NOONMARK_STRIP} --strip-unneeded --remove-section=.comment ${file} COMMAND_ERROR_IS_FATAL ANY)
endforeach()

# The date of the changelog is the commit's.
if("$ENV{SOURCE_DATE_EPOCH}" STREQUAL "")
  execute_process(COMMAND git -c safe.directory=${CPACK_NOONMARK_SOURCE} -C ${CPACK_NOONMARK_SOURCE} log -1 --format=%ct
                  OUTPUT_VARIABLE committed OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(committed)
    set(ENV{SOURCE_DATE_EPOCH} ${committed})
  endif()
endif()
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)

file(READ /etc/os-release system)
set(distribution unstable)
if(system MATCHES "\nVERSION_CODENAME=\"?([a-z]+)")
  set(distribution ${CMAKE_MATCH_1})
endif()
file(COPY_FILE ${CPACK_NOONMARK_SOURCE}/CHANGELOG.md ${doc}/changelog)
file(WRITE ${doc}/changelog.Debian
     "noonmark (${CPACK_PACKAGE_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}) ${distribution}; urgency=medium\n\n"
     "  * Made by cpack. What is new in Noonmark is in changelog.gz.\n\n"
     " -- ${CPACK_PACKAGE_CONTACT}  ${date}\n")
file(COPY_FILE ${here}/copyright ${doc}/copyright)
configure_file(${here}/lintian-overrides ${usr}/share/lintian/overrides/noonmark COPYONLY)
# -n: no name and no time in the file.
foreach(file ${doc}/changelog ${doc}/changelog.Debian ${usr}/share/man/man1/noonmark.1)
  execute_process(COMMAND ${found_gzip} -9nf ${file} COMMAND_ERROR_IS_FATAL ANY)
endforeach()

# Whatever the builder's umask is: folders and programs 755, all else 644, and a library is no program.
file(GLOB_RECURSE paths LIST_DIRECTORIES ON ${usr}/*)
set(programs ${usr}/bin)
foreach(path ${usr} ${paths})
  cmake_path(IS_PREFIX programs ${path} is_program)
  if(IS_DIRECTORY ${path} OR is_program)
    file(CHMOD ${path} PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
  else()
    file(CHMOD ${path} PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
  endif()
endforeach()
