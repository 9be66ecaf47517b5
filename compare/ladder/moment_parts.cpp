#include "compare/ladder/moment_parts.h"

#include <array>
#include <cmath>

#include "compare/ladder/lasting_steps.h"

namespace noonmark {

MomentParts moment_parts(const MomentChain& chain, double shown) {
  std::array<double, 4> parts{};
  lasting_steps(std::array{chain.from, chain.texels, chain.bare, chain.bound, shown}, parts);
  const double change = shown - chain.from;
  double uncovered = std::min(chain.uncovered, std::abs(change));
  double unsure = std::min(chain.unsure, std::abs(change) - uncovered);
  MomentParts all;
  all.coverage = 0 + std::copysign(uncovered, change);  // 0 + x: no negative zero
  all.undecided = 0 + std::copysign(unsure, change);
  for (double& part : parts) {
    const auto take = [&](double& left) {
      const double taken = std::min(left, std::abs(part));
      left -= taken;
      part -= std::copysign(taken, change);
    };
    take(uncovered);
    take(unsure);
  }
  all.aliasing = 0 + parts[0], all.to_bare = 0 + parts[1], all.to_floors = 0 + parts[2], all.reduction = 0 + parts[3];
  return all;
}

}  // namespace noonmark
