# Called by noonmark_build_facts at every build.
find_program(GIT git)
set(commit)
if(GIT)
  # safe.directory: a build as root of somebody else's clone, as containers do it, may still ask for its commit.
  execute_process(COMMAND ${GIT} -c safe.directory=${ROOT} -C ${ROOT} describe --always --dirty --abbrev=12 --exclude=*
                  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  # A copy of the sources inside another repository has that one's commit, which says nothing about these.
  execute_process(COMMAND ${GIT} -c safe.directory=${ROOT} -C ${ROOT} rev-parse --show-toplevel
                  OUTPUT_VARIABLE top OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  file(REAL_PATH "${ROOT}" root)
  if(NOT top STREQUAL root)
    set(commit)
  endif()
endif()
if(NOT commit)
  set(commit unknown)
endif()
set(rows)
string(REPLACE "," ";" LIBRARIES "${LIBRARIES}")
foreach(library ${LIBRARIES})
  string(REGEX REPLACE "^(.*)=(.*)$" "    {\"\\1\", \"\\2\"},\n" row "${library}")
  string(APPEND rows "${row}")
endforeach()
file(CONFIGURE OUTPUT "${SOURCE}" @ONLY CONTENT [[
#include "base/build_facts.h"

namespace noonmark {
namespace {
constexpr LibraryVersion libraries[] = {
@rows@};
constexpr BuildFacts facts = {"@VERSION@", "@commit@", "@COMPILER@", "@BUILD_TYPE@", libraries};
}  // namespace
const BuildFacts& build_facts() { return facts; }
}  // namespace noonmark
]])
