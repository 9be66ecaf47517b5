// Memory in huge pages: large memory, and the C library's heap. Page by page the kernel needs more time to give memory than the
// program to write it. On Linux huge pages are often given only to those who ask
// (/sys/kernel/mm/transparent_hugepage/enabled = madvise), and libraries do not ask. Mesa's llvmpipe takes its textures, and
// Embree its trees, from posix_memalign; the program takes its images from operator new.
//
//   - Large memory (least_large) begins a huge page. It lies in pages of its own, which the kernel gets back when it is freed
//     for good, unless it fits into what is free in the heap: freed large memory between small pieces would stay with the program.
//   - Large memory of operator new is kept when it is freed, for the next request of about its size (KeptMemory): each
//     measurement makes the same images anew. Kept memory and memory in use are together at most what was in use at one time.
//   - All else lies in the heap. It grows by many pages at once, and the huge pages are asked for when operator new sees that it
//     has grown. It keeps some memory that is free at its end, for the next point. The heaps of threads other than the first
//     are left as they are.
//
// This file is part of the executable alone: its functions stand before those of the libraries, and take all memory from the
// C library, whose free() ends it. Where the kernel has no huge pages they change nothing but the alignment.
#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <mutex>
#include <new>
#include <type_traits>

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
// Memory ends with a whole huge page if at most 1 / most_lost of it is lost; if not, its last bytes lie in small pages.
constexpr size_t most_lost = 4;
constexpr size_t least_large =
    huge_page * most_lost / (most_lost + 1) + 1;  // from this size on, its last huge page is whole

// Null if there is no memory. Leaves errno as it was.
void* memory_of_system(size_t alignment, size_t bytes) {
  const int before = errno;
  if (const size_t lost = (huge_page - bytes % huge_page) % huge_page;
      lost <= bytes / most_lost && bytes <= PTRDIFF_MAX)
    bytes += lost;
  void* const made = std::aligned_alloc(std::max(alignment, huge_page), bytes);
  // Whole huge pages only: what follows them in the last one may belong to others. A refusal changes nothing.
  if (made) madvise(made, bytes / huge_page * huge_page, MADV_HUGEPAGE);
  errno = before;
  return made;
}

// Freed large memory of operator new, kept for the next request. The pieces in use and the kept ones are together at most what
// was in use at one time. When memory is short, operator new and posix_memalign free the kept ones; malloc() does not.
class KeptMemory {
 public:
  // A kept piece, or a new one. Null if there is no memory.
  void* take(size_t bytes) {
    const std::scoped_lock lock(mutex_);
    void* made = kept_for(bytes);
    if (!made) {
      // A new piece takes more than was asked: its last huge page may be whole, and its alignment costs one more.
      const size_t may_keep = most_ - in_use_, beside = may_keep - std::min(may_keep, bytes);
      shrink(beside - std::min(beside, bytes / most_lost + 2 * huge_page));
      made = memory_of_system(1, bytes);
    }
    if (made) in_use_ += malloc_usable_size(made);
    most_ = std::max(most_, in_use_);
    return made;
  }

  void put(void* memory, size_t bytes) {
    const std::scoped_lock lock(mutex_);
    in_use_ -= std::min(in_use_, bytes);
    if (count_ == most_pieces) shrink(kept_bytes_ - pieces_[0].bytes);
    pieces_[count_++] = {memory, bytes};
    kept_bytes_ += bytes;
  }

  // False if nothing is kept.
  bool free_all() {
    const std::scoped_lock lock(mutex_);
    const bool any = count_ > 0;
    shrink(0);
    return any;
  }

 private:
  struct Piece {
    void* memory;
    size_t bytes;
  };
  static constexpr size_t most_pieces = 64;

  // The smallest piece that does, the newest of equal ones. One that is larger by more than a quarter and a huge page is no use:
  // the rest of it would be held for nothing.
  void* kept_for(size_t bytes) {
    size_t best = count_;
    for (size_t i = 0; i < count_; ++i)
      if (pieces_[i].bytes >= bytes && pieces_[i].bytes - bytes <= bytes / most_lost + huge_page &&
          (best == count_ || pieces_[i].bytes <= pieces_[best].bytes))
        best = i;
    return best < count_ ? remove(best) : nullptr;
  }

  // Frees the oldest kept pieces until at most `bytes` are kept.
  void shrink(size_t bytes) {
    while (kept_bytes_ > bytes) std::free(remove(0));
  }

  void* remove(size_t i) {
    void* const memory = pieces_[i].memory;
    kept_bytes_ -= pieces_[i].bytes;
    std::copy(pieces_ + i + 1, pieces_ + count_, pieces_ + i);
    --count_;
    return memory;
  }

  std::mutex mutex_;
  Piece pieces_[most_pieces] = {};                             // the oldest first
  size_t count_ = 0, kept_bytes_ = 0, in_use_ = 0, most_ = 0;  // the last three in bytes
};
constinit KeptMemory kept_memory;
static_assert(std::is_trivially_destructible_v<KeptMemory>, "memory is freed until the process ends");

// Before a library gets memory of this size, all kept memory is freed. The textures of large shadow maps are such memory.
constexpr size_t least_of_texture = size_t{64} << 20;

#ifdef __GLIBC__
// The heap grows by heap_step, and keeps up to heap_kept that is free at its end. Measured with 200 points of 64 x 64 pixels:
// with steps of 4 MiB half as many page faults again, because each step begins with a small page.
constexpr int heap_step = 16 << 20, heap_kept = 2 * heap_step;

std::atomic<char*> advised_end{nullptr};

[[gnu::constructor]] void lay_out_heap() {
  advised_end = static_cast<char*>(sbrk(0));
  mallopt(M_MMAP_THRESHOLD, static_cast<int>(least_large));
  mallopt(M_TOP_PAD, heap_step);
  mallopt(M_TRIM_THRESHOLD, heap_kept);
}

// Asks for huge pages where the heap has grown. Two threads that see it at once ask twice.
void advise_heap() {
  char* const end = static_cast<char*>(sbrk(0));
  char* const before = advised_end.load(std::memory_order_relaxed);
  if (end == before) return;
  advised_end.store(end, std::memory_order_relaxed);
  if (end < before) return;  // it has shrunk
  const int error = errno;
  madvise(before, static_cast<size_t>(end - before), MADV_HUGEPAGE);
  errno = error;
}
#else
void advise_heap() {}
#endif

}  // namespace

extern "C" __attribute__((visibility("default"))) int posix_memalign(void** memory, size_t alignment, size_t bytes) {
  if (alignment % sizeof(void*) != 0 || alignment == 0 || (alignment & (alignment - 1)) != 0) return EINVAL;
  const int before = errno;
  if (bytes >= least_of_texture) kept_memory.free_all();
  void* made;
  do {
    made = bytes >= least_large ? memory_of_system(alignment, bytes) : std::aligned_alloc(alignment, bytes);
  } while (!made && kept_memory.free_all());
  errno = before;
  if (!made) return ENOMEM;
  *memory = made;
  return 0;
}

void* operator new(size_t bytes) {
  advise_heap();
  for (;;) {
    if (void* const made = bytes >= least_large ? kept_memory.take(bytes) : std::malloc(std::max<size_t>(bytes, 1)))
      return made;
    if (kept_memory.free_all()) continue;
    const std::new_handler handler = std::get_new_handler();
    if (!handler) throw std::bad_alloc();
    handler();
  }
}

void operator delete(void* memory) noexcept {
  const bool may_be_large = memory && reinterpret_cast<uintptr_t>(memory) % huge_page == 0;
  if (const size_t bytes = may_be_large ? malloc_usable_size(memory) : 0; bytes >= least_large)
    kept_memory.put(memory, bytes);
  else
    std::free(memory);
}
void operator delete(void* memory, size_t) noexcept { operator delete(memory); }
#endif
