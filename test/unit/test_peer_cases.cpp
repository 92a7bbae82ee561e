// SPDX-License-Identifier: BSD-3-Clause
//
// Cases from the tests of other projects, with what those expect. Each is held to its own
// project's answer, convention and tolerance: where projects differ is what a ray that starts
// inside returns. Skipped where the environment variable BOX_QUERY_SHARED does not name the
// directory of peer_cases.csv.
#include <box_query/distance.h>
#include <box_query/intersection.h>
#include <box_query/scene.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace box_query {
namespace {

/// One line of the file: texts by column name.
class Case {
 public:
  explicit Case(std::map<std::string, std::string> fields) : fields_(std::move(fields)) {}

  const std::string& text(const std::string& column) const { return fields_.at(column); }
  std::optional<double> number(const std::string& column) const {
    const std::string& field = text(column);
    return field.empty() ? std::nullopt : std::make_optional(std::stod(field));
  }
  std::optional<Vector3> vector(const std::string& prefix, const std::string& separator) const {
    const auto x = number(prefix + separator + "x");
    const auto y = number(prefix + separator + "y");
    const auto z = number(prefix + separator + "z");
    return x && y && z ? std::make_optional(Vector3(*x, *y, *z)) : std::nullopt;
  }
  /// The origin or start of the component, or the point.
  Vector3 a() const { return vector("a", "").value(); }
  /// The direction of a ray or a line, or the end of a segment.
  Vector3 b() const { return vector("b", "").value(); }
  double tolerance() const { return number("tol").value(); }

 private:
  std::map<std::string, std::string> fields_;
};

/// The fields of a line; a quoted one may contain commas.
std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (const char c : line) {
    if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      fields.emplace_back();
    } else if (c != '\r') {
      fields.back() += c;
    }
  }
  return fields;
}

std::vector<Case> readCases(const std::string& path) {
  std::ifstream in(path);
  std::string line;
  std::getline(in, line);
  const std::vector<std::string> columns = split(line);
  std::vector<Case> cases;
  while (std::getline(in, line)) {
    const std::vector<std::string> texts = split(line);
    EXPECT_EQ(texts.size(), columns.size()) << line;
    std::map<std::string, std::string> fields;
    for (std::size_t i = 0; i < columns.size() && i < texts.size(); ++i) {
      fields[columns[i]] = texts[i];
    }
    cases.emplace_back(std::move(fields));
  }
  return cases;
}

OrientedBox orientedBox(const Case& peer) {
  return {peer.vector("c", "").value(),
          Quaternion(peer.number("qw").value(), peer.number("qx").value(),
                     peer.number("qy").value(), peer.number("qz").value()),
          peer.vector("s", "").value() / 2.0};
}

/// The box of a case; also as an aligned one where it is one and its bounds do not round.
std::vector<Box> forms(const Case& peer) {
  const OrientedBox box = orientedBox(peer);
  std::vector<Box> boxes = {box};
  const AlignedBox aligned{box.center - box.half_extents, box.center + box.half_extents};
  const bool exact = aligned.max - box.center == box.half_extents &&
                     box.center - aligned.min == box.half_extents &&
                     aligned.max - box.half_extents == box.center &&
                     aligned.min + box.half_extents == box.center;
  if (exact && box.orientation.coeffs() == Quaternion::Identity().coeffs()) {
    boxes.emplace_back(aligned);
  }
  return boxes;
}

template <typename Component>
Intersection find(const Component& component, const Box& box) {
  return std::visit([&](const auto& b) { return findIntersection(component, b); }, box);
}

template <typename Component>
bool test(const Component& component, const Box& box) {
  return std::visit([&](const auto& b) { return testIntersection(component, b); }, box);
}

SegmentDistance segmentDistance(const Segment& segment, const Box& box) {
  return std::visit([&](const auto& b) { return distance(segment, b); }, box);
}

void expectNear(const Vector3& ours, const Vector3& theirs, double tolerance) {
  EXPECT_LE((ours - theirs).cwiseAbs().maxCoeff(), tolerance)
      << "ours " << ours.transpose() << ", theirs " << theirs.transpose();
}

/// Compares what the case states about entry and exit.
/// @return how many statements there were: the tests check that as many as the file has were
/// compared
int expectFound(const Case& peer, const Intersection& ours) {
  int compared = 0;
  if (const auto entry = peer.vector("entry", "_")) {
    expectNear(ours.enter_point, *entry, peer.tolerance());
    ++compared;
  }
  if (const auto exit = peer.vector("exit", "_")) {
    expectNear(ours.exit_point, *exit, peer.tolerance());
    ++compared;
  }
  if (const auto fraction = peer.number("entry_fraction")) {
    EXPECT_NEAR(ours.t_enter, *fraction, peer.tolerance());
    ++compared;
  }
  if (const auto fraction = peer.number("exit_fraction")) {
    EXPECT_NEAR(ours.t_exit, *fraction, peer.tolerance());
    ++compared;
  }
  return compared;
}

/// What a peer does with a ray that starts inside, in our terms.
enum class Inside {
  kHitsAtStart,   ///< as we do
  kOnlyExit,      ///< the start is no hit: one point less than ours
  kEntersBehind,  ///< the entry of the line, at a negative parameter
};

const std::map<std::string, Inside> kConventions = {
    {"", Inside::kHitsAtStart},
    {"inside start = distance 0", Inside::kHitsAtStart},
    {"inside start = hit at the origin, distance 0", Inside::kHitsAtStart},
    {"solid: inside start = fraction 0", Inside::kHitsAtStart},
    {"only the exit is reported", Inside::kOnlyExit},
    {"inside start = exit point", Inside::kOnlyExit},
    {"inside start = entry point behind the origin (backtracked)", Inside::kEntersBehind},
    {"raw slab value: negative entry fraction", Inside::kEntersBehind},
};

/// Kinds that are not ours, and how many cases of each.
const std::map<std::string, int> kNotOurs = {
    {"box_distance", 4},  // box against box
    {"box_cast", 2},      // a moving box against a box
};

/// A negative distance is a penetration depth: not offered. The solid has distance 0 there.
bool isPenetration(const Case& peer) {
  return peer.number("dist").value_or(0.0) < 0.0;
}

class PeerCases : public testing::Test {
 protected:
  void SetUp() override {
    const char* shared = std::getenv("BOX_QUERY_SHARED");
    if (shared == nullptr) {
      GTEST_SKIP() << "BOX_QUERY_SHARED is not set: it names the directory of peer_cases.csv";
    }
    const std::string path = std::string(shared) + "/peer_cases.csv";
    if (!std::ifstream(path)) {
      GTEST_SKIP() << "BOX_QUERY_SHARED: there is no " << path;
    }
    all_ = readCases(path);
  }

  /// The cases of some kinds of query.
  std::vector<Case> cases(const std::set<std::string>& kinds) const {
    std::vector<Case> some;
    for (const Case& peer : all_) {
      if (kinds.count(peer.text("query")) != 0) {
        some.push_back(peer);
      }
    }
    return some;
  }

  std::vector<Case> all_;
};

TEST_F(PeerCases, EveryKindIsOneOfOursOrKnownNotToBe) {
  std::map<std::string, int> counts;
  for (const Case& peer : all_) {
    ++counts[peer.text("query")];
  }
  std::map<std::string, int> expected = {
      {"ray", 120},
      {"line", 6},
      {"segment", 25},
      {"point_in_box", 77},
      {"point_distance", 4},
      {"point_signed_distance", 32},
      {"closest_point", 11},
      {"closest_surface_point", 15},
      {"segment_distance", 4},
  };
  expected.insert(kNotOurs.begin(), kNotOurs.end());
  EXPECT_EQ(counts, expected);
}

TEST_F(PeerCases, Rays) {
  int ran = 0;
  int hits = 0;
  int compared = 0;
  for (const Case& peer : cases({"ray"})) {
    SCOPED_TRACE(peer.text("id") + " " + peer.text("source") + " " + peer.text("note"));
    const Inside convention = kConventions.at(peer.text("inside_convention"));
    const double t_min = peer.number("tmin").value_or(0.0);
    const double max_range =
        peer.number("tmax").value_or(std::numeric_limits<double>::infinity()) - t_min;
    // A peer with a minimum range lets the ray start there.
    const Vector3 start = t_min == 0.0 ? peer.a() : peer.a() + t_min * peer.b().normalized();
    const Ray ray{start, peer.b()};
    const bool hit = peer.number("hit").value() != 0.0;
    for (const Box& box : forms(peer)) {
      const Scene scene({box});
      const Hit ours = scene.cast(ray, max_range);
      EXPECT_EQ(ours.hit, hit);
      EXPECT_EQ(scene.castAny(ray, max_range), hit);
      if (max_range == std::numeric_limits<double>::infinity()) {
        EXPECT_EQ(test(ray, box), hit);
      }
      if (!hit) {
        continue;
      }
      const Intersection of_ray = find(ray, box);
      const Intersection of_line = find(Line{ray.origin, ray.direction}, box);
      const bool behind = convention == Inside::kEntersBehind;
      compared += expectFound(peer, behind ? of_line : of_ray);
      if (const auto distance = peer.number("dist")) {
        EXPECT_NEAR(behind ? of_line.t_enter * ray.direction.norm() : ours.range, *distance,
                    peer.tolerance());
        ++compared;
      }
      if (const auto count = peer.number("n_hits")) {
        ++compared;
        const bool start_is_none = convention == Inside::kOnlyExit && of_ray.started_inside;
        EXPECT_EQ(of_ray.num_points - (start_is_none ? 1 : 0), static_cast<int>(*count));
      }
    }
    ++ran;
    hits += hit;
  }
  EXPECT_EQ(ran, 120);
  EXPECT_EQ(hits, 100);
  EXPECT_EQ(compared, 287);
}

TEST_F(PeerCases, LinesAndSegments) {
  int ran = 0;
  int hits = 0;
  int compared = 0;
  for (const Case& peer : cases({"line", "segment"})) {
    SCOPED_TRACE(peer.text("id") + " " + peer.text("source") + " " + peer.text("note"));
    ASSERT_EQ(kConventions.at(peer.text("inside_convention")), Inside::kHitsAtStart);
    const bool hit = peer.number("hit").value() != 0.0;
    const bool is_line = peer.text("query") == "line";
    const Line line{peer.a(), peer.b()};
    const Segment segment{peer.a(), peer.b()};
    for (const Box& box : forms(peer)) {
      EXPECT_EQ(is_line ? test(line, box) : test(segment, box), hit);
      const Intersection ours = is_line ? find(line, box) : find(segment, box);
      EXPECT_EQ(ours.num_points > 0, hit);
      if (hit) {
        compared += expectFound(peer, ours);
      }
    }
    ++ran;
    hits += hit;
  }
  EXPECT_EQ(ran, 31);
  EXPECT_EQ(hits, 16);
  EXPECT_EQ(compared, 48);
}

TEST_F(PeerCases, PointsInBoxes) {
  int ran = 0;
  std::map<std::string, int> outcomes;
  for (const Case& peer : cases({"point_in_box"})) {
    SCOPED_TRACE(peer.text("id") + " " + peer.text("source") + " " + peer.text("note"));
    const std::string& inside = peer.text("inside");
    for (const Box& box : forms(peer)) {
      EXPECT_EQ(test(Segment{peer.a(), peer.a()}, box), inside != "0");
      EXPECT_EQ(test(Ray{peer.a(), Vector3::Zero()}, box), inside != "0");
      if (inside == "surface") {
        // Away from the centre nothing but the start is in the box.
        const Ray leaving{peer.a(), peer.a() - orientedBox(peer).center};
        EXPECT_EQ(find(leaving, box).num_points, 1);
      }
    }
    ++ran;
    ++outcomes[inside];
  }
  EXPECT_EQ(ran, 77);
  const std::map<std::string, int> expected = {{"0", 29}, {"1", 43}, {"surface", 5}};
  EXPECT_EQ(outcomes, expected);
}

TEST_F(PeerCases, DistancesAndClosestPoints) {
  int compared = 0;
  int penetrations = 0;
  int on_surface_from_inside = 0;
  for (const Case& peer : cases({"point_distance", "point_signed_distance", "segment_distance",
                                 "closest_point", "closest_surface_point"})) {
    SCOPED_TRACE(peer.text("id") + " " + peer.text("source") + " " + peer.text("note"));
    const bool is_segment = peer.text("query") == "segment_distance";
    const Segment segment{peer.a(), is_segment ? peer.b() : peer.a()};
    const bool penetrates = isPenetration(peer);
    // The closest point of a solid to a point in it is that point itself, not one on its surface.
    const bool from_inside = peer.text("query") == "closest_surface_point" &&
                             testIntersection(segment, orientedBox(peer));
    penetrations += penetrates;
    on_surface_from_inside += from_inside;
    for (const Box& box : forms(peer)) {
      const SegmentDistance ours = segmentDistance(segment, box);
      if (penetrates || from_inside) {
        EXPECT_EQ(ours.distance, 0.0);
        continue;
      }
      if (const auto theirs = peer.number("dist")) {
        EXPECT_NEAR(ours.distance, *theirs, peer.tolerance());
        ++compared;
      }
      if (const auto theirs = peer.vector("closest", "_")) {
        expectNear(ours.on_box, *theirs, peer.tolerance());
        ++compared;
      }
    }
  }
  EXPECT_EQ(compared, 116);
  EXPECT_EQ(penetrations, 4);
  EXPECT_EQ(on_surface_from_inside, 7);
}

}  // namespace
}  // namespace box_query
