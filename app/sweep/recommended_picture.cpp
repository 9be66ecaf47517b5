#include "app/sweep/recommended_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "app/advise/recommend_judge.h"
#include "app/pictures/image_file.h"
#include "app/pictures/pictures.h"
#include "app/pictures/point_pictures.h"
#include "base/file.h"
#include "compare/judge/curve_reading.h"
#include "compare/judge/tradeoff.h"
#include "compare/report/opening.h"
#include "compare/report/text.h"
#include "compare/results/point_settings.h"
#include "compare/results/quantities.h"
#include "technique/settings.h"

namespace noonmark {
namespace {

bool is_at_bias(const PictureRecord& picture) { return report::bias_in_name(picture.name).has_value(); }

std::vector<PictureRecord> pictures_at_bias(const Measurement& m, const report::Opening& opened,
                                            const std::string& out) {
  const PointRecord& point = *opened.point;
  const std::string bias =
      fmt::format("{} {}", curve_parameter(point), report::bias_in_unit(*opened.bias, curve_unit(point)));
  make_folder_in(out, "images");
  std::vector<PictureRecord> pictures;
  const auto add = [&](const char* name, const std::string& caption, const Image<Color>& picture) {
    const std::string path = fmt::format("images/p{:04}-recommended-{}.png", point.id, name);
    const std::string digest = write_png(out + "/" + path, picture);
    pictures.push_back({report::name_at_bias(name, *opened.bias), path, caption, digest});
  };
  add("map", fmt::format("What the shadow map shows (R5) with {}.", bias), shown_picture(m));
  add("classes", fmt::format("Why each wrong pixel is wrong with {}.", bias), causes_picture(m));
  return pictures;
}

}  // namespace

void keep_recommended_picture(Results& results, ResultStore& store, const std::string& out,
                              const std::function<Measurement(int64_t, const Settings&)>& measure) {
  const report::Opening opened = report::opening(results);
  for (PointRecord& point : results.points) {
    const auto old = std::find_if(point.pictures.begin(), point.pictures.end(), is_at_bias);
    const bool wanted = opened.bias && opened.point == &point, there = old != point.pictures.end();
    if (wanted && there && report::bias_in_name(old->name)->bias == *opened.bias) continue;
    if (!remove_those(point, is_at_bias, out) && !wanted) continue;
    if (wanted) {
      Settings settings = settings_of(point);
      settings.map.placements = 1;  // the picture is of the point's own
      find_setting(curve_parameter(point)).set(settings, fmt::format("{}", *opened.bias));
      const std::vector<PictureRecord> drawn = pictures_at_bias(measure(point.id, settings), opened, out);
      point.pictures.insert(point.pictures.end(), drawn.begin(), drawn.end());
    }
    store.set_pictures(point.id, point);
  }
}

}  // namespace noonmark
