// SPDX-License-Identifier: BSD-3-Clause
// Any doubles as a box and a line, a ray and a segment: every query of the core, alone and in a
// scene, is compared with the oracle.
#include "fuzz/fuzz.h"
#include "reference/oracle.h"
#include "stress/check_pair.h"
#include "stress/families.h"
#include "stress/random.h"

#include <box_query/scene.h>

#include <cstring>
#include <variant>

namespace box_query::fuzz {
namespace {

using stress::Sample;
using stress::Tally;

/// The kind of the box, and 19 doubles.
constexpr std::size_t kNumbers = 19;

/// Numbers one after the other; those that are missing are 0.
class Numbers {
 public:
  Numbers(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}

  double next() {
    double number = 0.0;
    if (left_ >= sizeof(number)) {
      std::memcpy(&number, data_, sizeof(number));
      data_ += sizeof(number);
      left_ -= sizeof(number);
    }
    return number;
  }
  Vector3 vector() {
    const double x = next();
    const double y = next();
    return {x, y, next()};
  }

 private:
  const std::uint8_t* data_;
  std::size_t left_;
};

Bytes bytesOf(const Sample& sample) {
  Bytes bytes(1 + kNumbers * sizeof(double));
  std::size_t at = 1;
  const auto add = [&](const auto& numbers) {
    for (int i = 0; i < numbers.size(); ++i) {
      const double number = numbers[i];
      std::memcpy(&bytes[at], &number, sizeof(number));
      at += sizeof(number);
    }
  };
  if (const auto* box = std::get_if<OrientedBox>(&sample.box)) {
    bytes[0] = 1;
    add(box->center);
    add(box->half_extents);
    add(box->orientation.coeffs());
  } else {
    add(std::get<AlignedBox>(sample.box).min);
    add(std::get<AlignedBox>(sample.box).max);
    add(Eigen::Vector4d::Zero().eval());
  }
  add(sample.origin);
  add(sample.direction);
  add(sample.end);
  return bytes;
}

Sample sampleOf(const std::uint8_t* data, std::size_t size) {
  const bool is_oriented = size > 0 && data[0] % 2 == 1;
  Numbers numbers(data + (size > 0 ? 1 : 0), size > 0 ? size - 1 : 0);
  const Vector3 first = numbers.vector();
  const Vector3 second = numbers.vector();
  const double x = numbers.next();
  const double y = numbers.next();
  const double z = numbers.next();
  const Quaternion orientation(numbers.next(), x, y, z);
  Sample sample;
  if (is_oriented) {
    sample.box = OrientedBox{first, orientation, second};
  } else {
    sample.box = AlignedBox{first, second};
  }
  sample.origin = numbers.vector();
  sample.direction = numbers.vector();
  sample.end = numbers.vector();
  return sample;
}

void requireRight(const Tally& tally) {
  for (const std::string& failure : tally.failures) {
    std::fprintf(stderr, "%s\n", failure.c_str());
  }
  require(tally.wrong == 0, "every answer is the oracle's");
}

}  // namespace

std::vector<Bytes> seeds() {
  std::vector<Bytes> all;
  for (std::size_t family = 0; family < stress::familyNames().size(); ++family) {
    for (std::uint64_t index = 0; index < 8; ++index) {
      all.push_back(bytesOf(stress::makeSample(family, index % 2 == 1, 7, index)));
    }
  }
  return all;
}

void testOne(const std::uint8_t* data, std::size_t size) {
  const Sample sample = sampleOf(data, size);
  if (!isValid(sample.box) || !isValid(sample.segment())) {
    return;
  }
  Tally tally;
  stress::Random random(size, 0, 0);
  stress::checkDistances(sample, random, tally);
  if (isValid(sample.ray())) {
    stress::checkIntersections(sample, tally);
    const Scene scene({sample.box, sample.box});
    const Hit hit = scene.cast(sample.ray());
    const bool meets = std::visit(
        [&](const auto& box) { return oracle::interval(sample.ray(), box).hit(); }, sample.box);
    require(hit.hit == meets, "a scene hits where the oracle does");
    require(!hit.hit || hit.box == 0, "a tie goes to the lower index");
    require(scene.castAny(sample.ray()) == hit.hit, "any hit is a hit");
  }
  requireRight(tally);
}

}  // namespace box_query::fuzz
