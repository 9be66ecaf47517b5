#include <initializer_list>
#include <vector>

#include "app/verbs/verbs.h"

namespace noonmark {

// Each stands at the end of the file with its name: app/verbs/verb_run.cpp and so on.
Verb verb_run();
Verb verb_check();
Verb verb_render();
Verb verb_section();
Verb verb_judge();
Verb verb_capture();
Verb verb_map();
Verb verb_live();
Verb verb_recommend();
Verb verb_init();
Verb verb_inspect();
Verb verb_report();
Verb verb_merge();
Verb verb_scenes();
Verb verb_export();
Verb verb_settings();
Verb verb_schema();
Verb verb_doctor();
Verb verb_help();
Verb verb_version();

std::span<const Verb> verb_table() {
  static const std::vector<Verb> table = [] {
    std::vector<Verb> all;
    const auto add = [&](const char* heading, std::initializer_list<Verb> verbs) {
      for (Verb verb : verbs) {
        verb.heading = heading;
        all.push_back(verb);
      }
    };
    add("Begin here", {verb_live(), verb_init(), verb_recommend(), verb_check(), verb_judge()});
    add("Look closer", {verb_render(), verb_section(), verb_map(), verb_inspect()});
    add("Measure more", {verb_run(), verb_merge(), verb_report(), verb_export(), verb_capture()});
    add("Look up", {verb_scenes(), verb_settings(), verb_schema(), verb_doctor(), verb_help(), verb_version()});
    return all;
  }();
  return table;
}

}  // namespace noonmark
