// The truth of filtered maps, compared with an implementation from the definitions in 113 bits: variances and determinants
// as sums over pairs of depths, and the moment bias on the moments themselves.
#include "technique/lookup_truth.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "tests/technique/quad.h"
#include "tests/technique/random_depths.h"

namespace noonmark {
namespace {

struct Atoms {
  std::vector<Quad> at, weight;  // weights of sum 1
};

Atoms atoms_of(const DepthsAndReceiver& given) {
  Atoms made;
  Quad sum = 0;
  for (const double weight : given.weights) sum += weight;
  for (size_t i = 0; i < given.depths.size(); ++i) {
    made.at.push_back(given.depths[i]);
    made.weight.push_back(given.weights[i] / sum);
  }
  return made;
}

template <class Of>
Quad mean_of(const Atoms& atoms, Of of) {
  Quad sum = 0;
  for (size_t i = 0; i < atoms.at.size(); ++i) sum += atoms.weight[i] * of(atoms.at[i]);
  return sum;
}

// The variance is the mean of half the squared difference of two depths.
Quad cantelli(const Atoms& atoms, Quad receiver, Quad least) {
  const Quad middle = mean_of(atoms, [](Quad z) { return z; });
  Quad variance = 0;
  for (size_t i = 0; i < atoms.at.size(); ++i)
    for (size_t j = 0; j < i; ++j) {
      const Quad way = atoms.at[i] - atoms.at[j];
      variance += atoms.weight[i] * atoms.weight[j] * way * way;
    }
  if (variance < least) variance = least;
  const Quad behind = receiver - middle;
  return behind > 0 ? variance / (variance + behind * behind) : Quad(1);
}

struct Nodes {
  bool unique = false;  // the distribution is the only one with its moments and a depth at the receiver
  Quad low = 0, high = 0;
};

// By Cauchy and Binet, the polynomial whose roots are the other two depths is a sum over pairs of depths.
Nodes nodes_of(const Atoms& atoms, Quad receiver) {
  Quad c0 = 0, c1 = 0, c2 = 0;
  for (size_t i = 0; i < atoms.at.size(); ++i)
    for (size_t j = 0; j < i; ++j) {
      const Quad a = atoms.at[i] - receiver, b = atoms.at[j] - receiver;
      const Quad g = atoms.weight[i] * atoms.weight[j] * a * b * (a - b) * (a - b);
      c2 += g;
      c1 -= g * (a + b);
      c0 += g * a * b;
    }
  if (c2 == 0) return {.unique = true};
  const Quad root = root_of(c1 * c1 / 4 - c0 * c2);
  const Quad sum = c1 > 0 ? -c1 / 2 - root : -c1 / 2 + root;
  const Quad one = sum / c2, other = c0 / sum;
  return {.low = receiver + (one < other ? one : other), .high = receiver + (one < other ? other : one)};
}

Quad behind_receiver(const Atoms& atoms, Quad receiver) {
  return mean_of(atoms, [&](Quad z) { return z < receiver ? Quad(0) : Quad(1); });
}

// The weight of a node beside two others.
Quad weight_of(const Atoms& atoms, Quad node, Quad a, Quad b) {
  return mean_of(atoms, [&](Quad z) { return (z - a) * (z - b); }) / ((node - a) * (node - b));
}

Quad hamburger(const Atoms& atoms, Quad receiver, const Nodes& nodes) {
  if (nodes.unique) return behind_receiver(atoms, receiver);
  if (receiver < nodes.low) return 1;
  const Quad own = weight_of(atoms, receiver, nodes.low, nodes.high);
  return receiver < nodes.high ? own + weight_of(atoms, nodes.high, nodes.low, receiver) : own;
}

// The cubic through the step function at 0, the free depth, the receiver and 1, by divided differences.
Quad hausdorff(const Atoms& atoms, Quad d) {
  const Nodes nodes = nodes_of(atoms, d);
  if (nodes.unique) return behind_receiver(atoms, d);
  if (d <= 0) return 1;
  if (d >= 1 || (nodes.low >= 0 && nodes.high <= 1)) return hamburger(atoms, d, nodes);
  const Quad divisor = mean_of(atoms, [&](Quad z) { return z * (1 - z) * (z - d); });
  if (divisor == 0) return hamburger(atoms, d, nodes);
  const Quad u = mean_of(atoms, [&](Quad z) { return z * z * (1 - z) * (z - d); }) / divisor;
  const Quad step = u < d ? 1 : 0;
  const Quad second = 1 / (u - step), third = second * (u - step - d) / (d * (d - u));
  return 1 - mean_of(atoms, [&](Quad z) { return 1 - z + second * z * (z - 1) + third * z * (z - 1) * (z - u); });
}

// The distribution of the moment bias, as weighted moments of [-1, 1] or [0, 1], solved by the inverse of their matrix.
Quad biased_hamburger(const Atoms& atoms, Quad receiver, const in_extended::LookupParameters& p) {
  const bool centred = p.moments < 2;
  const Quad mixed = p.moments == 0 ? Quad(0.375) : p.moments == 1 ? Quad(0.628L) : Quad(0.5);
  const auto place = [&](Quad z) { return centred ? 2 * z - 1 : z; };
  const Quad alpha = p.moment_bias, d = place(receiver);
  Quad b[5] = {1, 0, 0, 0, 0};
  for (int power = 1; power < 5; ++power) {
    const Quad plain = mean_of(atoms, [&](Quad z) {
      Quad product = 1;
      for (int k = 0; k < power; ++k) product *= place(z);
      return product;
    });
    b[power] = (1 - alpha) * plain + (centred && power % 2 ? Quad(0) : alpha * mixed);
  }
  // The roots of the polynomial orthogonal to 1 and z under (z - d) times the distribution.
  const Quad s0 = b[1] - d, s1 = b[2] - d * b[1], s2 = b[3] - d * b[2], s3 = b[4] - d * b[3];
  const Quad c2 = s0 * s2 - s1 * s1, c1 = s1 * s2 - s0 * s3, c0 = s1 * s3 - s2 * s2;
  const Quad root = root_of(c1 * c1 / 4 - c0 * c2);
  const Quad sum = c1 > 0 ? -c1 / 2 - root : -c1 / 2 + root;
  Quad low = sum / c2, high = c0 / sum;
  if (high < low) std::swap(low, high);
  const auto weight = [&](Quad node, Quad x, Quad y) {
    return (b[2] - (x + y) * b[1] + x * y) / ((node - x) * (node - y));
  };
  if (d < low) return 1;
  const Quad own = weight(d, low, high);
  return d < high ? own + weight(high, low, d) : own;
}

// Every test run takes the first 100,000 sets; NOONMARK_SETS=1000000 takes as many as were taken for the largest errors below.
int sets() {
  const char* const given = std::getenv("NOONMARK_SETS");
  return given ? std::stoi(given) : 100'000;
}
constexpr long double agreed = 1e-12L;  // the largest error was 1e-13, of MSM with depths 1e-7 apart; the others' 2e-19

struct Worst {
  long double error = 0;
  void add(Quad expected, long double given) {
    const long double difference = std::abs(static_cast<long double>(expected - given));
    if (!std::isnan(error) && !(difference <= error)) error = difference;  // a NaN stays
  }
};

TEST(LookupTruth, RefusesWhatIsNoDistribution) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [](std::vector<double> depths, std::vector<double> weights, double receiver) {
    for (const LookupTruth truth : {vsm_truth, esm_truth, evsm2_truth, evsm4_truth, msm_truth, msm_hausdorff_truth,
                                    babylon_esm_truth, babylon_close_esm_truth})
      EXPECT_THROW(truth(depths, weights, receiver, {}), std::logic_error);
  };
  refused({0.5, nan}, {1, 1}, 0.5);
  refused({0.5, 0.5}, {1, nan}, 0.5);
  refused({0.5, 0.5}, {2, -1}, 0.5);
  refused({0.5, 0.5}, {0, 0}, 0.5);
  refused({0.5, 0.5}, {1}, 0.5);
  refused({0.5, 0.5}, {1, 1}, nan);
}

TEST(LookupTruth, IsThatOfTheDefinitions) {
  std::mt19937_64 random(1);
  Worst vsm, floored, esm, evsm2, evsm4, msm, biased, hausdorff_form;
  const double exponents[][2] = {{5.54, 3}, {15, 15}, {40, 5}, {44, 44}};
  const int count = sets();
  for (int set = 0; set < count; ++set) {
    const DepthsAndReceiver given = random_depths(random);
    const Atoms atoms = atoms_of(given);
    const Quad d = given.receiver;
    const auto [positive, negative] = exponents[random() % 4];
    const long double floor = random() % 2 ? 0 : std::pow(10.0L, -1 - static_cast<long double>(random() % 5));
    in_extended::LookupParameters p{.v_min = 0,
                                    .floor = floor,
                                    .exponent = positive,
                                    .negative_exponent = negative,
                                    .moment_bias = 0,
                                    .moments = static_cast<int>(random() % 4)};
    const auto truth = [&](LookupTruth of) { return of(given.depths, given.weights, given.receiver, p); };
    vsm.add(cantelli(atoms, d, 0), truth(vsm_truth));
    p.v_min = floor * floor;
    floored.add(cantelli(atoms, d, p.v_min), truth(vsm_truth));

    Atoms warped = atoms, turned = atoms;
    for (Quad& z : warped.at) z = exponential_of(Quad(positive) * (2 * z - 1));
    for (Quad& z : turned.at) z = -exponential_of(-Quad(negative) * (2 * z - 1));
    const Quad w = exponential_of(Quad(positive) * (2 * d - 1)), n = -exponential_of(-Quad(negative) * (2 * d - 1));
    const auto least = [&](double exponent, Quad at) {
      Quad scale = Quad(floor) * exponent;
      if (scale > 1) scale = 1;
      return scale * at * scale * at;
    };
    const Quad first = cantelli(warped, w, least(positive, w)), second = cantelli(turned, n, least(negative, n));
    evsm2.add(first, truth(evsm2_truth));
    evsm4.add(first < second ? first : second, truth(evsm4_truth));
    p.exponent = 2 * static_cast<long double>(positive);  // ESM's depth is on [0, 1]
    const Quad markov = mean_of(warped, [&](Quad z) { return z / w; });
    esm.add(markov < 1 ? markov : Quad(1), truth(esm_truth));

    msm.add(hamburger(atoms, d, nodes_of(atoms, d)), truth(msm_truth));
    hausdorff_form.add(hausdorff(atoms, d), truth(msm_hausdorff_truth));
    p.moment_bias = std::pow(10.0L, -7 + static_cast<long double>(random() % 6));
    biased.add(biased_hamburger(atoms, d, p), truth(msm_truth));
  }
  EXPECT_LE(vsm.error, agreed);
  EXPECT_LE(floored.error, agreed);
  EXPECT_LE(esm.error, agreed);
  EXPECT_LE(evsm2.error, agreed);
  EXPECT_LE(evsm4.error, agreed);
  EXPECT_LE(msm.error, agreed);
  EXPECT_LE(biased.error, agreed);
  EXPECT_LE(hausdorff_form.error, agreed);
}

// What double loses against long double, over the same sets: depths as close as 1e-7, and exponents to 44.
TEST(TruthInDouble, IsThatOfLongDouble) {
  struct Row {
    const char* name;
    LookupTruth truth;
    Worst worst = {};
  };
  Row rows[] = {{"vsm", vsm_truth},     {"esm", esm_truth}, {"evsm2", evsm2_truth},
                {"evsm4", evsm4_truth}, {"msm", msm_truth}, {"msm_hausdorff", msm_hausdorff_truth}};
  std::mt19937_64 random(2);
  TruthInDouble depths;
  const int count = sets() / 5;
  for (int set = 0; set < count; ++set) {
    const DepthsAndReceiver given = random_depths(random);
    depths.set(given.depths, given.weights);
    in_extended::LookupParameters p{
        .v_min = set % 3 ? 0.0L : 1e-6L,
        .floor = set % 3 ? 0.0L : 1e-3L,
        .exponent = set % 4 ? 40.0L : 5.54L,
        .negative_exponent = set % 4 ? 5.0L : 44.0L,
        .moment_bias = set % 2 ? 0.0L : std::pow(10.0L, -7 + static_cast<long double>(set % 6)),
        .moments = set % 4};
    for (Row& row : rows)
      row.worst.add(row.truth(given.depths, given.weights, given.receiver, p),
                    depths.lit(row.truth, given.receiver, p));
  }
  for (const Row& row : rows) EXPECT_LE(row.worst.error, 1e-12L) << row.name;  // 4e-13 was seen
}

}  // namespace
}  // namespace noonmark
