// The pictures for human readers: maps, frusta and shaded frames.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "app/pictures/view_colors.h"
#include "app/pictures/view_frustum.h"
#include "app/pictures/view_map.h"
#include "compare/ladder/flip.h"
#include "measure/view_shading.h"
#include "scenes/library.h"

namespace noonmark {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

LightFrame frame_of(const std::string& scene, LightChoice kind = LightChoice::automatic, int resolution = 64) {
  Settings settings;
  settings.map.resolution = resolution;
  settings.light.kind = kind;
  return make_light_frame(make_scene({.name = scene}), settings);
}

// --- the map ---

TEST(DepthOfWindow, UndoesWindowDepth) {
  for (const char* scene : {"wall", "spot-room", "point-room"}) {
    const LightFrame f = frame_of(scene);
    for (double t : {0.0, 0.1, 0.5, 0.999, 1.0}) {
      const double depth = f.near_m + t * (f.far_m - f.near_m);
      // The window depths of a spot light are close to 1. The digits that a double has left there are still 1e-12 m.
      EXPECT_NEAR(f.tile(0).depth_of_window(f.tile(0).window_depth(depth)), depth, 1e-11) << scene;
    }
  }
}

// A value for every direction, with a gradient of length at most 1 on the unit sphere and no symmetry.
float smooth(glm::dvec3 direction) {
  return static_cast<float>(glm::dot(glm::normalize(direction), glm::normalize(glm::dvec3(0.5, -0.3, 0.8))));
}

// Rows of a whole image.
Image<Color> picture_of(const MapRows& rows, const LightFrame& frame) {
  const StoredMap map{rows, frame};
  return map_picture({&map, 1});
}

MapRows rows_of(const Image<float>& map) {
  return [&map](int first, int count) {
    Image<float> rows(map.width, count);
    std::copy_n(&map.at(0, first), rows.size(), rows.pixels.begin());
    return rows;
  };
}

Image<float> cube_of(const LightFrame& f, float (*value)(glm::dvec3)) {
  const glm::ivec2 size = f.map_size();
  Image<float> map(size.x, size.y);
  for (int j = 0; j < size.y; ++j)
    for (int i = 0; i < size.x; ++i) map.at(i, j) = value(f.texel_place({i, j}));
  return map;
}

TEST(CubeCross, NeighboursJoinWithoutASeam) {
  const int n = 64;
  const LightFrame f = frame_of("point-room", LightChoice::point, n);
  const float outside = 9;
  const Image<float> cross = cube_cross(rows_of(cube_of(f, smooth)), n, 512, outside);
  ASSERT_EQ(cross.width, 4 * n);
  ASSERT_EQ(cross.height, 3 * n);
  // Seen from the light, neighbouring texel centres are at most 2 / n apart, also across seams. The gradient is at most
  // 1.
  const float texel_step = 2.0f / n;
  int joined = 0, cells = 0;
  for (int y = 0; y < cross.height; ++y)
    for (int x = 0; x < cross.width; ++x) {
      if (cross.at(x, y) == outside) continue;
      ++cells;
      for (const auto& [u, v] : {std::pair{x + 1, y}, {x, y + 1}}) {
        if (u >= cross.width || v >= cross.height || cross.at(u, v) == outside) continue;
        ASSERT_LT(std::abs(cross.at(u, v) - cross.at(x, y)), texel_step) << x << ' ' << y << " to " << u << ' ' << v;
        joined += u % n == 0 && u != x;
        joined += v % n == 0 && v != y;
      }
    }
  EXPECT_EQ(cells, 6 * n * n);
  EXPECT_EQ(joined, 5 * n);  // three seams in the middle row, one above and one below
}

TEST(CubeCross, FacesAreWhereTheHeadOfTheFileSays) {
  const int n = 31;  // odd: a texel's centre is on the axis
  const LightFrame f = frame_of("point-room", LightChoice::point, n);
  const glm::dvec3 axes[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  const glm::ivec2 cells[] = {{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {3, 1}};
  const Image<float> cross = cube_cross(rows_of(cube_of(f, smooth)), n, n, 9);
  for (int face = 0; face < 6; ++face)
    EXPECT_NEAR(cross.at(cells[face].x * n + n / 2, cells[face].y * n + n / 2), smooth(axes[face]), 1e-6) << face;
  // The cross shows +Z with +X on the right and +Y at the top.
  EXPECT_NEAR(cross.at(2 * n - 1, n + n / 2), smooth({1 - 1.0 / n, 0, 1}), 1e-6);
  EXPECT_NEAR(cross.at(n + n / 2, n), smooth({0, 1 - 1.0 / n, 1}), 1e-6);
}

TEST(CubeCross, ShrinkingKeepsTheNearest) {
  const int n = 64;
  Image<float> map(n, 6 * n, 1);
  map.at(63, 4 * n + 63) = 0.25f;  // face +Z: s is +X and t is -Y, so this is the lower right corner of the middle cell
  const Image<float> cross = cube_cross(rows_of(map), n, 10, 9);
  ASSERT_EQ(cross.width, 40);
  for (int y = 0; y < cross.height; ++y)
    for (int x = 0; x < cross.width; ++x)
      if (cross.at(x, y) != 9) {
        EXPECT_EQ(cross.at(x, y), x == 19 && y == 19 ? 0.25f : 1.0f) << x << ' ' << y;
      }
}

TEST(MapPicture, IsLinearInMetresAndStandsUpright) {
  for (const char* scene : {"wall", "spot-room"}) {
    const LightFrame f = frame_of(scene, LightChoice::automatic, 4);
    Image<float> map(4, 4, 1);
    const auto stored = [&](double t) {
      return static_cast<float>(f.tile(0).window_depth(f.near_m + t * (f.far_m - f.near_m)));
    };
    map.at(0, 0) = stored(0.1);  // row 0 of a map has the lowest v, so this is the lower left corner of the picture
    map.at(1, 0) = stored(0.5);
    map.at(2, 0) = stored(0.9);
    map.at(3, 3) = nan;
    const Image<Color> picture = picture_of(rows_of(map), f);
    ASSERT_EQ(picture.width, 4);
    EXPECT_EQ(picture.at(0, 3), depth_grey(0));
    EXPECT_NEAR(picture.at(1, 3).r, (depth_grey(0).r + depth_grey(1).r) / 2, 1) << scene;  // halfway in metres
    EXPECT_EQ(picture.at(2, 3), depth_grey(1));
    EXPECT_EQ(picture.at(3, 0), Color(0)) << "NaN is black";
    EXPECT_EQ(picture.at(1, 1), named_color("background"));
  }
}

TEST(MapPicture, OfALargeMapIsShrunkWithoutLosingAnything) {
  const LightFrame f = frame_of("wall", LightChoice::automatic, 1500);
  Image<float> map(1500, 1500, 1);
  map.at(1499, 0) = 0.5f;
  map.at(700, 700) = 0.25f;
  const Image<Color> picture = picture_of(rows_of(map), f);
  EXPECT_EQ(picture.width, 1024);
  EXPECT_EQ(picture.at(1023, 1023), depth_grey(1));
  int bright = 0;
  for (const Color& c : picture.pixels) bright += c == depth_grey(0);
  EXPECT_EQ(bright, 1);
}

TEST(MapPicture, OfAPointLightIsTheCross) {
  const LightFrame f = frame_of("point-room", LightChoice::point, 16);
  const Image<Color> picture = picture_of(rows_of(Image<float>(16, 96, 0.25f)), f);
  EXPECT_EQ(picture.width, 64);
  EXPECT_EQ(picture.height, 48);
  EXPECT_EQ(picture.at(20, 20), depth_grey(0));
  EXPECT_EQ(picture.at(0, 0), paper);
}

// --- the clay ---

TEST(Clay, TheBrightestIsWhiteAndNothingIsBeyond) {
  const glm::dvec3 up(0, 1, 0);
  EXPECT_NEAR(Clay::ambient * Clay::albedo + clay_response(up, up, up), 1, 1e-12);
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 1000; ++i) {
    const auto direction = [&] { return glm::normalize(glm::dvec3(normal(random), normal(random), normal(random))); };
    const double r = clay_response(direction(), direction(), direction());
    EXPECT_TRUE(r >= 0 && r <= 0.895 + 1e-12) << r;
  }
}

TEST(Clay, IsBlinnPhong) {
  const double a = 0.4;
  const glm::dvec3 up(0, 1, 0), light(std::sin(a), std::cos(a), 0);
  const glm::dvec3 mirrored(-light.x, light.y, 0);
  EXPECT_NEAR(clay_response(up, light, mirrored), 0.7 * std::cos(a) + 0.195, 1e-12);
  // If the eye is at the light, the half vector is at the angle a to N.
  EXPECT_NEAR(clay_response(up, light, light), 0.7 * std::cos(a) + 0.195 * std::pow(std::cos(a), 64), 1e-12);
  EXPECT_EQ(clay_response(up, {0, -1, 0}, up), 0);
  EXPECT_EQ(clay_response(up, {1, 0, 0}, up), 0);
  EXPECT_TRUE(std::isfinite(clay_response(up, light, -light)));
}

ReceiverImage floor_receivers(int width, int height, const CameraFrame& camera, double y) {
  ReceiverImage r{Image<glm::vec3>(width, height, glm::vec3(0)), Image<glm::vec3>(width, height, glm::vec3(0, 1, 0)),
                  Image<uint32_t>(width, height, no_primitive)};
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      const Ray ray = camera.pixel_ray(u, v, width, height);
      const double t = (y - ray.origin.y) / ray.direction.y;
      if (!(t > 0)) continue;
      r.position.at(u, v) = glm::vec3(ray.origin + t * ray.direction);
      r.primitive.at(u, v) = 0;
    }
  return r;
}

TEST(ShadedFrame, DarkensDiffuseAndSpecularOnly) {
  const Scene scene = make_scene({.name = "plane"});
  const CameraFrame camera = make_camera_frame({.eye_m = {0, 5, 5}, .target_m = {0, 0, 0}}, 8, 8);
  for (const LightChoice kind : {LightChoice::directional, LightChoice::spot, LightChoice::point}) {
    Settings settings;
    settings.light.kind = kind;
    const LightFrame light = make_light_frame(scene, settings);
    ReceiverImage floor = floor_receivers(8, 8, camera, 0);
    floor.primitive.at(0, 0) = no_primitive;
    Image<float> visibility(8, 8, 1);
    visibility.at(1, 4) = 0;
    visibility.at(2, 4) = 0.25f;
    visibility.at(3, 4) = nan;
    const Image<float> frame = shaded_frame(floor, light, camera, visibility);
    EXPECT_EQ(frame.at(0, 0), 0);
    EXPECT_FLOAT_EQ(frame.at(1, 4), 0.105f);
    const glm::dvec3 p(floor.position.at(2, 4));
    const double full = clay_response({0, 1, 0}, light.direction_to_light(p), glm::normalize(camera.eye_m - p));
    EXPECT_GT(full, 0.3);
    EXPECT_NEAR(frame.at(2, 4), 0.105 + 0.25 * full, 1e-6);
    EXPECT_TRUE(std::isnan(frame.at(3, 4)));
  }
}

TEST(ShadedFlip, ComparesTheFramesAsTheyAreShown) {
  const Scene scene = make_scene({.name = "plane"});
  const LightFrame light = make_light_frame(scene, {});
  const CameraFrame camera = make_camera_frame({.eye_m = {0, 5, 5}, .target_m = {0, 0, 0}}, 40, 30);
  ReceiverImage floor = floor_receivers(40, 30, camera, 0);
  for (int x = 0; x < 40; ++x) floor.primitive.at(x, 0) = no_primitive;
  Image<float> lit(40, 30, 1), dark = lit;
  for (int y = 10; y < 20; ++y) dark.at(15, y) = 0;
  const auto shown = [&](const Image<float>& visibility) {
    return shown_frame(floor, shaded_frame(floor, light, camera, visibility));
  };
  const Image<glm::u8vec3> picture = shown(dark);
  EXPECT_EQ(picture.at(7, 0), glm::u8vec3(30, 32, 38)) << "the background";
  // Ambient 0.15 of albedo 0.7, by IEC 61966-2-1.
  EXPECT_EQ(picture.at(15, 15), glm::u8vec3(std::lround(255 * (1.055 * std::pow(0.105, 1 / 2.4) - 0.055))));
  const double found = shaded_flip(floor, light, camera, dark, lit);
  EXPECT_EQ(found, flip(shown(lit), picture).mean);
  EXPECT_GT(found, 0.01);
  EXPECT_EQ(shaded_flip(floor, light, camera, dark, dark), 0);
  dark.at(3, 0) = nan;  // no surface there
  EXPECT_EQ(shaded_flip(floor, light, camera, dark, lit), found);
  dark.at(3, 1) = nan;
  EXPECT_TRUE(std::isnan(shaded_flip(floor, light, camera, dark, lit)));
  EXPECT_TRUE(std::isnan(shaded_flip(floor, light, camera, lit, dark)));
  for (uint32_t& p : floor.primitive.pixels) p = no_primitive;
  EXPECT_TRUE(std::isnan(shaded_flip(floor, light, camera, lit, lit))) << "no surface, so nothing can differ";
}

// Only blocks of the picture near a difference are shaded. That may not show.
TEST(ShadedFlip, IsThatOfTheWholeFramesWhereverTheyDiffer) {
  constexpr int width = 203, height = 121;
  const Scene scene = make_scene({.name = "plane"});
  const LightFrame light = make_light_frame(scene, {});
  const CameraFrame camera = make_camera_frame({.eye_m = {0, 5, 5}, .target_m = {0, 0, 0}}, width, height);
  ReceiverImage floor = floor_receivers(width, height, camera, 0);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if ((x * x + 7 * y) % 31 < 3) floor.primitive.at(x, y) = no_primitive;
  Image<float> truth(width, height, 1);
  for (size_t i = 0; i < truth.size(); ++i) truth[i] = static_cast<float>(i % 5) / 4;
  const auto shown = [&](const Image<float>& visibility) {
    return shown_frame(floor, shaded_frame(floor, light, camera, visibility));
  };
  for (const auto& [x, y] : {std::pair(0, 0), {202, 120}, {8, 8}, {15, 16}, {100, 64}, {111, 63}}) {
    Image<float> drawn = truth;
    floor.primitive.at(x, y) = 0;
    drawn.at(x, y) = truth.at(x, y) == 1 ? 0.0f : 1.0f;
    const double found = shaded_flip(floor, light, camera, truth, drawn);
    EXPECT_EQ(found, flip(shown(truth), shown(drawn)).mean) << x << ", " << y;
    EXPECT_GT(found, 0);
  }
}

TEST(ShadedRmse, IsThatOfTheTwoFramesWhereThereIsASurface) {
  const Scene scene = make_scene({.name = "plane"});
  const LightFrame light = make_light_frame(scene, {});
  const CameraFrame camera = make_camera_frame({.eye_m = {0, 5, 5}, .target_m = {0, 0, 0}}, 16, 12);
  ReceiverImage floor = floor_receivers(16, 12, camera, 0);
  std::mt19937 random(5);
  Image<float> a(16, 12, 0), b(16, 12, 0);
  for (size_t i = 0; i < a.size(); ++i) {
    if (i % 3 == 0) continue;
    a[i] = static_cast<float>(random() % 5) / 4;
    b[i] = static_cast<float>(random() % 5) / 4;
  }
  const double whole = shaded_rmse(floor, light, camera, a, b);
  // Tolerance: the frames are floats near 1.
  const Image<float> shaded_a = shaded_frame(floor, light, camera, a), shaded_b = shaded_frame(floor, light, camera, b);
  double squares = 0;
  for (size_t i = 0; i < a.size(); ++i) squares += std::pow(static_cast<double>(shaded_a[i]) - shaded_b[i], 2);
  EXPECT_NEAR(whole, std::sqrt(squares / static_cast<double>(a.size())), 1e-6);
  EXPECT_GT(whole, 0.05);
  EXPECT_EQ(shaded_rmse(floor, light, camera, a, a), 0);
  // Background pixels must not lower the mean.
  for (size_t i = 0; i < a.size(); i += 3) floor.primitive[i] = no_primitive;
  EXPECT_NEAR(shaded_rmse(floor, light, camera, a, b), whole * std::sqrt(1.5), 1e-6);
  a[1] = nan;
  EXPECT_TRUE(std::isnan(shaded_rmse(floor, light, camera, a, b)));
  EXPECT_TRUE(std::isnan(shaded_rmse(floor, light, camera, a, a)));
  for (uint32_t& p : floor.primitive.pixels) p = no_primitive;
  EXPECT_TRUE(std::isnan(shaded_rmse(floor, light, camera, a, a))) << "no surface, so nothing can differ";
}

// --- the frustum ---

CameraFrame some_camera(Projection projection, int width, int height) {
  return make_camera_frame({.projection = projection,
                            .eye_m = {3, 2, 7},
                            .target_m = {0.3, 0.4, 0.5},
                            .height_m = 6,
                            .near_m = 0.1,
                            .far_m = 100},
                           width, height);
}

TEST(ProjectSegment, IsWhereThePixelsRayIs) {
  for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
    const CameraFrame camera = some_camera(projection, 160, 90);
    const Ray a = camera.pixel_ray(20, 70, 160, 90), b = camera.pixel_ray(140, 10, 160, 90);
    ScreenSegment s;
    ASSERT_TRUE(project_segment(camera, 160, 90, a.origin + 4.0 * a.direction, b.origin + 9.0 * b.direction, 0, s));
    EXPECT_LT(glm::length(s.from - glm::dvec2(20.5, 70.5)), 1e-9);
    EXPECT_LT(glm::length(s.to - glm::dvec2(140.5, 10.5)), 1e-9);
    EXPECT_NEAR(s.from_depth, 4, 1e-12);
    EXPECT_NEAR(s.to_depth, 9, 1e-12);
  }
}

TEST(ProjectSegment, IsCutAtThePictureAndBeforeTheEye) {
  const CameraFrame camera = make_camera_frame(
      {.eye_m = {0, 0, 5}, .target_m = {0, 0, 0}, .fov_y_deg = 90, .near_m = 0.1, .far_m = 100}, 100, 100);
  ScreenSegment s;
  // A horizontal line through the middle, far beyond both sides: it is cut to the picture's width plus the margin.
  ASSERT_TRUE(project_segment(camera, 100, 100, {-100, 0, 0}, {100, 0, 0}, 0, s));
  EXPECT_NEAR(s.from.x, 0, 1e-9);
  EXPECT_NEAR(s.to.x, 100, 1e-9);
  EXPECT_NEAR(s.from.y, 50, 1e-9);
  ASSERT_TRUE(project_segment(camera, 100, 100, {-100, 0, 0}, {100, 0, 0}, 10, s));
  EXPECT_NEAR(s.from.x, -10, 1e-9);
  // A line from before the eye to behind it: only the part before the eye is kept, and it leaves the picture.
  ASSERT_TRUE(project_segment(camera, 100, 100, {0, -1, 0}, {0, -1, 60}, 0, s));
  EXPECT_NEAR(s.from.y, 60, 1e-9);  // 1 m down at 5 m
  EXPECT_NEAR(s.to.y, 100, 1e-9);
  EXPECT_NEAR(s.to_depth, 1, 1e-9);
  EXPECT_FALSE(project_segment(camera, 100, 100, {0, 0, 6}, {1, 0, 60}, 0, s)) << "the segment is behind the eye";
  EXPECT_FALSE(project_segment(camera, 100, 100, {-100, 80, 0}, {100, 80, 0}, 0, s))
      << "the segment is above the picture";
  EXPECT_FALSE(project_segment(camera, 100, 100, {-11, 0, 0}, {0, 11, 0}, 0, s)) << "the segment passes a corner";
}

TEST(FrustumLines, AreTheEdgesOfWhatTheMapHolds) {
  for (const char* scene : {"wall", "spot-room", "point-room"}) {
    LightFrame light = frame_of(scene);
    light.shift_texels = light.kind == LightKind::spot ? glm::dvec2(0.4, -0.7) : glm::dvec2(0);
    int edges = 0;
    for (const WorldLine& line : frustum_lines(light)) {
      if (line.color == cone_line) continue;
      for (size_t k = 1; k < line.points.size(); ++k) {
        ++edges;
        // Both ends are corners of the map's clip cube; for a point light, of the clip cube of a face.
        for (const glm::dvec3& p : {line.points[k - 1], line.points[k]}) {
          const int face = light.kind == LightKind::point ? cube_face_of(light.to_light(p)) : 0;
          const glm::dvec4 clip = light.clip_from_world(face) * glm::dvec4(p, 1);
          for (int axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(std::abs(clip[axis] / clip.w), 1, 1e-9) << scene << ' ' << axis;
          const double z = clip.z / clip.w;
          if (line.color == near_line) {
            EXPECT_LT(z, 0) << scene;
          } else if (line.color == far_line) {
            EXPECT_GT(z, 0) << scene;
          }
        }
        EXPECT_GT(glm::length(line.points[k] - line.points[k - 1]), 0.1) << scene;
      }
    }
    EXPECT_EQ(edges, light.kind == LightKind::point ? 32 : 12) << scene;
  }
}

TEST(FrustumLines, ASpotLightsConeIsAsWideAsTheLight) {
  const Scene scene = make_scene({.name = "spot-room"});
  const LightFrame light = make_light_frame(scene, {});
  int rims = 0;
  for (const WorldLine& line : frustum_lines(light)) {
    if (line.color != cone_line) continue;
    ++rims;
    EXPECT_EQ(line.points.front(), line.points.back());
    for (const glm::dvec3& p : line.points) {
      EXPECT_NEAR(glm::degrees(std::acos(glm::dot(glm::normalize(p - light.origin_m), light.forward))),
                  scene.light.cone_deg / 2, 1e-6);
      EXPECT_NEAR(light.to_light(p).z, rims == 1 ? light.far_m : light.near_m, 1e-9);
    }
  }
  EXPECT_EQ(rims, 2);
}

int count(const Image<Color>& picture, Color color) {
  return static_cast<int>(std::count(picture.pixels.begin(), picture.pixels.end(), color));
}

TEST(DrawFrustum, DashesWhatTheSceneHidesAndMarksTheLight) {
  const int width = 400, height = 300;
  const CameraFrame camera = make_camera_frame(
      {.eye_m = {0, 1, 12}, .target_m = {0, 0, 0}, .fov_y_deg = 60, .near_m = 0.1, .far_m = 100}, width, height);
  const LightFrame light = frame_of("point-room");
  const Color white(255, 255, 255);
  ReceiverImage nothing = floor_receivers(width, height, camera, 1e9);
  Image<Color> open(width, height, white);
  draw_frustum(open, light, camera, nothing);
  const int seen = count(open, near_line);
  EXPECT_GT(seen, 300);
  EXPECT_GT(count(open, light_mark), 100);
  EXPECT_GT(count(open, white), width * height / 2);

  ReceiverImage wall = nothing;
  for (size_t i = 0; i < wall.position.size(); ++i) {
    wall.primitive[i] = 0;
    wall.position[i] = glm::vec3(camera.eye_m + 2.0 * camera.forward);
  }
  Image<Color> hidden(width, height, white);
  draw_frustum(hidden, light, camera, wall);
  EXPECT_EQ(count(hidden, near_line), 0);
  const Color faint(glm::mix(glm::vec3(255), glm::vec3(near_line), 0.5f) + 0.5f);
  EXPECT_GT(count(hidden, faint), seen / 4);
  EXPECT_LT(count(hidden, faint), 3 * seen / 4);
  EXPECT_GT(count(hidden, light_mark), 100) << "the mark of the light must be visible through surfaces";
}

// A surface does not hide a line that lies in it.
TEST(DrawFrustum, LinesInASurfaceAreSeen) {
  const int width = 400, height = 300;
  const CameraFrame camera = make_camera_frame(
      {.eye_m = {0, 6, 9}, .target_m = {0, 0, 0}, .fov_y_deg = 60, .near_m = 0.1, .far_m = 100}, width, height);
  LightFrame light;
  light.origin_m = {0, 5, 0};
  light.right = {1, 0, 0};
  light.up = {0, 0, -1};
  light.forward = {0, -1, 0};
  light.extent_m = 6;
  light.near_m = 1;
  light.far_m = 5;
  const ReceiverImage floor = floor_receivers(width, height, camera, 0);
  Image<Color> picture(width, height, Color(255));
  draw_frustum(picture, light, camera, floor);
  Image<Color> bare(width, height, Color(255));
  draw_frustum(bare, light, camera, floor_receivers(width, height, camera, 1e9));
  EXPECT_EQ(count(picture, far_line), count(bare, far_line));
  EXPECT_GT(count(picture, far_line), 300);
  EXPECT_EQ(count(picture, light_mark), 0) << "a directional light has no position";
}

TEST(DifferenceColor, BrightensWithTheDifference) {
  double before = -1;
  for (int i = 0; i <= 100; ++i) {
    const glm::dvec3 c(difference_color(i / 100.0));
    const double luma = 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b;
    EXPECT_GT(luma, before) << i;
    before = luma;
  }
  EXPECT_EQ(difference_color(2), difference_color(1));
  EXPECT_EQ(difference_color(std::nan("")), Color(0, 255, 0));
}

}  // namespace
}  // namespace noonmark
