#include "app/definition/atlas_reader.h"

#include <algorithm>

#include "app/definition/experiment_keys.h"
#include "app/definition/toml_reader.h"
#include "compare/results/quantities.h"

namespace noonmark {
namespace {

class AtlasReader : private TomlReader {
 public:
  explicit AtlasReader(const std::string& path) : TomlReader(path) {}

  AtlasEntry read(const toml::table& section) {
    AtlasEntry entry;
    const auto texts = atlas_texts(entry);
    for (const Item& item : items(section)) {
      const auto* known =
          std::find_if(std::begin(texts), std::end(texts), [&](const auto& text) { return text.first == item.key; });
      if (known != std::end(texts)) {
        *known->second = string(*item.node, "atlas." + item.key);
      } else if (item.key == "limit") {
        for (const Item& limit : items(table(*item.node, "[atlas.limit]"))) {
          at(limit.where, [&] { find_metric(limit.key); });
          entry.limit[limit.key] = number(*limit.node, "atlas.limit." + limit.key);
        }
      } else {
        unknown(item, "key", key_names("atlas"), "atlas.");
      }
      if (item.key == "cause") at(item.where, [&] { find_metric(entry.cause); });
      if (item.key == "driver") at(item.where, [&] { find_setting(entry.driver); });
      if (item.key == "without" && entry.without.find('=') == std::string::npos)
        fail(*item.node, "atlas.without must be name=value, as after --set");
    }
    for (const auto& [key, value] : texts)
      if (value->empty() && key != "note" && key != "thread" && key != "answer")
        fail(section, fmt::format("[atlas] needs {}", key));
    if (entry.thread.empty() != entry.answer.empty())
      fail(section, "[atlas] has one of thread and answer; give both or none");
    return entry;
  }
};

}  // namespace

AtlasEntry read_atlas_entry(const toml::table& table, const std::string& path) { return AtlasReader(path).read(table); }

}  // namespace noonmark
