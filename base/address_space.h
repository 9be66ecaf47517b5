// Asks in advance whether memory is left. In Embree's build, in a driver and at the start of a thread, an allocation
// that fails ends the program or never returns, so it could not be reported there.
//
//   require_address_space(192 * triangles, "Embree's tree of the scene");   // then build it
#pragma once
#include <cstdint>
#include <string_view>

namespace noonmark {

// The address space that a new thread takes: its stack, and what the C library reserves for its allocations.
inline constexpr uint64_t address_space_of_a_thread = uint64_t{8 + 128} << 20;

// Throws Error(device) when the process cannot get that many bytes more (ulimit -v, or no address space left). It does
// not write to them, so it cannot tell whether the machine really has the memory that it promises.
void require_address_space(uint64_t bytes, std::string_view for_what);

}  // namespace noonmark
