// What the head of a PNG or an EXR file says of its size, read before a decoder sees the file: decoders ask for memory by what the
// head says, and the head of a small file can say anything.
#pragma once
#include <string>
#include <string_view>

namespace noonmark {

// Throws Error(file) if the picture has more than most_image_pixels pixels (app/pictures/image_file.h), in any of its parts,
// or more values than the whole file can be unpacked to. format: "png" or "exr".
void require_possible_head(const std::string& path, std::string_view format, std::string_view bytes);

}  // namespace noonmark
