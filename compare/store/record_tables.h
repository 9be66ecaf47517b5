// The tables of the store that hold records, each described once (table.h). The other tables hold names and values and
// are described in schema.cpp.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "compare/results/records.h"
#include "compare/store/table.h"

namespace noonmark {

const Table<PointRecord>& finished_table();       // one row per point: the record's own fields (record_fields.h)
const Table<BiasCurve>& curves_table();           // one row per point, without the series
const Table<WindowSteps>& curve_windows_table();  // one row for each curve
const Table<PictureRecord>& pictures_table();     // one row per point and place in the list
const Table<ImageRecord>& images_table();         // the same keys
const Table<PointRecord::WorstOf>& worst_pixels_table();  // the same keys
const Table<PointRecord::Cascade>& cascades_table();      // the same keys
const Table<LookupCurvePoint>& lookup_curves_table();     // the same keys
const Table<CauseBounds>& lookup_bounds_table();          // one row for each point with a lookup curve
const Table<BoundResult>& bounds_table();
const Table<LawResult>& laws_table();  // without the samples
const Table<LawResult::Sample>& law_samples_table();

// The series of a curve: one row for each bias, in the order of the biases.
void add_series(sqlite::Database& db, int64_t point, const BiasCurve& curve);
// Appends the values of one row to the series of a curve. row: all columns of the table curve_points, in the table's order.
void read_series(const sqlite::Statement& row, BiasCurve& curve);

// The SQL that makes all these tables, but finished_table().
std::string record_tables();

// A cause that a rung brought is kept in the table `info`, under the key cause_prefix + its name, as this text. The
// second function throws std::exception if the text does not describe a cause of that name.
inline constexpr std::string_view cause_prefix = "cause.";
std::string text_of_cause(const RungCause& cause);
RungCause cause_of_text(const std::string& name, const std::string& text);

// Paths may have bytes that are not UTF-8. Only those bytes are replaced.
std::string json_text(const nlohmann::json& json);

}  // namespace noonmark
