#include "app/pictures/picture_files.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <memory>

namespace noonmark {

void PictureFiles::add(std::string name, std::string caption, std::function<Image<Color>()> paint) {
  pictures_.push_back({std::move(name), std::move(caption), std::move(paint)});
}

void PictureFiles::add(std::string name, std::string caption, Image<Color> picture) {
  const auto kept = std::make_shared<const Image<Color>>(std::move(picture));
  add(std::move(name), std::move(caption), [kept] { return *kept; });
}

std::vector<PictureRecord> PictureFiles::write() const {
  std::vector<PictureRecord> records(pictures_.size());
  tbb::parallel_for(size_t{0}, pictures_.size(), [&](size_t i) {
    const Picture& picture = pictures_[i];
    const std::string file = fmt::format("{}-{}.png", stem_, picture.name);
    const std::string digest = write_png(folder_ + "/" + file, picture.paint());
    records[i] = {picture.name, relative_ + "/" + file, picture.caption, digest};
  });
  return records;
}

}  // namespace noonmark
