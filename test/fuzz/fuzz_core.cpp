// SPDX-License-Identifier: BSD-3-Clause
// Any doubles as a box and a line, a ray and a segment: the answer of the core, alone or in a
// scene, is compared with the oracle. The first byte chooses the kind of the box and the question,
// one an input. Where the sum of all bytes is a multiple of 32, numbers are taken as they are; else
// they are squeezed to magnitudes from 2^-32 to 2^32, where exact integers are short and a hundred
// times as many inputs can be asked. A coverage-guided fuzzer would else prefer the slow ones.
#include "fuzz/fuzz.h"
#include "reference/oracle.h"
#include "stress/check_pair.h"
#include "stress/families.h"
#include "stress/random.h"

#include <box_query/distance.h>
#include <box_query/scene.h>

#include <cstring>
#include <numeric>
#include <variant>

namespace box_query::fuzz {
namespace {

using stress::Sample;
using stress::Tally;

/// The first byte, 19 doubles, and in seeds a byte that makes the sum what it must be.
constexpr std::size_t kNumbers = 19;
constexpr unsigned kOriented = 1;
constexpr unsigned kFirstQuestion = 2;  ///< the bits from this on are its number
constexpr unsigned kSums = 32;
enum Question : unsigned { kLine, kRay, kSegment, kDistance, kScene, kQuestions };

/// The same sign and digits, the exponent modulo 64. Every number but 0 becomes a normal one.
double squeezed(double number) {
  if (number == 0.0) {
    return number;
  }
  std::uint64_t bits = 0;
  std::memcpy(&bits, &number, sizeof(bits));
  const std::uint64_t exponent = 1023 - 32 + ((bits >> 52U) & 63U);
  bits = (bits & ~(std::uint64_t{0x7ff} << 52U)) | (exponent << 52U);
  std::memcpy(&number, &bits, sizeof(bits));
  return number;
}

/// Numbers one after the other; those that are missing are 0.
class Numbers {
 public:
  Numbers(const std::uint8_t* data, std::size_t size, bool is_squeezed)
      : data_(data), left_(size), squeezed_(is_squeezed) {}

  double next() {
    double number = 0.0;
    if (left_ >= sizeof(number)) {
      std::memcpy(&number, data_, sizeof(number));
      data_ += sizeof(number);
      left_ -= sizeof(number);
    }
    return squeezed_ ? squeezed(number) : number;
  }
  Vector3 vector() {
    const double x = next();
    const double y = next();
    return {x, y, next()};
  }

 private:
  const std::uint8_t* data_;
  std::size_t left_;
  bool squeezed_;
};

unsigned sumOf(const std::uint8_t* data, std::size_t size) {
  return std::accumulate(data, data + size, 0U) % kSums;
}

/// An input that asks this question of the sample, squeezed if that changes no number.
Bytes bytesOf(const Sample& sample, unsigned question) {
  Bytes bytes(1 + kNumbers * sizeof(double));
  std::size_t at = 1;
  bool is_squeezed = true;
  const auto add = [&](const auto& numbers) {
    for (int i = 0; i < numbers.size(); ++i) {
      const double number = numbers[i];
      is_squeezed = is_squeezed && squeezed(number) == number;
      std::memcpy(&bytes[at], &number, sizeof(number));
      at += sizeof(number);
    }
  };
  if (const auto* box = std::get_if<OrientedBox>(&sample.box)) {
    bytes[0] = kOriented;
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
  bytes[0] = static_cast<std::uint8_t>(bytes[0] + question * kFirstQuestion);
  const unsigned wanted_sum = is_squeezed ? 1 : 0;
  bytes.push_back(
      static_cast<std::uint8_t>(wanted_sum + kSums - sumOf(bytes.data(), bytes.size())));
  return bytes;
}

/// @pre size > 0
Sample sampleOf(const std::uint8_t* data, std::size_t size) {
  const bool is_oriented = (data[0] & kOriented) != 0;
  Numbers numbers(data + 1, size - 1, sumOf(data, size) != 0);
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

void askScene(const Sample& sample) {
  const Scene scene({sample.box, sample.box});
  const Hit hit = scene.cast(sample.ray());
  const bool meets = std::visit(
      [&](const auto& box) { return oracle::interval(sample.ray(), box).hit(); }, sample.box);
  require(hit.hit == meets, "a scene hits where the oracle does");
  require(!hit.hit || hit.box == 0, "a tie goes to the lower index");
  require(scene.castAny(sample.ray()) == hit.hit, "any hit is a hit");
  const double distance = std::visit(
      [&](const auto& box) { return box_query::distance(sample.segment(), box).distance; },
      sample.box);
  require(scene.clearance(sample.segment()).distance == distance,
          "the clearance of a scene is the distance of its box");
}

void ask(const Sample& sample, unsigned question, std::size_t size) {
  Tally tally;
  stress::Random random(size, 0, 0);
  switch (question) {
    case kLine:
      stress::checkIntersection(sample, oracle::Kind::kLine, tally);
      break;
    case kRay:
      stress::checkIntersection(sample, oracle::Kind::kRay, tally);
      break;
    case kSegment:
      stress::checkIntersection(sample, oracle::Kind::kSegment, tally);
      break;
    case kDistance:
      stress::checkDistances(sample, random, tally);
      break;
    default:
      askScene(sample);
  }
  requireRight(tally);
}

}  // namespace

std::vector<Bytes> seeds() {
  std::vector<Bytes> all;
  for (std::size_t family = 0; family < stress::familyNames().size(); ++family) {
    for (unsigned index = 0; index < 2 * kQuestions; ++index) {
      const Sample sample = stress::makeSample(family, index % 2 == 1, 7, index);
      all.push_back(bytesOf(sample, index / 2));
    }
  }
  return all;
}

void testOne(const std::uint8_t* data, std::size_t size) {
  if (size == 0) {
    return;
  }
  const Sample sample = sampleOf(data, size);
  const unsigned question = data[0] / kFirstQuestion % kQuestions;
  const bool has_direction = question == kLine || question == kRay || question == kScene;
  if (isValid(sample.box) && isValid(sample.segment()) &&
      (!has_direction || isValid(sample.ray()))) {
    ask(sample, question, size);
  }
}

}  // namespace box_query::fuzz
