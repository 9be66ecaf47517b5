// Whether memory is left where running out of it could not be reported: within Embree's build, a driver or a thread's
// start, an allocation that fails ends the program, or never returns.
//
//   require_address_space(192 * triangles, "Embree's tree of the scene");   // then build it
#pragma once
#include <cstdint>
#include <string_view>

namespace noonmark {

// What a thread that starts takes: its stack, and what the C library sets aside for its allocations.
inline constexpr uint64_t address_space_of_a_thread = uint64_t{8 + 128} << 20;

// Throws Error(device) when the process may not have that many bytes more (ulimit -v, or no address space left). It
// touches none of them, so that it says nothing of memory that the machine has promised more often than it has it.
void require_address_space(uint64_t bytes, std::string_view for_what);

}  // namespace noonmark
