// Large memory in huge pages. Mesa's llvmpipe takes its textures, and Embree its trees, from posix_memalign, and the program its
// images from operator new. They are written at once: page by page the kernel needs more time to give them than the
// program to write them. On Linux huge pages are often given only to those who ask
// (/sys/kernel/mm/transparent_hugepage/enabled = madvise), and libraries do not ask.
//
// This file is part of the executable alone: its functions stand before those of the libraries, and take all memory from the
// C library, whose free() ends it. Where the kernel has no huge pages they change nothing but the alignment.
#include <sys/mman.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <new>

// AddressSanitizer brings functions of its own, which know what was allocated how.
#if defined(__SANITIZE_ADDRESS__)
#define NOONMARK_OWN_ALLOCATION 0
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define NOONMARK_OWN_ALLOCATION 0
#endif
#endif
#ifndef NOONMARK_OWN_ALLOCATION
#define NOONMARK_OWN_ALLOCATION 1
#endif

#if NOONMARK_OWN_ALLOCATION
namespace {

constexpr size_t huge_page = size_t{2} << 20;  // of x86-64, and of ARM with pages of 4 KiB
constexpr size_t least_bytes = 2 * huge_page;  // smaller memory would lose much of itself to the alignment

// Null if there is no memory. Leaves errno as it was.
void* large_memory(size_t alignment, size_t bytes) {
  const int before = errno;
  void* const made = std::aligned_alloc(std::max(alignment, huge_page), bytes);
  // Whole huge pages only: what follows them in the last one may belong to others. A refusal changes nothing.
  if (made) madvise(made, bytes / huge_page * huge_page, MADV_HUGEPAGE);
  errno = before;
  return made;
}

}  // namespace

extern "C" __attribute__((visibility("default"))) int posix_memalign(void** memory, size_t alignment, size_t bytes) {
  if (alignment % sizeof(void*) != 0 || alignment == 0 || (alignment & (alignment - 1)) != 0) return EINVAL;
  const int before = errno;
  void* const made = bytes >= least_bytes ? large_memory(alignment, bytes) : std::aligned_alloc(alignment, bytes);
  errno = before;
  if (!made) return ENOMEM;
  *memory = made;
  return 0;
}

void* operator new(size_t bytes) {
  for (;;) {
    if (void* const made = bytes >= least_bytes ? large_memory(1, bytes) : std::malloc(std::max<size_t>(bytes, 1)))
      return made;
    const std::new_handler handler = std::get_new_handler();
    if (!handler) throw std::bad_alloc();
    handler();
  }
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, size_t) noexcept { std::free(memory); }
#endif
