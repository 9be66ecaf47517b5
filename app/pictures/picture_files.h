// Pictures of one point or frame, painted and written side by side on all threads.
//
//   PictureFiles files{folder, "images", "p0003"};
//   files.add("truth", "The truth.", [&] { return picture; });
//   files.add("depth", "The map.", picture);                          // what asks OpenGL is painted before
//   return files.write();
#pragma once
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "app/pictures/image_file.h"
#include "compare/results/records.h"

namespace noonmark {

class PictureFiles {
 public:
  // The files are <folder>/<stem>-<name>.png. The paths in the records begin with `relative`, not `folder`.
  PictureFiles(std::string folder, std::string relative, std::string stem)
      : folder_(std::move(folder)), relative_(std::move(relative)), stem_(std::move(stem)) {}

  // paint is called by write(), on any thread and beside the other pictures, so it may not use OpenGL. What it refers to must
  // live until then.
  void add(std::string name, std::string caption, std::function<Image<Color>()> paint);
  void add(std::string name, std::string caption, Image<Color> picture);

  // Writes all of them and returns their records, in the order in which they were added. Throws what write_png() and a
  // painter throw.
  std::vector<PictureRecord> write() const;

 private:
  struct Picture {
    std::string name, caption;
    std::function<Image<Color>()> paint;
  };
  std::string folder_, relative_, stem_;
  std::vector<Picture> pictures_;
};

}  // namespace noonmark
