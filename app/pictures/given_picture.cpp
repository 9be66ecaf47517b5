#include "app/pictures/given_picture.h"

#include <fmt/format.h>

#include "app/pictures/image_file.h"
#include "base/error.h"

namespace noonmark {

RungOnTop given_picture(const std::string& path, const ViewSettings& view) {
  RungOnTop rung{.name = "R6",
                 .picture = read_grey(path, view.width_px, view.height_px),
                 .cause = "elsewhere",
                 .label = "Elsewhere (in the given picture)",
                 .help =
                     "Mean |R6 - R5|: the given picture compared with what the GPU shows with Noonmark's own "
                     "technique."};
  for (int y = 0; y < rung.picture.height; ++y)
    for (int x = 0; x < rung.picture.width; ++x)
      if (const float value = rung.picture.at(x, y); !(value >= 0 && value <= 1))
        throw Error(
            ErrorKind::file,
            fmt::format("{}: the pixel x = {}, y = {} (row 0 on top) is {}; write the visibility of every pixel, "
                        "from 0 (shadowed) to 1 (lit), also where there is no surface",
                        path, x, y, value));
  return rung;
}

}  // namespace noonmark
