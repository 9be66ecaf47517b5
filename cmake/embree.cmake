# Embree 4 where there is one, otherwise 3.13 or a later 3: raytrace/embree_compat.h chooses the same. Read before
# cmake/install.cmake, because the installed package asks for the version that the archives were compiled for.
foreach(version 4 3.13)
  if(NOT embree_FOUND)
    find_package(embree ${version} QUIET)
  endif()
endforeach()
if(NOT embree_FOUND)
  set(found nothing)
  if(embree_CONSIDERED_VERSIONS)
    list(JOIN embree_CONSIDERED_VERSIONS ", " found)
  endif()
  message(FATAL_ERROR "Embree 3.13 or a later 3, or Embree 4, is needed, and CMake finds ${found}. "
                      "On Debian and Ubuntu install libembree-dev; otherwise give the folder of its embree-config.cmake with -Dembree_DIR.")
endif()
