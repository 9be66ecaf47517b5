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
  static const Verb table[] = {
      verb_run(),    verb_check(),     verb_render(), verb_section(), verb_judge(),  verb_capture(), verb_map(),
      verb_live(),   verb_recommend(), verb_init(),   verb_inspect(), verb_report(), verb_merge(),   verb_scenes(),
      verb_export(), verb_settings(),  verb_schema(), verb_doctor(),  verb_help(),   verb_version(),
  };
  return table;
}

}  // namespace noonmark
