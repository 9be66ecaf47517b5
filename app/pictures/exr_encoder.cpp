#include "app/pictures/exr_encoder.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfThreading.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <exception>

#include "base/threads.h"

namespace noonmark {
namespace {

// Hands on what the library writes. After a failure the library is told that all is well, because it writes again while it
// closes the file.
class Output : public Imf::OStream {
 public:
  explicit Output(const TakeBytes& take) : OStream("the image"), take_(take) {}
  void write(const char bytes[], int count) override {
    const std::string_view piece(bytes, static_cast<size_t>(count));
    try {
      if (!failure_) take_(position_, piece);
    } catch (...) {
      failure_ = std::current_exception();
    }
    position_ += piece.size();
  }
  uint64_t tellp() override { return position_; }
  void seekp(uint64_t position) override { position_ = position; }
  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  const TakeBytes& take_;
  uint64_t position_ = 0;
  std::exception_ptr failure_;
};

// How many threads of the library compress rows (most_image_threads). They are started once. If the rays have one thread, or
// if the system lets none start, the caller's thread compresses all.
int compressing_threads() {
  static const int threads = [] {
    const size_t allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    if (allowed < 2) return 0;
    const int started = static_cast<int>(std::min<size_t>(allowed, most_image_threads));
    try {
      Imf::setGlobalThreadCount(started);
    } catch (const std::exception&) {
      return 0;
    }
    return started;
  }();
  return threads;
}

}  // namespace

void encode_exr(int width, int height, const std::vector<std::string>& channels, int rows_at_once,
                const std::function<ExrRows(int first_row, int count)>& rows, const TakeBytes& take) {
  Imf::Header header(width, height);
  header.compression() = Imf::ZIP_COMPRESSION;
  header.zipCompressionLevel() = 1;
  for (const std::string& name : channels) header.channels().insert(name, Imf::Channel(Imf::FLOAT));
  Output output(take);
  {
    Imf::OutputFile file(output, header, compressing_threads());
    for (int first = 0; first < height; first += rows_at_once) {
      const int count = std::min(rows_at_once, height - first);
      const ExrRows from = rows(first, count);
      Imf::FrameBuffer buffer;
      for (size_t c = 0; c < channels.size(); ++c) {
        // The library adds first * row_bytes, and reads alone.
        char* const row_0 = reinterpret_cast<char*>(const_cast<float*>(from.channels.at(c))) -
                            static_cast<ptrdiff_t>(from.row_bytes) * first;
        buffer.insert(channels[c], Imf::Slice(Imf::FLOAT, row_0, from.pixel_bytes, from.row_bytes));
      }
      file.setFrameBuffer(buffer);
      file.writePixels(count);
      output.rethrow();
    }
  }  // the file's table of rows is written here
  output.rethrow();
}

}  // namespace noonmark
