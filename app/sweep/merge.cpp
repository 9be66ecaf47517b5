#include "app/sweep/merge.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>

#include "app/definition/definition.h"
#include "app/sweep/identity.h"
#include "app/sweep/judging.h"
#include "app/sweep/shares.h"
#include "app/sweep/sweep_phase.h"
#include "base/digest.h"
#include "base/error.h"
#include "base/file.h"
#include "base/text.h"
#include "compare/judge/machines.h"
#include "compare/judge/soundness.h"
#include "compare/report/junit.h"
#include "compare/report/summary.h"
#include "compare/store/fingerprint.h"
#include "compare/store/store.h"
#include "measure/pass_times.h"

namespace noonmark {
namespace {

namespace fs = std::filesystem;

constexpr const char* joined_share = "joined";  // RunInfo::share of a joined store

// What a store says of itself, without its points.
struct Source {
  std::string folder, path, plan, fingerprint;  // the fingerprint and plan with the joined store's names of scenes
  std::string experiment;                       // the path of its experiment, on its host
  RunInfo info;
};

// A scene of --set can be written in two ways ("./street.glb"), of which the definition keeps one.
std::string without_scene_names(const std::string& plan) {
  std::string text;
  std::istringstream in(plan);
  for (std::string line; std::getline(in, line);)
    if (line.find("scene.name") == line.npos) text += line + "\n";
  return text;
}

Source read_source(const std::string& folder) {
  Source source{folder, folder + "/results.sqlite", "", "", "", {}};
  std::error_code none;
  if (!fs::exists(source.path, none))
    throw Error(ErrorKind::usage,
                fmt::format("{}: there are no results here (no results.sqlite); give the folders that "
                            "noonmark run --shard wrote",
                            folder));
  const ResultStore store = ResultStore::open(source.path);
  store.require_whole();
  source.fingerprint = store.fingerprint();
  source.info = store.facts().info;
  if (source.info.definition.empty())
    throw Error(ErrorKind::usage,
                fmt::format("{}: does not hold its experiment, because its options cannot be written as a file; run it "
                            "with --shard",
                            folder));
  source.experiment = definition_path(source.info.definition);
  const std::string defined = fingerprint(experiment_of(source.info.definition, source.path), {});
  if (without_scene_names(defined) != without_scene_names(store.plan()))
    throw Error(ErrorKind::usage, fmt::format("{}: was stopped before its first point; run the share again", folder));
  return source;
}

// Says it all as the first source does, whose paths are not those of its host.
void move_to(Source& source, const Source& first) {
  const std::string to = definition_path(without_host_path(first.info.definition));
  source.info.definition = with_path(source.info.definition, to);
  source.plan = fingerprint(experiment_of(source.info.definition, source.path), {});
  source.fingerprint = with_scene_names(
      source.fingerprint, [&](const std::string& scene) { return moved_scene(scene, source.experiment, to); });
}

void require_same(const Source& first, const Source& other) {
  const auto refuse = [&](const std::string& difference) {
    throw Error(ErrorKind::usage,
                fmt::format("{} and {} do not belong together: {}; merge only shares of one experiment, "
                            "measured by one version of Noonmark on the same scenes",
                            first.folder, other.folder, difference));
  };
  const auto differ = [&](const std::string& a, const std::string& b) {
    std::string text = first_difference(a, b);  // "now 'x', there 'y'"
    for (const auto& [word, folder] : {std::pair{std::string("now "), first.folder}, {"there ", other.folder}})
      if (const size_t at = text.find(word); at != text.npos) text.replace(at, word.size(), "in " + folder + " ");
    refuse(text);
  };
  if (other.plan != first.plan) differ(first.plan, other.plan);
  const std::string a = without_machine(first.fingerprint), b = without_machine(other.fingerprint);
  if (!same_facts(a, b)) differ(a, b);
  if (other.info.definition != first.info.definition)
    refuse("their bounds, laws, title or options are not the same; run the share again, which keeps its points");
}

bool same_folder(const std::string& a, const std::string& b) {
  std::error_code none;
  return fs::equivalent(a, b, none);
}

// As its shares name it. The path of a joined store is that of its first share (joined_info).
std::string joined_name(const std::string& experiment) {
  return fs::path(experiment).is_absolute() ? fs::path(experiment).filename().string() : experiment;
}

fs::path without_way_up(const fs::path& path) {
  fs::path rest;
  for (const fs::path& step : path.lexically_normal())
    if (step != "..") rest /= step;
  return rest;
}

// The experiment's file as seen from the joined store. Empty if the way there has folders that the name of the experiment does
// not have, because they are of one host.
std::string joined_file(const Source& first, const std::string& out) {
  if (first.info.file.empty()) return "";
  const std::string file = seen_from(out, first.folder + "/" + first.info.file);
  return without_way_up(file) == without_way_up(first.info.experiment) ? file : "";
}

constexpr const char* store_name = "results.sqlite";

// Empty if the folder has no store, or one that cannot be read.
std::optional<RunInfo> facts_in(const std::string& folder) {
  std::error_code none;
  if (!fs::exists(folder + "/" + store_name, none)) return std::nullopt;
  try {
    return ResultStore::open(folder + "/" + store_name).facts().info;
  } catch (const Error&) {
    return std::nullopt;
  }
}

// A merge that is killed early leaves a store without points, which does not yet say whose it is.
bool holds_points(const std::string& folder) {
  const ResultStore store = ResultStore::open(folder + "/" + store_name);
  return !store.finished().empty() || !store.phases().empty();
}

void require_own_store(const ResultsFolder& out, const std::vector<std::string>& shares, bool overwrite) {
  for (const std::string& share : shares)
    if (same_folder(share, out.path()))
      throw Error(ErrorKind::usage,
                  fmt::format("{}: is one of the shares; give another folder for the joined results", out.path()));
  if (overwrite) return;
  const auto refuse = [&](const std::string& holds) {
    throw Error(
        ErrorKind::usage,
        fmt::format("{}: holds {}; give another folder, or pass --overwrite, which loses them", out.path(), holds));
  };
  std::error_code none;
  if (!fs::exists(out.path() + "/" + store_name, none)) return;
  const std::optional<RunInfo> there = facts_in(out.path());
  if (!there && MadeFiles(out.path()).has(store_name)) return;  // of a merge that was killed, or damaged since
  if (!there) refuse("a file results.sqlite that is damaged, or no store of Noonmark");
  if (!holds_points(out.path())) return;
  if (there->share != joined_share) refuse("results that were measured there, not joined ones");
  const std::optional<RunInfo> first = facts_in(shares.front());
  if (first && joined_name(first->experiment) != there->experiment)
    refuse(fmt::format("the joined results of another experiment ({})", there->experiment));
}

// The facts of the whole. A fact of the machine that is not the same everywhere is "several".
RunInfo joined_info(const std::vector<Source>& sources, const std::string& out) {
  RunInfo info = sources.front().info;
  info.share = joined_share;
  info.command = fmt::format("noonmark merge (of {})", counted(sources.size(), "store"));
  info.experiment = joined_name(info.experiment);
  info.file = joined_file(sources.front(), out);
  for (const Source& source : sources) {
    const RunInfo& other = source.info;
    info.started = std::min(info.started, other.started);
    for (const auto member : {&RunInfo::host_cpu, &RunInfo::gl_vendor, &RunInfo::gl_renderer, &RunInfo::gl_version,
                              &RunInfo::gl_timer, &RunInfo::embree_version, &RunInfo::embree_isa})
      if (info.*member != other.*member) info.*member = "several";
    for (const auto& [name, version] : other.libraries)
      if (std::string& here = info.libraries[name]; here != version) here = here.empty() ? version : "several";
    for (const std::string& note : other.scene_notes)
      if (std::find(info.scene_notes.begin(), info.scene_notes.end(), note) == info.scene_notes.end())
        info.scene_notes.push_back(note);
    // A sweep is dead if no point of any share reads it.
    std::erase_if(info.sweep_notes, [&](const std::string& note) {
      return std::find(other.sweep_notes.begin(), other.sweep_notes.end(), note) == other.sweep_notes.end();
    });
  }
  return info;
}

std::string joined_fingerprint(const std::vector<Source>& sources) {
  std::string facts = sources.front().fingerprint;
  for (const Source& source : sources)
    facts = joined_facts(with_both_machines(facts, source.fingerprint), source.fingerprint);
  return facts;
}

// Copies the files that are as they were written. The report says of the others that they are lost.
void copy_pictures(const Source& source, const std::vector<PointPictures>& of_points, const std::string& out) {
  const auto copy = [&](const std::string& path, const std::string& digest) {
    if (!path.starts_with("images/p") || path.find("..") != std::string::npos) return;
    try {
      if (digest_of_file_below(source.folder, path) != digest) return;
      constexpr uint64_t max_bytes = uint64_t{1} << 32;
      const std::string bytes = read_file_below(source.folder, path, max_bytes);
      make_folder_in(out, "images");
      write_file_atomically(out + "/" + path, bytes);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::file) throw;
    }
  };
  for (const PointPictures& point : of_points) {
    for (const PictureRecord& picture : point.pictures) copy(picture.path, picture.digest);
    for (const ImageRecord& image : point.images) copy(image.path, image.digest);
  }
}

// Both values, and which of the two contradicts itself.
[[noreturn]] void refuse_differing(const JoinedStore& joined, const Experiment& experiment, const Source& source) {
  std::vector<std::string> texts;
  for (const Difference& one : joined.differences) {
    const std::string swept = swept_text(experiment, one.point);
    std::string text = fmt::format("point {}{}: {}", one.point, swept.empty() ? "" : " (" + swept + ")", one.what);
    text += one.here.empty() ? fmt::format(" differs between {} and the shares before", source.folder)
                             : fmt::format(" is {} in {} and {} in a share before", one.there, source.folder, one.here);
    for (size_t i = 0; i < one.records.size(); ++i)
      if (const std::vector<Unsound> unsound = find_unsound({&one.records[i], 1}); !unsound.empty())
        text += fmt::format(" ({} is not sound: {} = {})", i == 0 ? "the share before" : source.folder,
                            unsound.front().limit->metric, unsound.front().value);
    texts.push_back(text);
  }
  const auto more = joined.differing - static_cast<int64_t>(texts.size());
  throw Error(
      ErrorKind::defect,
      fmt::format("{}{}; {} measured by two shares differ{}, so one of the machines is wrong; nothing is joined. "
                  "Look at these points with noonmark render on both machines",
                  fmt::join(texts, "; "), more > 0 ? fmt::format("; and {} more", more) : "",
                  counted(static_cast<size_t>(joined.differing), "point"), joined.differing == 1 ? "s" : ""));
}

// What no store has, by shares of the experiment: one sentence for each share.
std::vector<std::string> find_missing(const ResultStore& store, const Experiment& experiment,
                                      const std::vector<Settings>& planned, const std::vector<Source>& sources) {
  std::set<int64_t> missing, untimed;
  const std::vector<int64_t> there = store.finished();
  for (int64_t id = 0; id < static_cast<int64_t>(planned.size()); ++id)
    if (!std::binary_search(there.begin(), there.end(), id)) missing.insert(id);
  if (times_measured(experiment))
    for (const int64_t id : store.lacking("shadow_ms")) untimed.insert(id);
  std::map<int64_t, std::string> undrawn;
  for (const std::vector<int64_t> drawn = store.phases(); const PhasePlan& plan : phase_plans(experiment, planned))
    if (!std::binary_search(drawn.begin(), drawn.end(), plan.number)) undrawn[plan.first] = plan.name();
  std::vector<std::string> texts;
  if (missing.empty() && untimed.empty() && undrawn.empty()) return texts;

  Shard shard;        // how the experiment was split; 1/1: the stores are whole runs
  std::string where;  // the option --out that puts a share beside the others
  for (const Source& source : sources) {
    if (source.info.share.empty() || source.info.share == joined_share) continue;
    const Shard one = shard_from(source.info.share);
    shard.of = std::max(shard.of, one.of);
    const fs::path folder = fs::path(source.folder).lexically_normal();
    if (folder.filename() == one.folder() && folder.has_parent_path())
      where = " --out " + shell_quoted(folder.parent_path().string());
  }
  // As it is named on the host of the first share.
  const Experiment named =
      experiment_of(with_path(sources.front().info.definition, sources.front().experiment), sources.front().path);
  for (const Share& share : split(experiment, planned, shard.of)) {
    std::vector<int64_t> lost;
    size_t without_times = 0;
    std::string diagrams;
    for (const int64_t id : share.points) {
      if (missing.contains(id)) lost.push_back(id);
      without_times += untimed.contains(id);
      if (const auto plan = undrawn.find(id); plan != undrawn.end()) diagrams += ", " + plan->second;
    }
    if (!lost.empty() || without_times > 0 || !diagrams.empty()) {
      std::string what;
      if (!lost.empty()) {
        const auto [low, high] = std::minmax_element(lost.begin(), lost.end());
        what += lost.size() == 1 ? fmt::format(", point {}", *low)
                                 : fmt::format(", {} from {} to {}", counted(lost.size(), "point"), *low, *high);
      }
      if (without_times > 0) what += fmt::format(", the times of {}", counted(without_times, "point"));
      what += diagrams;
      texts.push_back(fmt::format("missing: {}; measured by: {}", what.substr(2),
                                  share_command(named, shard.of > 1 ? shard.text() : "") + where));
    }
    ++shard.number;
  }
  return texts;
}

}  // namespace

Merged merge_stores(const std::vector<std::string>& shares, const ResultsFolder& out, bool overwrite) {
  require_own_store(out, shares, overwrite);
  out.take();
  std::vector<Source> sources;
  for (const std::string& folder : shares) {
    Source source = read_source(folder);
    move_to(source, sources.empty() ? source : sources.front());
    sources.push_back(std::move(source));
    require_same(sources.front(), sources.back());
  }
  Merged merged;
  merged.experiment = experiment_of(sources.front().info.definition, sources.front().path);
  const Experiment& experiment = merged.experiment;
  const std::vector<Settings> planned = points(experiment);

  MadeFiles(out.path()).add(std::array{std::string(store_name)});
  const std::string path = out.path() + "/" + store_name;
  const std::string facts = joined_fingerprint(sources);
  ResultStore store(path, facts, Existing::overwrite);
  out.remove_earlier_results();
  try {
    store.set_plan(facts, sources.front().plan);
    store.set_info(joined_info(sources, out.path()), static_cast<int64_t>(planned.size()));
    for (const Source& source : sources) {
      const JoinedStore joined = store.join(source.path, [&](const std::string& scene) {
        return moved_scene(scene, source.experiment, experiment.path);
      });
      if (joined.differing > 0) refuse_differing(joined, experiment, source);
      merged.shared += joined.shared;
      copy_pictures(source, joined.pictures, out.path());
    }
    merged.missing = find_missing(store, experiment, planned, sources);
    merged.results = store.load();
    judge(experiment, merged.results);
    merged.results.stopped = !merged.missing.empty();
    store.set_bounds(merged.results.bounds);
    store.set_laws(merged.results.laws);
  } catch (...) {
    out.remove_earlier_results();
    std::error_code none;
    for (const char* ending : {"", "-journal", "-wal", "-shm"}) fs::remove(path + ending, none);
    throw;
  }
  write_report(merged.results, out.path());
  if (!merged.results.bounds.empty() || !merged.results.laws.empty()) {
    write_file_atomically(out.path() + "/junit.xml", to_junit(merged.results));
    write_file_atomically(out.path() + "/summary.md", to_summary(merged.results));
  }
  store.require_in_place();
  if (const std::string& scene = planned.front().scene.name; fs::path(scene).is_absolute())
    merged.notes.push_back(
        fmt::format("the scene's name {} is a path of one host; it has only the root in common with the path of the "
                    "experiment. Put both below "
                    "one folder, and the results name the scene from there",
                    scene));
  if (merged.missing.empty() &&
      (experiment.pictures == "worst" || experiment.pictures == "extremes" || experiment.pictures == "answers"))
    merged.notes.push_back(fmt::format(
        "the points with pictures are chosen by their errors, so no share has drawn them; {} --out {} draws them",
        share_command(experiment, ""), shell_quoted(out.path())));
  return merged;
}

}  // namespace noonmark
