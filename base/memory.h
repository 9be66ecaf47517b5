// How much memory the program may still take. The program asks before it makes anything large.
//
//   const AvailableMemory available = available_memory();
//   if (needed > available.bytes) throw Error(ErrorKind::device, "this takes " + bytes_text(needed) + "; " + available.text());
//
// Only memory that stays in RAM when it is written to is counted. Swap is not counted, because a measurement that uses
// it would take too long.
#pragma once
#include <cstdint>
#include <string>

namespace noonmark {

// The least of three: what the machine has free (MemAvailable), what the control groups of the process leave (version 1
// and 2, the group's own limit and those of the groups above it, less what is in use; file caches that can be given
// back do not count as used), and what `ulimit -v` leaves of the address space.
struct AvailableMemory {
  uint64_t bytes = UINT64_MAX;  // where nothing is known: no limit
  std::string limit;            // which of the three it is, in words
  std::string text() const;     // "7.9 GB are available (the machine's free memory)"
};

// root: "/" but in tests, which bring proc/ and sys/fs/cgroup/ of their own.
AvailableMemory available_memory(const std::string& root = "/");

// The first two of these limits depend on other processes too; the third depends on this process only.
AvailableMemory free_memory(const std::string& root = "/");
AvailableMemory free_address_space(const std::string& root = "/");

// What the process holds now.
uint64_t resident_bytes();

// "640 MB", "1.2 GB": two digits, in powers of 1000.
std::string bytes_text(double bytes);

}  // namespace noonmark
