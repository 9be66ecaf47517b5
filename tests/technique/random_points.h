#pragma once

#include <glm/glm.hpp>
#include <random>

namespace noonmark {

inline double random_in(std::mt19937& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}
inline glm::dvec3 random_point(std::mt19937& random, double reach) {
  return {random_in(random, -reach, reach), random_in(random, -reach, reach), random_in(random, -reach, reach)};
}

}  // namespace noonmark
