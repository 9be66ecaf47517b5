// Large aligned memory in huge pages. Mesa's llvmpipe takes its textures, and Embree its trees, from posix_memalign, and
// write them at once: page by page the kernel needs more time for them than the program to use them. On Linux huge pages are
// often given only to those who ask (/sys/kernel/mm/transparent_hugepage/enabled = madvise), and libraries do not ask.
//
// This file is part of the executable alone: its posix_memalign stands before that of the C library, from which it takes
// all memory. Where the kernel has no huge pages it changes nothing but the alignment.
#include <sys/mman.h>

#include <cerrno>
#include <cstdint>
#include <cstdlib>

namespace {

constexpr size_t huge_page = size_t{2} << 20;  // of x86-64, and of ARM with pages of 4 KiB
constexpr size_t least_bytes = 2 * huge_page;  // smaller memory would be mostly its own rounding

}  // namespace

extern "C" __attribute__((visibility("default"))) int posix_memalign(void** memory, size_t alignment, size_t bytes) {
  if (alignment % sizeof(void*) != 0 || alignment == 0 || (alignment & (alignment - 1)) != 0) return EINVAL;
  const bool large = bytes >= least_bytes;
  const int before = errno;  // posix_memalign does not set it
  void* const made = std::aligned_alloc(large && alignment < huge_page ? huge_page : alignment, bytes);
  errno = before;
  if (!made) return ENOMEM;
  if (large) {
    // Whole huge pages only: what follows them in the last one may belong to others.
    madvise(made, bytes / huge_page * huge_page, MADV_HUGEPAGE);  // NOLINT: a refusal changes nothing
    errno = before;
  }
  *memory = made;
  return 0;
}
