#include "compare/store/record_tables.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "compare/results/curve_fields.h"
#include "compare/results/quantities.h"
#include "compare/results/record_fields.h"

namespace noonmark {
namespace {

using sqlite::Database;
using sqlite::Statement;

std::vector<Column<BiasCurve>> curve_columns() {
  std::vector<Column<BiasCurve>> columns;
  for (const CurveField& field : curve_fields())
    std::visit([&](auto member) { columns.push_back(column(field.name, member)); }, field.member);
  return columns;
}

// The column of a member of the record itself. Every row has it.
template <class Member>
Column<PointRecord> record_column(std::string_view name, Member PointRecord::*member) {
  Column<PointRecord> made = column(name, member);
  static_assert(std::is_same_v<Member, std::string>);
  made.type = "TEXT NOT NULL";
  return made;
}
// The column of a member of a struct of the record.
template <class Part, class Member>
Column<PointRecord> record_column(std::string_view name, Member Part::*member) {
  const Column<Part> inner = column(name, member);
  return {name, inner.type,
          [=](Statement& row, int index, const PointRecord& record) { inner.bind(row, index, owner(record, member)); },
          [=](const Statement& row, int index, PointRecord& record) { inner.read(row, index, owner(record, member)); }};
}

std::vector<Column<PointRecord>> record_columns() {
  std::vector<Column<PointRecord>> columns;
  for (const RecordField& field : record_fields())
    std::visit([&](auto member) { columns.push_back(record_column(field.name, member)); }, field.member);
  return columns;
}

constexpr std::pair<LawRelation, std::string_view> relations[] = {
    {LawRelation::equal, "="}, {LawRelation::at_most, "<="}, {LawRelation::at_least, ">="}};

const Column<LawResult> relation_column = {"relation", "TEXT",
                                           [](Statement& row, int index, const LawResult& law) {
                                             for (const auto& [relation, text] : relations)
                                               if (relation == law.relation) row.bind(index, text);
                                           },
                                           [](const Statement& row, int index, LawResult& law) {
                                             const std::string sign = row.text(index);
                                             const auto found = std::find_if(
                                                 std::begin(relations), std::end(relations),
                                                 [&](const auto& relation) { return relation.second == sign; });
                                             if (found == std::end(relations))
                                               throw std::runtime_error("a law with an unknown relation");
                                             law.relation = found->first;
                                           }};

const Column<BoundResult> where_column = {
    "where_json", "TEXT",
    [](Statement& row, int index, const BoundResult& bound) { row.bind(index, json_text(bound.where)); },
    [](const Statement& row, int index, BoundResult& bound) {
      bound.where = nlohmann::json::parse(row.text(index)).get<std::map<std::string, std::vector<std::string>>>();
    }};

using StepsMember = WindowSteps::Steps WindowSteps::*;
Column<WindowSteps> steps_column(std::string_view name, StepsMember member) {
  return {name, "BLOB",
          [member](Statement& row, int index, const WindowSteps& steps) {
            row.bind_bytes(index, bytes_of_steps(steps.*member));
          },
          [member](const Statement& row, int index, WindowSteps& steps) {
            steps.*member = steps_of_bytes(row.text(index));
          }};
}

std::string series_names() {
  std::string names;
  for (const CurveSeries& series : curve_series()) names += fmt::format(", {}", series.name);
  return names;
}

}  // namespace

std::string json_text(const nlohmann::json& json) {
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

const Table<PointRecord>& finished_table() {
  static const Table<PointRecord> table("finished", {"point"}, record_columns());
  return table;
}

const Table<BiasCurve>& curves_table() {
  static const Table<BiasCurve> table("curves", {"point"}, curve_columns());
  return table;
}

const Table<WindowSteps>& curve_windows_table() {
  using W = WindowSteps;
  static const Table<W> table(
      "curve_windows", {"point"},
      {column("most_share", &W::most_share), column("taps", &W::taps), column("unit_depth", &W::unit_depth),
       steps_column("acne", &W::acne), steps_column("peter_panning", &W::peter_panning),
       steps_column("acne_worst", &W::acne_worst), steps_column("peter_panning_worst", &W::peter_panning_worst)});
  return table;
}

const Table<PictureRecord>& pictures_table() {
  using P = PictureRecord;
  static const Table<P> table("pictures", {"point", "i"},
                              {column("name", &P::name), column("path", &P::path), column("caption", &P::caption),
                               column("digest", &P::digest)});
  return table;
}

const Table<ImageRecord>& images_table() {
  static const Table<ImageRecord> table("images", {"point", "i"},
                                        {column("path", &ImageRecord::path), column("digest", &ImageRecord::digest)});
  return table;
}

const Table<PointRecord::WorstOf>& worst_pixels_table() {
  using W = PointRecord::WorstOf;
  static const Table<W> table(
      "worst_pixels", {"point", "i"},
      {column("metric", &W::metric), column("x", &W::x), column("y", &W::y), column("size", &W::size)});
  return table;
}

const Table<PointRecord::Cascade>& cascades_table() {
  using C = PointRecord::Cascade;
  static const Table<C> table = [] {
    std::vector<Column<C>> columns = {column("begin_m", &C::begin_m), column("end_m", &C::end_m),
                                      column("bias_needed", &C::bias_needed)};
    for (const char* metric : cascade_metrics)
      columns.push_back({metric, "REAL",
                         [metric](Statement& row, int index, const C& one) { row.bind(index, one.metrics.at(metric)); },
                         [metric](const Statement& row, int index, C& one) { one.metrics[metric] = row.real(index); }});
    return Table<C>("cascades", {"point", "i"}, std::move(columns));
  }();
  return table;
}

const Table<LookupCurvePoint>& lookup_curves_table() {
  using L = LookupCurvePoint;
  static const Table<L> table(
      "lookup_curves", {"point", "i"},
      {column("parameter", &L::parameter), column("value", &L::value), column("error", &L::error),
       column("leak", &L::leak), column("over_darkening", &L::over_darkening),
       column("peter_panning", &L::peter_panning), column("reduction", &L::reduction),
       column("aliasing_dark", &L::aliasing_dark), column("aliasing_light", &L::aliasing_light),
       column("coverage", &L::coverage), column("shown_error", &L::shown_error),
       column("shown_error_soft", &L::shown_error_soft)});
  return table;
}

const Table<CauseBounds>& lookup_bounds_table() {
  using B = CauseBounds;
  static const Table<B> table(
      "lookup_bounds", {"point"},
      {column("acne_bound", &B::acne_bound), column("peter_panning_bound", &B::peter_panning_bound)});
  return table;
}

const Table<BoundResult>& bounds_table() {
  using B = BoundResult;
  static const Table<B> table(
      "bounds", {"i"},
      {column("part", &B::part), column("metric", &B::metric), column("max", &B::max), column("min", &B::min),
       where_column, column("join_by", &B::join), column("placement", &B::placement), column("held", &B::held),
       column("found", &B::found), column("point", &B::point), column("points", &B::points),
       column("reproduce", &B::reproduce), column("warns", &B::warns), column("before", &B::before)});
  return table;
}

const Table<LawResult>& laws_table() {
  using L = LawResult;
  static const Table<L> table(
      "laws", {"i"},
      {column("part", &L::part), column("name", &L::name), column("says", &L::says), column("measured", &L::measured),
       relation_column, column("predicted", &L::predicted), column("tolerance", &L::tolerance),
       column("join_by", &L::join), column("held", &L::held), column("worst", &L::worst),
       column("reproduce", &L::reproduce), column("found", &L::found)});
  return table;
}

const Table<LawResult::Sample>& law_samples_table() {
  using S = LawResult::Sample;
  static const Table<S> table("law_samples", {"law", "i"},
                              {column("point", &S::point), column("predicted", &S::predicted),
                               column("measured", &S::measured), column("allowed", &S::allowed)});
  return table;
}

static bool is_absent(const CurveSeries& series, const BiasCurve& curve) {
  return series.of_placements() && curve.placements == 0;
}

void add_series(Database& db, int64_t point, const BiasCurve& curve) {
  const size_t count = curve.bias_depth.size();
  std::string values = "?, ?";
  for (const CurveSeries& series : curve_series()) {
    if (series.of(curve).size() != (is_absent(series, curve) ? 0 : count))
      throw std::logic_error("a series of a bias curve has another length than its biases");
    values += ", ?";
  }
  Statement insert(db, fmt::format("INSERT INTO curve_points (point, i{}) VALUES ({})", series_names(), values));
  for (size_t i = 0; i < count; ++i) {
    int index = 2;
    for (const CurveSeries& series : curve_series())
      insert.bind(++index, is_absent(series, curve) ? std::nullopt : std::optional(series.of(curve)[i]));
    insert.run(point, static_cast<int64_t>(i));
  }
}

void read_series(const Statement& row, BiasCurve& curve) {
  int index = 2;  // after the point and the place
  for (const CurveSeries& series : curve_series()) {
    if (!is_absent(series, curve)) series.of(curve).push_back(row.real(index));
    ++index;
  }
}

std::string text_of_cause(const RungCause& cause) {
  return json_text({{"label", cause.label}, {"help", cause.help}, {"color", cause.color}, {"rung", cause.rung}});
}

RungCause cause_of_text(const std::string& name, const std::string& text) {
  if (!is_free_name(name)) throw std::runtime_error("a cause with the name " + name);
  const nlohmann::json json = nlohmann::json::parse(text);
  const auto of = [&](const char* key) { return json.at(key).get<std::string>(); };
  return {name, of("label"), of("help"), json.at("color").get<std::array<uint8_t, 3>>(), of("rung")};
}

std::string record_tables() {
  std::string series = "CREATE TABLE curve_points (point INTEGER, i INTEGER";
  for (const CurveSeries& one : curve_series()) series += fmt::format(", {} REAL", one.name);
  series += ", PRIMARY KEY (point, i)) WITHOUT ROWID;\n";
  return curves_table().create() + series + curve_windows_table().create() + pictures_table().create() +
         images_table().create() + worst_pixels_table().create() + cascades_table().create() +
         lookup_curves_table().create() + lookup_bounds_table().create() + bounds_table().create() +
         laws_table().create() + law_samples_table().create();
}

}  // namespace noonmark
