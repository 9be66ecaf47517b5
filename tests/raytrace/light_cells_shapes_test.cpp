// The cells of the light's plane in meshes of long, thin triangles that meet in a point or lie side by side: their
// rectangles cover many squares, so that lists of squares become long and squares become few.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "raytrace/light_cells.h"
#include "tests/raytrace/cells_support.h"
#include "tests/raytrace/thin_shapes.h"

namespace noonmark::raytrace {
namespace {

using namespace test;

class ThinShape : public ::testing::TestWithParam<ThinShapeRow> {};

INSTANTIATE_TEST_SUITE_P(LightCells, ThinShape, ::testing::ValuesIn(thin_shapes),
                         [](const auto& row) { return std::string(row.param.name); });

// From lists of a few hundred squares to one single square. Of the largest meshes there are fewer cases, because rays
// take seconds there: most rays meet hundreds of triangles.
TEST_P(ThinShape, OfEverySizeAnswersAsTheRaysDo) {
  const glm::dvec3 above(0, 10, 0), oblique(3, 9, 2), low(7, 3, 1);
  const auto expect = [&](int triangles, glm::dvec3 from, int receivers) {
    expect_same(over_a_floor(GetParam(), triangles, 1, from), receivers, 18,
                std::to_string(triangles) + " triangles: ");
  };
  for (const int triangles : {3, 40, 500, 2000})
    for (const glm::dvec3 from : {above, oblique, low}) expect(triangles, from, 300);
  expect(20000, above, 150);
  if (GetParam().joined) expect(200000, above, 150);
}

RC_GTEST_PROP(LightCellsOfThinShapes, AnswerAsTheRaysDo, ()) {
  const ThinShapeRow shape = *rc::gen::elementOf(std::vector(thin_shapes.begin(), thin_shapes.end()));
  const int digits = *rc::gen::inRange(0, 300);  // to 1,000 triangles, by their logarithm
  const int triangles = 2 + static_cast<int>(std::pow(10.0, digits / 100.0));
  const double size_m = std::pow(10.0, *rc::gen::inRange(-30, 31) / 10.0);
  const glm::dvec3 from(*rc::gen::inRange(-100, 101) / 10.0, *rc::gen::inRange(5, 101) / 10.0,
                        *rc::gen::inRange(-100, 101) / 10.0);
  Scene scene = over_a_floor(shape, triangles, size_m, size_m * from);
  if (*rc::gen::arbitrary<bool>()) scene = moved(scene, 300.0 * size_m * glm::dvec3(1, -0.3, 0.5));
  expect_same(scene, 150, *rc::gen::arbitrary<uint32_t>(),
              std::string(shape.name) + " of " + std::to_string(triangles) + " triangles: ");
  RC_ASSERT(!::testing::Test::HasFailure());
}

}  // namespace
}  // namespace noonmark::raytrace
