// Encodes images of named 32-bit float channels as an OpenEXR file, with the OpenEXR library. Rows come and bytes go in
// pieces, so that neither the image nor the file need be in memory as a whole.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace noonmark {

// Takes bytes of the file, which are not always the next ones.
using TakeBytes = std::function<void(uint64_t offset, std::string_view bytes)>;

// Where the rows from `first_row` on lie in memory, until they have been encoded: the address of the first one's first value
// for each channel, the number of bytes from a pixel to the next one and from a row to the next one.
struct ExrRows {
  std::vector<const float*> channels;
  size_t pixel_bytes = 0, row_bytes = 0;
};

// rows(first_row, count) is called for one stretch of at most `rows_at_once` rows after the other, from the top down. Throws
// std::exception with the library's reason, and what `rows` and `take` throw. May be called from several threads at once.
void encode_exr(int width, int height, const std::vector<std::string>& channels, int rows_at_once,
                const std::function<ExrRows(int first_row, int count)>& rows, const TakeBytes& take);

}  // namespace noonmark
