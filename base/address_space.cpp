#include "base/address_space.h"

#include <fmt/format.h>
#include <sys/mman.h>

#include "base/error.h"

namespace noonmark {

void require_address_space(uint64_t bytes, std::string_view for_what) {
  void* const reserved = mmap(nullptr, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (reserved == MAP_FAILED)
    throw Error(
        ErrorKind::device,
        fmt::format("memory: {} may take up to {} MB, which this process cannot have; raise the limit (ulimit -v), "
                    "give fewer --threads, or choose a smaller scene, picture or map",
                    for_what, (bytes + 999999) / 1000000));
  munmap(reserved, bytes);
}

}  // namespace noonmark
