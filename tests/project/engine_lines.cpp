// The lines for other engines of any settings, as `recommend` writes those of its answer into engines.txt, for the tests that
// type them into an engine:
//   engine_lines NAME=VALUE...
#include <fmt/format.h>

#include <string>
#include <string_view>

#include "app/advise/recommend_text.h"
#include "app/advise/map_places.h"
#include "measure/workbench.h"
#include "technique/light_frame.h"
#include "technique/settings.h"

int main(int count, char** words) {
  using namespace noonmark;
  Settings settings;
  for (int i = 1; i < count; ++i) {
    const std::string_view word = words[i];
    const size_t at = word.find('=');
    find_setting(word.substr(0, at)).set(settings, std::string(word.substr(at + 1)));
  }
  Workbench bench(gl::DebugMode::log);
  const Scene& scene = bench.scene(settings.scene);
  fmt::print("{}", advice_engines(engine_advice(settings, make_light_frame(scene, settings), scene,
                                                depths_in_views(bench, {&settings, 1}))));
}
