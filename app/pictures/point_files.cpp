#include "app/pictures/point_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>
#include <type_traits>

#include "app/pictures/image_file.h"
#include "base/build_facts.h"
#include "compare/results/curve_fields.h"
#include "compare/results/quantities.h"
#include "compare/results/record_fields.h"
#include "scenes/camera_frame.h"
#include "technique/map_address.h"
#include "technique/setting_json.h"

namespace noonmark {
namespace {

template <class T, class Get>
Image<float> channel_of(const Image<T>& source, const Get& get) {
  Image<float> values(source.width, source.height);
  for (size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(get(source[i]));
  return values;
}

// Calls visit(i, texel) for every pixel that shows a surface and is looked up in this map, with the texel that its middle
// tap reads (for a box the tap at P); {-1, -1} for the border.
void each_read(const Measurement& m, const MeasuredMap& map, const auto& visit) {
  for (size_t i = 0; i < m.receivers.primitive.size(); ++i)
    if (m.receivers.primitive[i] != no_primitive && &m.map_of(i) == &map)
      visit(i, wrapped(map.probe.middle_texel(i), map.technique.frame.map_size(), map.technique.settings.map.wrap));
}

// The stored map at these texels. Unlike MeasuredMap::stored, it has those of receivers that do not face the light too.
MapDepths stored_where_read(const Measurement& m, const MeasuredMap& of) {
  const auto texels = std::make_shared<TexelSet>(of.technique.frame.map_size());
  each_read(m, of, [&](size_t, glm::ivec2 read) {
    if (read.x >= 0) texels->add(read);
  });
  texels->close();
  MapDepths map(texels, MapDepths::unknown);
  constexpr int band = 256;  // rows
  for (int first = 0; first < map.size().y; first += band) {
    const Image<float> rows = of.stored_rows(first, std::min(band, map.size().y - first));
    for (int row = 0; row < rows.height; ++row)
      texels->each_in_row(first + row, [&](int x, size_t index) { map.depth[index] = rows.at(x, row); });
  }
  return map;
}

// The depth that the middle tap reads in depths_of(map). NaN where there is no receiver.
Image<float> depth_read(const Measurement& m, const auto& depths_of) {
  Image<float> values(m.receivers.width(), m.receivers.height(), std::numeric_limits<float>::quiet_NaN());
  for (const MeasuredMap& map : m.maps) {
    const MapDepths& depths = depths_of(map);
    each_read(m, map, [&](size_t i, glm::ivec2 read) { values[i] = read.x < 0 ? border_depth : depths.at(read); });
  }
  return values;
}

// The stored and the exact map, with the highest v on top. Of cascades the maps one above the other, the nearest at the
// bottom. NaN where there is no depth: in the exact map at the texels that no receiver's tap reads, and beside a map that is narrower
// than another one.
LargeImage map_image(const Measurement& m) {
  glm::ivec2 size(0);
  std::vector<int> bottom;  // the first row of each map
  for (const MeasuredMap& map : m.maps) {
    bottom.push_back(size.y);
    size = {std::max(size.x, map.technique.frame.map_size().x), size.y + map.technique.frame.map_size().y};
  }
  const auto copy = [&m, bottom, size](int first, int count, float* pixels) {
    for (int y = 0; y < count;) {
      // The rows from here down that are of one map.
      const int row = size.y - 1 - first - y;
      const size_t k = static_cast<size_t>(std::upper_bound(bottom.begin(), bottom.end(), row) - bottom.begin()) - 1;
      const MeasuredMap& map = m.maps[k];
      const int top = row - bottom[k], rows = std::min(top + 1, count - y);
      const Image<float> stored = map.stored_rows(top + 1 - rows, rows);
      for (int down = 0; down < rows; ++down) {
        std::fill_n(pixels, 2 * size.x, MapDepths::unknown);
        for (int x = 0; x < stored.width; ++x) pixels[2 * x] = stored.at(x, rows - 1 - down);
        map.exact.texels->each_in_row(top - down, [&](int x, size_t at) { pixels[2 * x + 1] = map.exact[at]; });
        pixels += 2 * size.x;
      }
      y += rows;
    }
  };
  return {{"depth.stored", "depth.exact"}, size.x, size.y, copy};
}

nlohmann::json vector_json(glm::dvec3 v) { return {v.x, v.y, v.z}; }

nlohmann::json fact_json(double value) { return value; }
nlohmann::json fact_json(std::string_view value) { return value; }
nlohmann::json fact_json(glm::dvec2 v) { return {v.x, v.y}; }
nlohmann::json fact_json(glm::dvec3 v) { return vector_json(v); }

nlohmann::json matrix_rows(const glm::dmat4& matrix) {
  nlohmann::json rows;
  for (int row = 0; row < 4; ++row) rows.push_back({matrix[0][row], matrix[1][row], matrix[2][row], matrix[3][row]});
  return rows;
}

nlohmann::ordered_json light_json(const Measurement& m, const LightFrame& f);

// One entry for each cascade: its slice of the view, its numbers, and its map. Row y of the picture map.exr is row
// height - 1 - y of the maps, which stand one above the other with the nearest cascade at the bottom.
nlohmann::ordered_json cascades_json(const Measurement& m) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (size_t k = 0; k < m.maps.size(); ++k) {
    const PointRecord::Cascade& cascade = m.record.cascades[k];
    nlohmann::ordered_json one = {{"begin_m", cascade.begin_m}, {"end_m", cascade.end_m}};
    one["bias_needed"] = nullptr;
    if (cascade.bias_needed) one["bias_needed"] = *cascade.bias_needed;
    for (const auto& [name, value] : cascade.metrics) one["metrics"][name] = number_json(value);
    one["light"] = light_json(m, m.maps[k].technique.frame);
    all.push_back(std::move(one));
  }
  return all;
}

nlohmann::json curve_json(const BiasCurve& curve) {
  nlohmann::json json;
  for (const CurveField& field : curve_fields()) json[field.name] = nullptr;  // stays null if the curve has no value
  each_field(curve, [&](std::string_view name, const auto& value) {
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, double>)
      json[name] = number_json(value);
    else
      json[name] = value;
  });
  for (const CurveSeries& series : curve_series()) json[series.name] = series.of(curve);
  return json;
}

nlohmann::ordered_json light_json(const Measurement& m, const LightFrame& f) {
  const Light light = effective_light(m.scene, m.technique.settings);
  nlohmann::ordered_json json = {{"kind", f.light().name()},
                                 {"origin_m", vector_json(f.to_world({f.centre_m, 0}))},
                                 {"right", vector_json(f.right)},
                                 {"up", vector_json(f.up)},
                                 {"forward", vector_json(f.forward)}};
  for (const LightFact& fact : f.light().facts(f, light))
    std::visit([&](const auto& value) { json[fact.name] = fact_json(value); }, fact.value);
  json["near_m"] = f.near_m;
  json["far_m"] = f.far_m;
  constexpr const char* depths[] = {// in the order of TileDepth
                                    "(z - near_m) / (far_m - near_m), z along forward",
                                    "far_m * (z - near_m) / (z * (far_m - near_m)), z along forward",
                                    "distance / far_m"};
  json["depth"] = depths[static_cast<size_t>(f.tile(0).depth)];
  json["resolution"] = f.resolution;
  json["faces"] = f.tiles;
  json["map"] = {
      {"width", f.map_size().x},
      {"height", f.map_size().y},
      {"rows", m.maps.size() > 1 ? "map.exr has the maps of all cascades from the bottom up, the nearest at the "
                                   "bottom, each with its highest v on top"
               : f.tiles == 1    ? "map.exr has the map's highest v on top"
                                 : "map.exr has the faces +X -X +Y -Y +Z -Z from the bottom up, each with its "
                                   "highest t on top: row y of map.exr is row height - 1 - y of the map, and "
                                   "row j of face f is the map's row f * resolution + j"}};
  if (f.tiles == 1) {
    json["clip_from_world_rows"] = matrix_rows(f.clip_from_world(0));
    return json;
  }
  nlohmann::ordered_json faces = nlohmann::ordered_json::array();
  for (int face = 0; face < f.tiles; ++face)
    faces.push_back(nlohmann::ordered_json(matrix_rows(f.clip_from_world(face))));
  json["clip_from_world_rows_of_faces"] = faces;
  return json;
}

// Appended as text, because scene.mesh = tiles makes each triangle a part, and a part as a JSON value takes 400 bytes
// in memory.
void append_parts(const std::vector<Part>& parts, size_t text_after, std::string& text) {
  constexpr size_t most_of_part = 100;  // with numbers of ten digits, without the name
  size_t size = text.size() + text_after + 64;
  for (const Part& part : parts) size += most_of_part + part.name.size();
  text.reserve(size);
  if (parts.empty()) return;
  text += ",\n  \"parts\": [";
  const char* before = "\n";
  for (const Part& part : parts) {
    fmt::format_to(std::back_inserter(text),
                   "{}    {{\n      \"name\": {},\n      \"first_primitive\": {},\n      \"primitives\": {}\n    }}",
                   before, readable_json(part.name), part.first_triangle, part.triangle_count);
    before = ",\n";
  }
  text += "\n  ]";
}

}  // namespace

Image<float> stored_depths(const Measurement& m) {
  return depth_read(m, [&](const MeasuredMap& map) { return stored_where_read(m, map); });
}

std::vector<ImageRecord> write_images(const Measurement& m, const std::string& folder, const std::string& relative,
                                      const std::string& prefix) {
  std::vector<ImageRecord> records;
  const auto write = [&](const std::string& name, const auto& image) {
    const std::string digest = write_exr(folder + "/" + prefix + name, image);
    records.push_back({relative + "/" + prefix + name, digest});
  };
  std::vector<Channel> channels;
  const auto add = [&](std::string name, Image<float> values) {
    channels.push_back({std::move(name), std::move(values)});
  };
  for (int axis = 0; axis < 3; ++axis) {
    add(fmt::format("P.{}", "XYZ"[axis]),
        channel_of(m.receivers.position, [&](const glm::vec3& p) { return p[axis]; }));
    add(fmt::format("N.{}", "XYZ"[axis]), channel_of(m.receivers.normal, [&](const glm::vec3& n) { return n[axis]; }));
  }
  // A float holds an index exactly up to 2^24. -1 where there is no surface.
  add("primitive", channel_of(m.receivers.primitive, [](uint32_t p) { return p == no_primitive ? -1.0 : p; }));
  for (const Ladder::RungImage& rung : m.ladder.rungs) add(rung.name, rung.lit);
  Image<float> reference = m.map().probe.reference;
  for (size_t i = 0; i < m.choice.of.size(); ++i)
    if (m.receivers.primitive[i] != no_primitive) reference[i] = m.map_of(i).probe.reference[i];
  add("depth.reference", std::move(reference));
  add("depth.stored", stored_depths(m));
  add("depth.exact", depth_read(m, [](const MeasuredMap& map) -> const MapDepths& { return map.exact; }));
  if (m.maps.size() > 1) add("cascade", channel_of(m.choice.of, [](uint8_t c) { return c == no_map ? -1 : c; }));
  if (m.choice.blends()) add("cascade_next", channel_of(m.choice.next, [](float share) { return share; }));
  add("cause", channel_of(m.ladder.cause, [](uint8_t c) { return c; }));
  add("flags", channel_of(m.ladder.flags, [](uint8_t f) { return f; }));
  for (size_t c = 1; c < m.ladder.causes.size(); ++c)
    add(fmt::format("step.{}", m.ladder.causes[c].name), m.ladder.causes[c].step);
  write("ladder.exr", channels);
  channels.clear();
  write("map.exr", map_image(m));
  return records;
}

namespace {

nlohmann::ordered_json lookup_curve_json(const LookupCurvePoint& at) {
  return {{"parameter", at.parameter},
          {"value", at.value},
          {"error", at.error},
          {"leak", at.leak},
          {"over_darkening", at.over_darkening},
          {"peter_panning", at.peter_panning},
          {"reduction", at.reduction},
          {"aliasing_dark", at.aliasing_dark},
          {"aliasing_light", at.aliasing_light},
          {"coverage", at.coverage},
          {"shown_error", at.shown_error},
          {"shown_error_soft", at.shown_error_soft}};
}

}  // namespace

std::string point_json(const Measurement& m, const std::string& command) {
  nlohmann::ordered_json json;
  json["noonmark"] = {{"version", build_facts().version}, {"commit", build_facts().commit}};
  json["command"] = command;
  json["scene"] = {{"name", m.scene.name},
                   {"triangles", m.scene.triangles.size()},
                   {"vertices", m.scene.positions.size()},
                   {"notes", m.scene.notes}};
  for (const Setting& row : settings_table())
    json["settings"][std::string(row.name)] = setting_json(row, row.get(m.technique.settings));
  for (const Metric& metric : metrics_of({&m.record, 1})) {
    const auto found = m.record.metrics.find(std::string(metric.name));
    if (found != m.record.metrics.end()) json["metrics"][std::string(metric.name)] = number_json(found->second);
  }
  for (const auto& [name, value] : m.record.times) json["times"][name] = number_json(value);
  for (const RecordField& field : record_fields())
    if (!field.group.empty() && field.group != delivery_group)
      json[std::string(field.group)][std::string(field.key())] =
          with_value(field, m.record, [](const auto& value) -> nlohmann::json {
            if constexpr (std::is_same_v<std::decay_t<decltype(value)>, double>)
              return number_json(value);
            else
              return value;
          });

  const CameraFrame camera = make_camera_frame(m.camera, m.receivers.width(), m.receivers.height());
  json["camera"] = {{"projection", m.camera.projection == Projection::perspective ? "perspective" : "orthographic"},
                    {"eye_m", vector_json(camera.eye_m)},
                    {"right", vector_json(camera.right)},
                    {"up", vector_json(camera.up)},
                    {"forward", vector_json(camera.forward)},
                    {"half_width", camera.half_width},
                    {"half_height", camera.half_height},
                    {"near_m", m.camera.near_m.value()},
                    {"far_m", m.camera.far_m.value()},
                    {"clip_from_world_rows", matrix_rows(camera.clip_from_world())}};
  if (m.maps.size() == 1)
    json["light"] = light_json(m, m.technique.frame);
  else
    json["cascades"] = cascades_json(m);
  json["primitive"] =
      "index of the triangle, counted from 0 in the order in which the scene's parts are drawn; of a file, triangles "
      "without an area are left out before counting (scene.notes says how many); -1 where there is no surface";
  std::string text = readable_json(json);
  json.clear();
  for (const Ladder::CauseImage& cause : m.ladder.causes) json["causes"].push_back(cause.name);
  if (!m.ladder.brought.empty()) {
    for (const Ladder::RungImage& rung : m.ladder.rungs) json["rungs"].push_back(rung.name);
    for (const RungCause& cause : m.ladder.brought)
      json["rungs_on_top"].push_back({{"name", cause.rung},
                                      {"cause", cause.name},
                                      {"label", cause.label},
                                      {"help", cause.help},
                                      {"color", cause.color}});
  }
  json["flags"] = {
      {"facing", flag_facing}, {"outside", flag_outside}, {"ambiguous", flag_ambiguous}, {"undecided", flag_undecided}};
  if (m.record.curve) json["bias_curve"] = curve_json(*m.record.curve);
  for (const LookupCurvePoint& at : m.record.lookup_curve) json["lookup_curve"].push_back(lookup_curve_json(at));
  for (const LookupCurvePoint& at : m.record.over_curve) json["over_curve"].push_back(lookup_curve_json(at));
  const std::string rest = readable_json(json);
  text.resize(text.size() - std::string_view("\n}").size());  // the object continues
  append_parts(m.scene.parts, rest.size(), text);
  text += ',';
  text.append(rest, 1);  // without the opening brace
  text += '\n';
  return text;
}

}  // namespace noonmark
