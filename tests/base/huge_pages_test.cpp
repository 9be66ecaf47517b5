// Large memory of the executable (base/huge_pages.cpp, which is part of this test).
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <new>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

// With AddressSanitizer that file has no functions.
#ifndef __SANITIZE_ADDRESS__
namespace noonmark {
namespace {

constexpr size_t MiB = size_t{1} << 20;

// The flags of the range in which this address lies; no value if it lies in none.
std::optional<std::string> flags_at(const void* memory) {
  const auto address = reinterpret_cast<uintptr_t>(memory);
  std::ifstream ranges("/proc/self/smaps");
  bool here = false;
  for (std::string line; std::getline(ranges, line);) {
    uintptr_t begin = 0, end = 0;
    char between = 0;
    std::istringstream words(line);
    if (words >> std::hex >> begin >> between >> end && between == '-') here = begin <= address && address < end;
    if (here && line.rfind("VmFlags:", 0) == 0) return line;
  }
  return std::nullopt;
}

// Whether huge pages are asked for where this address is.
bool asks_for_huge_pages(const void* memory) { return flags_at(memory).value_or("").find(" hg") != std::string::npos; }

bool kernel_has_huge_pages() { return std::ifstream("/sys/kernel/mm/transparent_hugepage/enabled").good(); }

bool begins_huge_page(const void* memory) { return reinterpret_cast<uintptr_t>(memory) % (2 * MiB) == 0; }

TEST(HugePages, AreAskedForWhereMemoryIsLarge) {
  if (!kernel_has_huge_pages()) GTEST_SKIP() << "the kernel has none";
  void* memory = nullptr;
  ASSERT_EQ(posix_memalign(&memory, 64, 64 * MiB), 0);
  EXPECT_TRUE(begins_huge_page(memory));
  EXPECT_TRUE(asks_for_huge_pages(static_cast<char*>(memory) + 63 * MiB));
  std::free(memory);
  const auto image = std::make_unique<char[]>(64 * MiB);
  EXPECT_TRUE(begins_huge_page(image.get()));
  EXPECT_TRUE(asks_for_huge_pages(image.get() + 63 * MiB));
}

// A picture of 1280 x 720 floats has 1.76 huge pages.
TEST(HugePages, LastOneIsWholeIfLittleIsLost) {
  if (!kernel_has_huge_pages()) GTEST_SKIP() << "the kernel has none";
  const size_t bytes = 1280 * 720 * sizeof(float);
  const auto picture = std::make_unique<char[]>(bytes);
  EXPECT_TRUE(begins_huge_page(picture.get()));
  EXPECT_TRUE(asks_for_huge_pages(picture.get() + bytes - 1));
}

// Address space of this process in MiB.
double mapped_MiB() {
  std::ifstream file("/proc/self/statm");
  double pages = 0;
  file >> pages;
  return pages * static_cast<double>(sysconf(_SC_PAGESIZE)) / static_cast<double>(MiB);
}

// Address space when nothing is kept.
double mapped_at_first() {
  void* texture = nullptr;
  EXPECT_EQ(posix_memalign(&texture, 64, 64 * MiB), 0);
  std::free(texture);
  return mapped_MiB();
}

// More than other tests have in use, so that what is kept is of this test. It is never touched.
constexpr size_t most = 512 * MiB;

TEST(KeptMemory, IsWhatTheNextImageOfItsSizeGets) {
  const size_t bytes = 1280 * 720 * sizeof(float);
  auto first = std::make_unique<char[]>(bytes);
  const char* const place = first.get();
  first.reset();
  EXPECT_TRUE(flags_at(place)) << "it is kept";
  EXPECT_EQ(std::make_unique<char[]>(bytes - 1000).get(), place);
  const auto second = std::make_unique<char[]>(bytes), third = std::make_unique<char[]>(bytes);
  EXPECT_EQ(second.get(), place);
  EXPECT_NE(third.get(), place) << "in use";
  EXPECT_TRUE(begins_huge_page(third.get()));
}

TEST(KeptMemory, IsNeverMoreThanWasInUse) {
  const double before = mapped_at_first();
  operator delete(operator new(most));
  EXPECT_NEAR(mapped_MiB(), before + 512, 8) << "it is kept";
  void* const other = operator new(most / 4);
  EXPECT_NEAR(mapped_MiB(), before + 128, 8) << "512 MiB that are kept and 128 in use would be more";
  operator delete(operator new(most / 4));
  void* const same = operator new(most / 4 - MiB);
  EXPECT_NEAR(mapped_MiB(), before + 256, 8);
  operator delete(other);
  operator delete(same);
  EXPECT_NEAR(mapped_MiB(), before + 256, 8) << "both are kept: 512 were in use";
  const std::unique_ptr<void, void (*)(void*)> large(operator new(most), [](void* memory) { operator delete(memory); });
  EXPECT_NEAR(mapped_MiB(), before + 512, 8) << "the two went back to the kernel";
}

TEST(KeptMemory, GoesBackBeforeALargeTexture) {
  const double before = mapped_at_first();
  operator delete(operator new(most));
  void* texture = nullptr;
  ASSERT_EQ(posix_memalign(&texture, 64, 63 * MiB), 0);
  EXPECT_NEAR(mapped_MiB(), before + 512 + 63, 8);
  std::free(texture);
  ASSERT_EQ(posix_memalign(&texture, 64, 64 * MiB), 0);
  EXPECT_NEAR(mapped_MiB(), before + 64, 8);
  std::free(texture);
}

TEST(KeptMemory, BelongsToOneThreadAtATime) {
  std::vector<std::thread> threads;
  std::atomic<int> wrong{0};
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&wrong, t] {
      for (int i = 0; i < 100000; ++i) {
        const size_t bytes = (2 + static_cast<size_t>((i + t) % 3)) * MiB;
        const std::unique_ptr<char[]> image(new char[bytes]);
        volatile char* const places[] = {&image[0], &image[bytes / 2], &image[bytes - 1]};
        for (volatile char* const place : places) *place = static_cast<char>(t + 1);
        for (volatile char* const place : places) wrong += *place != t + 1;
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
}

TEST(HugePages, AreAskedForWhereTheHeapGrows) {
  if (!kernel_has_huge_pages()) GTEST_SKIP() << "the kernel has none";
  std::vector<std::unique_ptr<char[]>> pieces;
  for (int i = 0; i < 640; ++i) pieces.push_back(std::make_unique<char[]>(MiB / 10));
  // The step in which the last one lies may not have been seen yet.
  size_t asked = 0;
  for (const auto& piece : pieces) asked += asks_for_huge_pages(piece.get());
  EXPECT_GT(asked, pieces.size() / 2);
}

TEST(HugePages, MemoryIsAlignedAsItIsAskedFor) {
  for (const size_t alignment : {sizeof(void*), size_t{64}, size_t{4096}, 4 * MiB})
    for (const size_t bytes : {size_t{1}, size_t{1000}, 5 * MiB + 1}) {
      void* memory = nullptr;
      errno = 7;
      ASSERT_EQ(posix_memalign(&memory, alignment, bytes), 0);
      EXPECT_EQ(errno, 7) << "posix_memalign leaves it alone";
      EXPECT_EQ(reinterpret_cast<uintptr_t>(memory) % alignment, 0u);
      static_cast<char*>(memory)[bytes - 1] = 1;
      std::free(memory);
    }
  void* const before = &errno;
  void* memory = before;
  for (const size_t wrong : {size_t{0}, size_t{4}, size_t{24}})
    EXPECT_EQ(posix_memalign(&memory, wrong, 100), EINVAL) << wrong;
  for (const size_t bytes : {SIZE_MAX / 4, SIZE_MAX - 1, SIZE_MAX}) {
    volatile size_t too_much = bytes;
    EXPECT_EQ(posix_memalign(&memory, 64, too_much), ENOMEM);
    EXPECT_EQ(memory, before) << "nothing was made";
    EXPECT_THROW(static_cast<void>(::operator new(too_much)), std::bad_alloc);
  }
  volatile size_t none = 0;
  EXPECT_NE(std::unique_ptr<char[]>(new char[none]).get(), nullptr);
}

}  // namespace
}  // namespace noonmark
#endif
