// How this program was built. doctor, the report and the store print it. cmake/build_facts.cmake writes it. It looks up
// the commit at every build, so the commit is never older than the code.
//
//   fmt::print("noonmark {} ({})\n", build_facts().version, build_facts().commit);
#pragma once
#include <span>
#include <string_view>

namespace noonmark {

struct LibraryVersion {
  std::string_view name, version;  // as found at the configuration of the build
};

struct BuildFacts {
  std::string_view version;     // "0.1.0"
  std::string_view commit;      // of the sources, with "-dirty" if tracked files differ from it; "unknown" without git
  std::string_view compiler;    // "GNU 12.2.0"
  std::string_view build_type;  // "Release"
  std::span<const LibraryVersion> libraries;
};

const BuildFacts& build_facts();

}  // namespace noonmark
