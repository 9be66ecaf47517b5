#include "app/pictures/lights_pictures.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "app/pictures/picture_files.h"
#include "base/file.h"

namespace noonmark {

std::vector<PictureRecord> keep_lights(const LightsFrame& frame, const std::vector<std::string>& names, int64_t id,
                                       const std::string& out) {
  make_folder_in(out, "images");
  std::vector<std::string> colors;
  for (size_t l = 0; l < names.size(); ++l) colors.push_back(fmt::format("{}: {}", names[l], most_wrong_color(l).name));
  const struct {
    const char* name;
    const Image<Color>& picture;
    std::string caption;
  } pictures[] = {
      {"shown", frame.shown, "The frame of all lights, as the shadow maps show it."},
      {"truth", frame.truth, "The same frame with the true shadows."},
      {"most-wrong", frame.most_wrong,
       fmt::format("Which light makes the largest part of the frame's error at each pixel ({}); black: none.",
                   fmt::join(colors, ", "))}};
  PictureFiles files(out + "/images", "images", fmt::format("p{:04}", id));
  for (const auto& one : pictures)
    files.add(std::string(lights_prefix) + one.name, one.caption, [&one] { return one.picture; });
  return files.write();
}

}  // namespace noonmark
