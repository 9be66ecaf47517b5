#include "app/pictures/animated_png.h"

#include <zlib.h>

#include <cstdint>
#include <stdexcept>
#include <string_view>

namespace noonmark {
namespace {

constexpr size_t signature_bytes = 8;

std::string big_endian(uint32_t value, int bytes) {
  std::string text;
  for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8) text += static_cast<char>(value >> shift & 0xff);
  return text;
}

struct Chunk {
  std::string_view type, data;
};

// type: 4 letters.
std::string chunk(std::string_view type, const std::string& data) {
  const std::string checked = std::string(type) + data;
  const auto crc = crc32(0, reinterpret_cast<const Bytef*>(checked.data()), static_cast<uInt>(checked.size()));
  return big_endian(static_cast<uint32_t>(data.size()), 4) + checked + big_endian(static_cast<uint32_t>(crc), 4);
}

// The chunks of a whole PNG file, which was just encoded.
std::vector<Chunk> chunks_of(std::string_view png) {
  constexpr size_t head = 8, check = 4;  // length and type; the CRC
  std::vector<Chunk> chunks;
  for (size_t at = signature_bytes; at < png.size();) {
    if (png.size() - at < head + check) throw std::invalid_argument("a frame is no whole PNG file");
    size_t length = 0;
    for (size_t i = 0; i < 4; ++i) length = length << 8 | static_cast<uint8_t>(png[at + i]);
    if (length > png.size() - at - head - check) throw std::invalid_argument("a frame is no whole PNG file");
    chunks.push_back({png.substr(at + 4, 4), png.substr(at + head, length)});
    at += head + length + check;
  }
  if (chunks.empty() || chunks.front().type != "IHDR") throw std::invalid_argument("a frame is no PNG file");
  return chunks;
}

}  // namespace

std::string animated_png(const std::vector<std::string>& frames, int frame_ms) {
  if (frames.empty() || frame_ms < 1 || frame_ms > 65535) throw std::invalid_argument("no frames, or no time for each");
  const std::vector<Chunk> first = chunks_of(frames.front());
  const std::string_view header = first.front().data;
  std::string out = frames.front().substr(0, signature_bytes) + chunk("IHDR", std::string(header)) +
                    chunk("acTL", big_endian(static_cast<uint32_t>(frames.size()), 4) + big_endian(0, 4));
  for (size_t i = 1; i < first.size() && first[i].type != "IDAT"; ++i)
    out += chunk(first[i].type, std::string(first[i].data));
  uint32_t number = 0;  // of the chunks that an animation adds to each frame
  for (size_t f = 0; f < frames.size(); ++f) {
    const std::vector<Chunk> chunks = f == 0 ? first : chunks_of(frames[f]);
    if (chunks.front().data != header) throw std::invalid_argument("the frames differ in size or in colour type");
    // sequence_number, width and height, x_offset, y_offset, delay_num, delay_den, dispose_op (none) and blend_op
    // (source).
    out +=
        chunk("fcTL", big_endian(number++, 4) + std::string(header.substr(0, 8)) + big_endian(0, 4) + big_endian(0, 4) +
                          big_endian(static_cast<uint32_t>(frame_ms), 2) + big_endian(1000, 2) + big_endian(0, 2));
    for (const Chunk& each : chunks)
      if (each.type == "IDAT")
        out += f == 0 ? chunk("IDAT", std::string(each.data))
                      : chunk("fdAT", big_endian(number++, 4) + std::string(each.data));
  }
  return out + chunk("IEND", "");
}

}  // namespace noonmark
