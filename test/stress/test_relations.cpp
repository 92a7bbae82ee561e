// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Exact relations between answers, to the last bit, over all families of hostile input. They need
/// no oracle. BOX_QUERY_STRESS_RELATIONS changes how many of each are tried.
#include "exact/clip.h"
#include "exact/separating_axes.h"
#include "stress/random.h"
#include "stress/relations.h"
#include "stress/transformations.h"

#include <cstdlib>
#include <functional>
#include <optional>
#include <variant>

#include <gtest/gtest.h>

namespace box_query::stress {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

struct Transformed {
  Sample sample;
  Change change;
};

class Relations : public testing::Test {
 protected:
  using Check = std::function<bool(const Sample&, Component, Random&)>;
  using Transform = std::function<std::optional<Transformed>(const Sample&, Random&)>;

  /// Runs the check, which returns false where it does not apply, until it has applied often
  /// enough, over all families, boxes and components in turn.
  void forSamples(const Check& check) {
    const char* const text = std::getenv("BOX_QUERY_STRESS_RELATIONS");
    const std::uint64_t wanted = text == nullptr ? 100000 : std::strtoull(text, nullptr, 10);
    const std::size_t families = familyNames().size();
    std::uint64_t applied = 0;
    for (std::uint64_t index = 0; applied < wanted && index < 20 * wanted; ++index) {
      const bool oriented = index / families % 2 == 0;
      const auto component = static_cast<Component>(index / families / 2 % 3);
      const Sample sample = makeSample(index % families, oriented, 77, index);
      Random random(77, 4000, index);
      applied += check(sample, component, random) ? 1 : 0;
    }
    EXPECT_GE(applied, wanted);
  }

  /// Answers to a sample and to what a transformation makes of it.
  void expectRelation(const Transform& transform) {
    forSamples([&](const Sample& sample, Component component, Random& random) {
      const std::optional<Transformed> other = transform(sample, random);
      if (!other) {
        return false;
      }
      const Answer before = answer(sample, component);
      count(before);
      expectChanged(before, answer(other->sample, component), other->change, describe(sample),
                    tally_);
      return true;
    });
  }

  void count(const Answer& a) {
    ++tally_.queries;
    tally_.hits += a.test ? 1 : 0;
  }

  void TearDown() override {
    for (const std::string& failure : tally_.failures) {
      ADD_FAILURE() << failure;
    }
    EXPECT_EQ(tally_.wrong, 0U);
    EXPECT_GE(tally_.hits, tally_.queries / 5);
  }

  Tally tally_;
};

TEST_F(Relations, SwappedEndsExchangeEntryAndExit) {
  forSamples([&](const Sample& sample, Component, Random&) {
    Sample swapped = sample;
    std::swap(swapped.origin, swapped.end);
    const Answer a = answer(sample, Component::kSegment);
    Answer b = answer(swapped, Component::kSegment);
    count(a);
    std::swap(b.found.entered, b.found.left);
    // Parameters and ranges are another matter: 1 - t rounds differently.
    b.found.t_enter = a.found.t_enter;
    b.found.t_exit = a.found.t_exit;
    b.found.started_inside = a.found.started_inside;
    b.ranges = a.ranges;
    b.distance_t = a.distance_t;
    expectChanged(a, b, {}, describe(sample), tally_);
    return true;
  });
}

TEST_F(Relations, ReversedLinesRunBackwards) {
  forSamples([&](const Sample& sample, Component, Random&) {
    Sample reversed = sample;
    reversed.direction = -sample.direction;
    const Answer a = answer(sample, Component::kLine);
    Answer b = answer(reversed, Component::kLine);
    count(a);
    if (a.test) {
      b.found.t_enter = -std::exchange(b.found.t_exit, -b.found.t_enter);
      b.ranges.enter = -std::exchange(b.ranges.exit, -b.ranges.enter);
    }
    std::swap(b.found.entered, b.found.left);
    expectChanged(a, b, {}, describe(sample), tally_);
    return true;
  });
}

TEST_F(Relations, DirectionsTimesPowersOfTwoDivideParameters) {
  forSamples([&](const Sample& sample, Component component, Random& random) {
    Sample scaled = sample;
    const int power = random.between(-60, 60);
    if (component == Component::kSegment || !scale(scaled.direction, power)) {
      return false;
    }
    Change change;
    change.t_power = -power;
    const Answer before = answer(sample, component);
    count(before);
    expectChanged(before, answer(scaled, component), change, describe(sample), tally_);
    return true;
  });
}

TEST_F(Relations, WorldsTimesPowersOfTwoKeepParameters) {
  expectRelation([](const Sample& sample, Random& random) -> std::optional<Transformed> {
    Transformed other{sample, {}};
    Sample& s = other.sample;
    const int power = random.between(-60, 60);
    other.change.length_power = power;
    bool exact = scale(s.origin, power) && scale(s.direction, power) && scale(s.end, power);
    if (OrientedBox* const box = orientedBox(s)) {
      exact = exact && scale(box->center, power) && scale(box->half_extents, power);
    } else {
      exact = exact && scale(alignedBox(s)->min, power) && scale(alignedBox(s)->max, power);
    }
    return exact ? std::optional<Transformed>(other) : std::nullopt;
  });
}

TEST_F(Relations, NegatedQuaternionsAreTheSameRotation) {
  expectRelation([](const Sample& sample, Random&) -> std::optional<Transformed> {
    Transformed other{sample, {}};
    OrientedBox* const box = orientedBox(other.sample);
    if (box == nullptr) {
      return std::nullopt;
    }
    box->orientation.coeffs() = -box->orientation.coeffs();
    return other;
  });
}

TEST_F(Relations, QuaternionsTimesPowersOfTwoAreTheSameRotation) {
  expectRelation([](const Sample& sample, Random& random) -> std::optional<Transformed> {
    Transformed other{sample, {}};
    OrientedBox* const box = orientedBox(other.sample);
    const int power = random.between(-60, 60);
    if (box == nullptr) {
      return std::nullopt;
    }
    for (double& c : numbersOf(box->orientation.coeffs())) {
      const double scaled = std::ldexp(c, power);
      if (std::ldexp(scaled, -power) != c || !std::isfinite(scaled)) {
        return std::nullopt;
      }
      c = scaled;
    }
    return other;
  });
}

TEST_F(Relations, HalfTurnsOfABoxAboutItsOwnAxesRenameItsFaces) {
  expectRelation([](const Sample& sample, Random& random) -> std::optional<Transformed> {
    Transformed other{sample, {}};
    OrientedBox* const box = orientedBox(other.sample);
    if (box == nullptr) {
      return std::nullopt;
    }
    const int axis = random.below(3);
    box->orientation = timesUnit(box->orientation, axis);
    other.change.swapSides((axis + 1) % 3);
    other.change.swapSides((axis + 2) % 3);
    return other;
  });
}

TEST_F(Relations, MirrorsOfAnAxisExchangeItsFaces) {
  expectRelation([](const Sample& sample, Random& random) -> std::optional<Transformed> {
    Transformed other{sample, {}};
    const int axis = random.below(3);
    flip(other.sample, axis);
    other.change.swapSides(axis);
    if (OrientedBox* const box = orientedBox(other.sample)) {
      // The mirrored rotation turns the other way about the other two axes.
      box->orientation.coeffs()[(axis + 1) % 3] *= -1.0;
      box->orientation.coeffs()[(axis + 2) % 3] *= -1.0;
    }
    return other;
  });
}

TEST_F(Relations, HalfTurnsOfTheWorldChangeNothing) {
  expectRelation([](const Sample& sample, Random& random) -> std::optional<Transformed> {
    Transformed other{sample, {}};
    const int axis = random.below(3);
    for (const int flipped : {(axis + 1) % 3, (axis + 2) % 3}) {
      flip(other.sample, flipped);
      if (alignedBox(other.sample) != nullptr) {
        other.change.swapSides(flipped);
      }
    }
    if (OrientedBox* const box = orientedBox(other.sample)) {
      box->orientation = unitTimes(box->orientation, axis);
    }
    return other;
  });
}

TEST_F(Relations, CyclicPermutationsOfTheAxesRenameThem) {
  expectRelation([](const Sample& sample, Random&) -> std::optional<Transformed> {
    const auto turn = [](Vector3& v) { v = Vector3(v[2], v[0], v[1]); };
    Transformed other{sample, {}};
    Sample& s = other.sample;
    turn(s.origin);
    turn(s.direction);
    turn(s.end);
    if (OrientedBox* const box = orientedBox(s)) {
      turn(box->center);
      turn(box->half_extents);
      const Quaternion q = box->orientation;
      box->orientation = Quaternion(q.w(), q.z(), q.x(), q.y());
    } else {
      turn(alignedBox(s)->min);
      turn(alignedBox(s)->max);
    }
    other.change.faces = {2, 3, 4, 5, 0, 1};
    return other;
  });
}

TEST_F(Relations, ExactTranslationsChangeNothing) {
  forSamples([&](const Sample& hostile, Component component, Random& random) {
    Sample sample = hostile;
    if (!snapToGrid(sample)) {
      return false;
    }
    Vector3 by;
    for (double& x : numbersOf(by)) {
      x = static_cast<double>(random.between(-1000000, 1000000));
      x = std::ldexp(x, random.between(-20, 0));
    }
    Sample moved = sample;
    bool exact = translate(moved.origin, by) && translate(moved.end, by);
    if (OrientedBox* const box = orientedBox(moved)) {
      exact = exact && translate(box->center, by);
    } else {
      exact =
          exact && translate(alignedBox(moved)->min, by) && translate(alignedBox(moved)->max, by);
    }
    if (!exact) {
      return false;
    }
    const Answer before = answer(sample, component);
    count(before);
    expectChanged(before, answer(moved, component), {}, describe(sample), tally_);
    return true;
  });
}

TEST_F(Relations, ASegmentsHitIsItsRaysAndItsLines) {
  forSamples([&](const Sample& hostile, Component, Random&) {
    Sample sample = hostile;
    sample.direction = sample.end;
    if (!translate(sample.direction, -sample.origin)) {
      return false;
    }
    const Answer segment = answer(sample, Component::kSegment);
    const Answer ray = answer(sample, Component::kRay);
    const Answer line = answer(sample, Component::kLine);
    count(segment);
    if ((segment.test && !ray.test) || (ray.test && !line.test)) {
      tally_.fail(describe(sample), "hits of segment, ray and line");
    }
    if (segment.test && segment.found.t_enter != ray.found.t_enter) {
      tally_.fail(describe(sample), "t_enter of segment and ray");
    }
    if (ray.test && !ray.found.started_inside && ray.found.t_enter != line.found.t_enter) {
      tally_.fail(describe(sample), "t_enter of ray and line");
    }
    return true;
  });
}

TEST_F(Relations, GrowingABoxKeepsEveryHit) {
  forSamples([&](const Sample& sample, Component component, Random& random) {
    Sample grown = sample;
    const auto grow = [&random](double x, double towards) {
      return random.chance(0.5) ? std::nextafter(x, towards)
                                : x + std::copysign(std::fabs(x) * random.uniform(), towards);
    };
    for (int i = 0; i < 3; ++i) {
      if (OrientedBox* const box = orientedBox(grown)) {
        box->half_extents[i] = grow(box->half_extents[i], kInf);
      } else {
        AlignedBox& aligned = *alignedBox(grown);
        aligned.min[i] = grow(aligned.min[i], -kInf);
        aligned.max[i] = grow(aligned.max[i], kInf);
      }
    }
    if (!isValid(grown.box)) {
      return false;
    }
    const Answer before = answer(sample, component);
    const Answer after = answer(grown, component);
    count(before);
    const bool kept = !before.test || (after.test && after.found.t_enter <= before.found.t_enter &&
                                       after.found.t_exit >= before.found.t_exit);
    if (!kept || after.distance > before.distance) {
      tally_.fail(describe(sample), "growing the box");
    }
    return true;
  });
}

TEST_F(Relations, TestFindAndDistanceAgree) {
  forSamples([&](const Sample& sample, Component component, Random&) {
    const Answer a = answer(sample, component);
    count(a);
    const bool found = a.found.num_points > 0;
    if (a.test != found || (found && a.found.t_enter > a.found.t_exit)) {
      tally_.fail(describe(sample), "test and find");
    }
    if (component == Component::kSegment && a.test &&
        (a.distance != 0.0 || a.distance_t != a.found.t_enter)) {
      tally_.fail(describe(sample), "distance of what intersects");
    }
    return true;
  });
}

template <typename T>
void checkSeparatingAxes(const T& linear, const Box& box, int& hits) {
  const exact::Slabs slabs =
      std::visit([&](const auto& b) { return exact::slabs(exact::component(linear), b); }, box);
  exact::Clip clip;
  exact::clip(slabs, exact::kHasStart<T>, exact::kHasEnd<T>, clip);
  EXPECT_EQ(clip.num_points > 0 ? 1 : 0,
            exact::meetsBySeparatingAxes(slabs, exact::kHasStart<T>, exact::kHasEnd<T>));
  hits += clip.num_points > 0 ? 1 : 0;
}

TEST(SeparatingAxes, SeparateJustWhereClippingLeavesNothing) {
  constexpr std::uint64_t kEach = 300;
  int hits = 0;
  for (std::size_t family = 0; family < familyNames().size(); ++family) {
    for (std::uint64_t index = 0; index < kEach; ++index) {
      const Sample sample = makeSample(family, index % 2 == 0, 31, index);
      checkSeparatingAxes(sample.line(), sample.box, hits);
      checkSeparatingAxes(sample.ray(), sample.box, hits);
      checkSeparatingAxes(sample.segment(), sample.box, hits);
    }
  }
  EXPECT_GT(hits, static_cast<int>(3 * kEach * familyNames().size() / 5));
}

}  // namespace
}  // namespace box_query::stress
