#include "compare/report/deflate.h"

#include <zlib.h>

#include <stdexcept>

namespace noonmark::report {

std::string deflated(std::string_view bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string out(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(out.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                static_cast<uLong>(bytes.size()), Z_BEST_COMPRESSION) != Z_OK)
    throw std::runtime_error("zlib could not compress a part of the report");
  out.resize(size);
  return out;
}

std::string byte_planes(std::string_view bytes, size_t size) {
  std::string out;
  out.reserve(bytes.size());
  for (size_t plane = 0; plane < size; ++plane)
    for (size_t at = plane; at < bytes.size(); at += size) out += bytes[at];
  return out;
}

}  // namespace noonmark::report
