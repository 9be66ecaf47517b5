// Compression of large parts of the page. Browsers read it with DecompressionStream('deflate').
#pragma once
#include <string>
#include <string_view>

namespace noonmark::report {

// The bytes in zlib's format (RFC 1950), at its highest level. The same bytes always give the same result.
// Throws std::runtime_error if zlib has no memory.
std::string deflated(std::string_view bytes);

// Groups `count` values of `size` bytes: the first bytes of all of them, then the second bytes, and so on. Floats that
// lie close together then compress better. `bytes` has size * count bytes.
std::string byte_planes(std::string_view bytes, size_t size);

}  // namespace noonmark::report
