// The result store: it returns what was stored, and only damage to the file can destroy it.
#include "compare/store/store.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <bit>
#include <tuple>

#include "base/error.h"
#include "base/file.h"
#include "compare/results/quantities.h"
#include "compare/results/record_fields.h"
#include "compare/store/seals.h"
#include "compare/store/sqlite.h"
#include "tests/support/kind_thrown.h"
#include "tests/support/sample_results.h"

namespace noonmark {
namespace {

const std::string fingerprint = "version = 0.1.0\nmap.format = 24\nsweep map.resolution = [512 | 1024]\n";

class Store : public testing::Test {
 protected:
  ResultStore fresh() { return ResultStore(path, fingerprint, Existing::resume); }
  // The message of the Error that opening throws.
  std::string refusal(const std::string& print = fingerprint, ErrorKind kind = ErrorKind::file) {
    std::string message = "was opened";
    EXPECT_EQ(kind_thrown([&] { ResultStore(path, print, Existing::resume); }, &message), static_cast<int>(kind))
        << message;
    return message;
  }
  TemporaryFolder folder;
  const std::string path = folder.file("results.sqlite");
};

TEST_F(Store, ReturnsThePhaseDiagrams) {
  PhaseDiagram refused;
  refused.part = "lamp";
  refused.refused = "a point light has none";
  {
    ResultStore store = fresh();
    store.add_phase(1, sample_phase());
    store.add_phase(0, refused);
    EXPECT_THROW(store.add_phase(1, sample_phase()), Error) << "another run wrote it";
    EXPECT_EQ(store.phases(), (std::vector<int64_t>{0, 1}));
  }
  const Results results = ResultStore::open(path).load();
  ASSERT_EQ(results.phases.size(), 2u);
  EXPECT_TRUE(same(results.phases[0], refused));
  EXPECT_TRUE(same(results.phases[1], sample_phase()));

  // A diagram that the experiment no longer asks for, or asks for with other options, is dropped.
  ResultStore store = fresh();
  EXPECT_TRUE(store.repair_phases([](int64_t id, const PhaseDiagram&) { return id == 1; }).empty());
  EXPECT_EQ(store.phases(), std::vector<int64_t>{1});
  store.add_phase(0, refused);
  EXPECT_EQ(store.load().phases.size(), 2u);
}

TEST_F(Store, ReturnsWhatItWasGiven) {
  {
    ResultStore store = fresh();
    store.set_info(sample_info(), 9);
    store.add(sample_point(5));
    store.add(sample_point(2, false));
    BoundResult bound;
    bound.metric = "acne";
    bound.max = 0.1 + 0.2;
    bound.where = {{"map.resolution", {"512", "1024"}}};
    bound.join = "median";
    bound.held = true;
    bound.found = 0.25;
    bound.point = 5;
    bound.points = 2;
    bound.reproduce = "noonmark render x.toml --set 'a=b'";
    store.set_bounds({bound, bound});
    store.set_bounds({bound});
  }
  const Results results = ResultStore::open(path).load();
  ASSERT_EQ(results.points.size(), 2u);
  EXPECT_TRUE(same(results.points[0], sample_point(2, false)));
  EXPECT_TRUE(same(results.points[1], sample_point(5)));
  EXPECT_EQ(results.planned_points, 9);
  ASSERT_EQ(results.bounds.size(), 1u);
  const BoundResult& bound = results.bounds[0];
  EXPECT_EQ(bound.metric, "acne");
  EXPECT_EQ(bound.max, 0.1 + 0.2);
  EXPECT_EQ(bound.min, std::nullopt);
  EXPECT_EQ(bound.where.at("map.resolution"), (std::vector<std::string>{"512", "1024"}));
  EXPECT_EQ(bound.join, "median");
  EXPECT_TRUE(bound.held);
  EXPECT_EQ(bound.found, 0.25);
  EXPECT_EQ(bound.point, 5);
  EXPECT_EQ(bound.points, 2);
  EXPECT_EQ(bound.reproduce, "noonmark render x.toml --set 'a=b'");
  const RunInfo a = results.info, b = sample_info();
  EXPECT_EQ(std::tie(a.experiment, a.title, a.command, a.commit, a.version, a.started, a.host_cpu, a.gl_vendor,
                     a.gl_renderer, a.gl_version, a.gl_timer, a.embree_version, a.embree_isa, a.libraries, a.swept,
                     a.plot, a.scene_name, a.triangles, a.scene_notes, a.sweep_notes),
            std::tie(b.experiment, b.title, b.command, b.commit, b.version, b.started, b.host_cpu, b.gl_vendor,
                     b.gl_renderer, b.gl_version, b.gl_timer, b.embree_version, b.embree_isa, b.libraries, b.swept,
                     b.plot, b.scene_name, b.triangles, b.scene_notes, b.sweep_notes));
}

TEST_F(Store, KeepsLawsWithTheirSamples) {
  LawResult other = sample_law(), without = sample_law();
  other.relation = LawRelation::at_least;
  other.held = true;
  other.samples[1].measured = nan_value;
  without.samples.clear();
  without.worst = -1;
  {
    ResultStore store = fresh();
    PointRecord point = sample_point(3);
    point.part = "law 1";
    store.add(point);
    store.set_laws({other});
    store.set_laws({sample_law(), without, other});
  }
  const Results results = ResultStore::open(path).load();
  EXPECT_EQ(results.points.at(0).part, "law 1");
  ASSERT_EQ(results.laws.size(), 3u);
  EXPECT_TRUE(same(results.laws[0], sample_law()));
  EXPECT_TRUE(same(results.laws[1], without));
  EXPECT_TRUE(same(results.laws[2], other));
}

TEST_F(Store, KeepsWhatIsNotFiniteApartFromWhatIsAbsent) {
  PointRecord point = sample_point(0);
  point.metrics = {{"acne", nan_value}, {"error", inf_value}, {"wrong", -inf_value}, {"filter", -0.0}};
  point.times["truth_ms"] = nan_value;
  point.worst.error = nan_value;
  point.curve->acne[3] = nan_value;
  point.curve->error[3] = inf_value;
  point.curve->window_min_depth = nan_value;
  point.curve->best_error = nan_value;
  PointRecord no_window = sample_point(1);
  no_window.curve->window_min_depth = no_window.curve->window_max_depth = std::nullopt;
  {
    ResultStore store = fresh();
    store.add(point);
    store.add(no_window);
    BoundResult bound;
    bound.found = nan_value;
    store.set_bounds({bound});
  }
  const Results results = ResultStore::open(path).load();
  EXPECT_TRUE(same(results.points.at(0), point));
  EXPECT_TRUE(same(results.points.at(1), no_window));
  EXPECT_FALSE(results.points[0].metrics.contains("aliasing"));
  EXPECT_TRUE(std::isnan(results.bounds.at(0).found));
  sqlite::Database db(path, sqlite::Database::Mode::existing);
  EXPECT_EQ(db.ask("SELECT not_measured FROM points WHERE point = 0"), "1");
}

RC_GTEST_PROP(StoreProperty, EveryDoubleComesBack, (const std::vector<uint64_t>& bits)) {
  TemporaryFolder folder;
  PointRecord point;
  for (size_t i = 0; i < bits.size(); ++i) point.metrics["m" + std::to_string(i)] = std::bit_cast<double>(bits[i]);
  ResultStore store(folder.file("r.sqlite"), "x", Existing::resume);
  store.add(point);
  RC_ASSERT(same(store.load().points.at(0), point));
}

TEST_F(Store, ViewHasEveryNumberAsATypedColumn) {
  ResultStore store = fresh();
  const PointRecord point = sample_point(3);
  store.add(point);
  store.add(sample_point(4, false));
  sqlite::Database db(path, sqlite::Database::Mode::existing);
  EXPECT_EQ(
      db.ask("SELECT point FROM points WHERE map_resolution = 2048 AND filter_kind = 'none' AND map_lit_beyond_far"),
      "3");
  EXPECT_EQ(db.ask("SELECT typeof(map_resolution) || typeof(bias_constant) || typeof(map_extent_m) FROM points"),
            "integerrealtext");
  for (const Metric& row : metrics_table()) {
    sqlite::Statement rows(db, "SELECT " + std::string(row.name) + " FROM points WHERE point = 3");
    ASSERT_TRUE(rows.step());
    EXPECT_EQ(rows.real(0), point.metrics.at(std::string(row.name))) << row.name;
  }
  for (const CurveQuantity& row : curve_quantities()) {
    sqlite::Statement rows(db, "SELECT " + std::string(row.name) + " FROM points ORDER BY point");
    ASSERT_TRUE(rows.step());
    EXPECT_EQ(rows.real(0), quantity(point, row.name)) << row.name;
    ASSERT_TRUE(rows.step());
    EXPECT_TRUE(rows.null(0)) << row.name << " of a point without a curve";
  }
  EXPECT_EQ(db.ask("SELECT part || worst_x || '/' || worst_y || worst_cause FROM points WHERE point = 3"), "12/34acne");
  EXPECT_EQ(db.ask("SELECT round(3 * worst_error) FROM points WHERE point = 3"), "2.0");
  for (const RecordField& field : record_fields())
    EXPECT_EQ(
        db.ask(fmt::format("SELECT kind || '/' || unit || '/' || help FROM columns WHERE name = '{}'", field.name)),
        fmt::format("{}/{}/{}", field.group, field.unit, field.help));
  EXPECT_EQ(db.ask("SELECT unit FROM columns WHERE name = 'map_extent_m'"), "m");
  EXPECT_EQ(db.ask("SELECT count(*) FROM pragma_table_info('points')"), db.ask("SELECT count(*) FROM columns"));
}

// Between stores of one version the text of the tables is compared, so it must not change by accident.
TEST_F(Store, KeepsTheTextOfTheTableOfPoints) {
  fresh();
  sqlite::Database db(path, sqlite::Database::Mode::existing);
  EXPECT_EQ(db.ask("SELECT sql FROM sqlite_schema WHERE name = 'finished'"),
            "CREATE TABLE finished (\n  point INTEGER PRIMARY KEY, part TEXT NOT NULL, scene_digest TEXT NOT NULL, "
            "worst_x INTEGER, worst_y INTEGER, worst_error REAL, worst_cause TEXT, delivery_refused TEXT, "
            "delivery_accepted TEXT, delivery_not_checked TEXT, "
            "machine_host TEXT, machine_cpu TEXT, machine_driver TEXT, machine_ray_tracer TEXT, machine_clock TEXT)");
}

TEST_F(Store, ViewAgreesOnAnEmptyWindow) {
  ResultStore store = fresh();
  PointRecord point = sample_point(3);
  point.curve->window_min_depth = point.curve->window_max_depth = std::nullopt;
  store.add(point);
  sqlite::Database db(path, sqlite::Database::Mode::existing);
  for (const CurveQuantity& row : curve_quantities()) {
    sqlite::Statement rows(db, "SELECT " + std::string(row.name) + " FROM points");
    ASSERT_TRUE(rows.step());
    const std::optional<double> value = quantity(point, row.name);
    EXPECT_EQ(rows.null(0), !value.has_value()) << row.name;
    if (value) {
      EXPECT_EQ(rows.real(0), *value) << row.name;
    }
  }
  for (const char* width : {"window_width_depth", "window_width_m", "window_width_texels"})
    EXPECT_EQ(quantity(point, width), 0.0) << width;
}

// A cause that a rung on top of R5 brought comes back with the points that have its metric.
TEST_F(Store, KeepsTheCausesOfRungs) {
  PointRecord point = sample_point(1);
  point.causes = {{"seep", "Seep", "Light that leaks.", {1, 2, 255}, "R6"}, {"a_penumbra", "Width", "x", {}, "R7"}};
  point.metrics["seep"] = 0.25;
  point.metrics["a_penumbra"] = nan_value;
  {
    ResultStore store = fresh();
    store.add(point);
    store.add(sample_point(2));
    store.set_info(sample_info(), 2);
  }
  const Results results = ResultStore::open(path).load();
  ASSERT_EQ(results.points.at(0).causes.size(), 2u);
  const RungCause& leak = results.points[0].causes[0];
  EXPECT_EQ(std::tie(leak.name, leak.label, leak.help, leak.rung),
            std::make_tuple("seep", "Seep", "Light that leaks.", "R6"));
  EXPECT_EQ(leak.color, (std::array<uint8_t, 3>{1, 2, 255}));
  EXPECT_EQ(results.points[0].causes[1].name, "a_penumbra") << "not in the order of the rungs";
  EXPECT_EQ(results.points[0].metrics.at("seep"), 0.25);
  EXPECT_TRUE(results.points.at(1).causes.empty());
  EXPECT_EQ(judged_rung(results.points[0]), "R7");
  EXPECT_EQ(judged_rung(results.points[1]), "R5");

  sqlite::Database db(path, sqlite::Database::Mode::existing);
  db.execute("UPDATE info SET value = '{}' WHERE key = 'cause.seep'");
  seal_info(db);
  EXPECT_EQ(kind_thrown([&] { ResultStore::open(path).load(); }), static_cast<int>(ErrorKind::file));
}

TEST_F(Store, ResumesItsOwnExperimentOnly) {
  fresh().add(sample_point(1));
  EXPECT_EQ(fresh().finished(), std::vector<int64_t>{1});
  const std::string message = refusal("version = 0.1.0\nmap.format = 16\n", ErrorKind::usage);
  EXPECT_NE(message.find("now 'map.format = 16', there 'map.format = 24'"), std::string::npos) << message;
  EXPECT_NE(message.find("--overwrite"), std::string::npos) << message;
  EXPECT_EQ(fresh().finished(), std::vector<int64_t>{1}) << "the refusal changed the store";

  ResultStore anew(path, "other", Existing::overwrite);
  EXPECT_TRUE(anew.finished().empty());
  EXPECT_EQ(anew.fingerprint(), "other");
}

TEST_F(Store, NamesTheDifferenceWhenOneFingerprintBeginsTheOther) {
  fresh();
  EXPECT_NE(refusal(fingerprint + "map.cull = back\n", ErrorKind::usage)
                .find("now 'map.cull = back', there nothing of the kind"),
            std::string::npos);
}

TEST_F(Store, RefusesAPointTwice) {
  ResultStore store = fresh();
  store.add(sample_point(1));
  PointRecord again = sample_point(1);
  again.worst.cause = "changed";
  EXPECT_THROW(store.add(again), Error);
  EXPECT_TRUE(same(store.load().points.at(0), sample_point(1)));
}

TEST_F(Store, AddsAPointWholeOrNotAtAll) {
  ResultStore store = fresh();
  PointRecord torn = sample_point(1);
  torn.curve->acne.pop_back();  // the error is found only after settings and metrics were written
  EXPECT_THROW(store.add(torn), std::logic_error);
  EXPECT_TRUE(store.finished().empty());
  store.add(sample_point(1));
  EXPECT_TRUE(same(store.load().points.at(0), sample_point(1)));
}

TEST_F(Store, ReplacesPictures) {
  ResultStore store = fresh();
  store.add(sample_point(1));
  store.set_pictures(1, {{{"worst", "images/w.png", "The worst.", "01"}}, {{"images/w.exr", "02"}}});
  const Results results = store.load();
  ASSERT_EQ(results.points.at(0).pictures.size(), 1u);
  EXPECT_EQ(results.points[0].pictures[0].path, "images/w.png");
  ASSERT_EQ(results.points[0].images.size(), 1u);
  EXPECT_EQ(results.points[0].images[0].digest, "02");
  EXPECT_THROW(store.set_pictures(7, {}), std::logic_error);
}

TEST_F(Store, AddsMetricsToPoints) {
  ResultStore store = fresh();
  PointRecord expected = sample_point(1);
  store.add(expected);
  const std::map<std::string, double> more{{"map_ms", 7.5}, {"map_low_ms", 7.25}, {"acne", 0.125}};
  store.set_metrics({{1, more}});
  for (const auto& [name, value] : more) expected.metrics[name] = value;
  EXPECT_TRUE(same(store.load().points.at(0), expected)) << "load() also checks the seal";
  EXPECT_THROW(store.set_metrics({{1, {{"acne", 0.5}}}, {7, {}}}), std::logic_error);
  EXPECT_TRUE(same(store.load().points.at(0), expected)) << "all or nothing";
}

TEST_F(Store, RefusesWhatIsNoStore) {
  write_file_atomically(path, std::string(5000, 'x'));
  EXPECT_NE(refusal().find("not a database"), std::string::npos);
  EXPECT_EQ(read_file(path), std::string(5000, 'x')) << "the refusal changed the file";
  ResultStore(path, fingerprint, Existing::overwrite).add(sample_point(1));
  EXPECT_EQ(fresh().finished().size(), 1u);
}

TEST_F(Store, RefusesTheDatabaseOfAnotherProgram) {
  sqlite::Database(path, sqlite::Database::Mode::create).execute("CREATE TABLE t (x)");
  EXPECT_NE(refusal().find("not one of Noonmark's"), std::string::npos);
  EXPECT_THROW(ResultStore::open(path), Error);
}

TEST_F(Store, RefusesAnotherVersionOfItself) {
  fresh();
  sqlite::Database(path, sqlite::Database::Mode::existing).execute("PRAGMA user_version = 99");
  EXPECT_NE(refusal(fingerprint, ErrorKind::usage).find("store version 99"), std::string::npos);
}

TEST_F(Store, RefusesADamagedStore) {
  {
    ResultStore store = fresh();
    for (int id = 0; id < 20; ++id) store.add(sample_point(id));
  }
  std::string bytes = read_file(path);
  for (size_t i = 4096; i < bytes.size(); i += 4096) bytes[i] = '\x55';  // the type of each page except the first
  write_file_atomically(path, bytes);
  EXPECT_NE(refusal().find("--overwrite"), std::string::npos);
}

// Found by fuzzing: the report read a sample at that index, beyond the end of the list.
TEST_F(Store, RefusesALawWhoseWorstSampleIsNoneOfItsSamples) {
  fresh().set_laws({sample_law()});
  for (const char* edit : {"worst = 2", "worst = -2", "worst = 99999999999", "relation = '<>'"}) {
    const std::string kept = read_file(path);
    sqlite::Database(path, sqlite::Database::Mode::existing).execute(std::string("UPDATE laws SET ") + edit);
    EXPECT_THROW(ResultStore::open(path).load(), Error) << edit;
    write_file_atomically(path, kept);
  }
  EXPECT_EQ(ResultStore::open(path).load().laws.size(), 1u);
}

TEST_F(Store, OpensNothingThatIsNotThere) {
  EXPECT_THROW(ResultStore::open(path), Error);
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_THROW(ResultStore(folder.file("absent/results.sqlite"), fingerprint, Existing::resume), Error);
}

// A child process adds points as fast as it can and reports each point after add() has returned. It is killed at
// different moments. The next child continues where the last one was killed.
TEST_F(Store, LosesAtMostThePointInFlightWhenKilled) {
  constexpr int kills = 25;
  int64_t acknowledged = 0;  // points that a child reported as stored
  for (int kill_count = 0; kill_count < kills; ++kill_count) {
    int pipe_ends[2];
    ASSERT_EQ(::pipe(pipe_ends), 0);
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      try {
        ResultStore store(path, fingerprint, Existing::resume);
        for (auto id = static_cast<int64_t>(store.finished().size());; ++id) {
          store.add(sample_point(id));
          if (::write(pipe_ends[1], &id, sizeof id) != sizeof id) ::_exit(1);
        }
      } catch (...) {
        ::_exit(1);
      }
    }
    ::close(pipe_ends[1]);
    int64_t id = -1;
    for (int reports = 0; reports <= kill_count % 3; ++reports) {
      ASSERT_EQ(::read(pipe_ends[0], &id, sizeof id), static_cast<ssize_t>(sizeof id))
          << "the child failed before it was killed";
      acknowledged = id + 1;
    }
    ::usleep(static_cast<useconds_t>(kill_count * 137 % 3000));  // a moment within a transaction
    ::kill(child, SIGKILL);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status)) << "the child failed before it was killed";
    while (::read(pipe_ends[0], &id, sizeof id) == static_cast<ssize_t>(sizeof id)) acknowledged = id + 1;
    ::close(pipe_ends[0]);

    ResultStore store = fresh();
    const Results results = store.load();
    const auto count = static_cast<int64_t>(results.points.size());
    ASSERT_GE(count, acknowledged);
    ASSERT_LE(count, acknowledged + 1) << "only the point whose add() had not returned may be extra";
    for (int64_t i = 0; i < count; ++i) ASSERT_TRUE(same(results.points[static_cast<size_t>(i)], sample_point(i))) << i;
    sqlite::Database db(path, sqlite::Database::Mode::existing);
    ASSERT_EQ(db.ask("PRAGMA integrity_check"), "ok");
  }
}

}  // namespace
}  // namespace noonmark
