// SPDX-License-Identifier: BSD-3-Clause
// Every field of every request, with every kind of garbage: the request is answered, or refused
// with a sentence that names the field.
#include "ros/checked_request.h"
#include "ros/request_checks.h"
#include "unit/answer_fixture.h"
#include "unit/recorded_fields.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

namespace box_query::test {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Kind = RecordedField::Kind;

/// As the server does, but for tf.
template <class Request>
void serve(const Request& request) {
  check(request, Limits());
  const Snapshot snapshot = randomSnapshot(5, 3);
  if constexpr (std::is_same_v<Request, GetSceneRequest>) {
    GetSceneResponse response;
    answer(request, snapshot, ros::Time(100), response);
  } else {
    Context context = {snapshot, ros::Time(100), FrameChange(), Drawing()};
    typename ResponseTo<Request>::type response;
    answer(request, context, response);
  }
}

/// The sentence with which the bytes are refused; empty if they are answered.
template <class Request>
std::string served(const Bytes& bytes) {
  Bytes exact = bytes;
  CheckedRequest<Request> checked;
  checked.max_array_length = 1000;
  ros::serialization::IStream stream(exact.data(), static_cast<std::uint32_t>(exact.size()));
  ros::serialization::deserialize(stream, checked);
  if (!checked.problem.empty()) {
    return checked.problem;
  }
  try {
    serve(checked.request);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

template <class Request>
Request withFilters() {
  Request request;
  request.topics = {"/a", "b"};
  request.namespaces = {"rack"};
  request.labels = {"tote"};
  request.ignore_topics = {"/a"};
  request.ignore_namespaces = {"rack"};
  request.ignore_ids = {3};
  if constexpr (!std::is_same_v<Request, GetSceneRequest>) {
    request.header.frame_id = "map";
  }
  return request;
}

template <class Request>
std::vector<Request> examples();

template <>
std::vector<CastRayRequest> examples() {
  auto request = withFilters<CastRayRequest>();
  request.direction = vector(1, 2, 3);
  request.max_range = 5;
  return {request};
}
template <>
std::vector<CastRaysRequest> examples() {
  auto request = withFilters<CastRaysRequest>();
  request.origins.resize(2);
  request.directions.assign(2, vector(1, 2, 3));
  request.max_ranges = {1, 2};
  return {request};
}
template <>
std::vector<CheckSegmentRequest> examples() {
  auto request = withFilters<CheckSegmentRequest>();
  request.end = point(1, 2, 3);
  request.radius = 0.5;
  return {request};
}
template <>
std::vector<CheckSegmentsRequest> examples() {
  auto request = withFilters<CheckSegmentsRequest>();
  request.points.assign(4, point(1, 2, 3));
  request.radii = {0.5};
  request.want_clearances = request.want_points = request.want_blocked_at = 1;
  return {request};
}
template <>
std::vector<FindIntersectionsRequest> examples() {
  auto ray = withFilters<FindIntersectionsRequest>();
  ray.component = FindIntersectionsRequest::RAY;
  ray.direction = vector(1, 2, 3);
  ray.end = point(1, 2, 3);
  auto segment = ray;
  segment.component = FindIntersectionsRequest::SEGMENT;
  return {ray, segment};
}
template <>
std::vector<GetSceneRequest> examples() {
  return {withFilters<GetSceneRequest>()};
}

/// Whether a number may be the first, second or third of this field of the examples.
bool isAccepted(const std::string& field, double number) {
  const double size = std::abs(number);
  if (field.rfind("max_range", 0) == 0) {
    return number >= 0;
  }
  const bool is_moderate = size == 0 || (size >= 1e-200 && size <= 1e7);
  if (field == "radius" || field == "radii") {
    return number >= 0 && is_moderate;
  }
  if (field == "direction" || field == "directions") {  // beside two from 1 to 3
    return size == 0 || (size >= 3e-60 && size <= 1e60);
  }
  return is_moderate;
}

template <class Request>
class Garbage : public testing::Test {};

using Requests = testing::Types<CastRayRequest, CastRaysRequest, CheckSegmentRequest,
                                CheckSegmentsRequest, FindIntersectionsRequest, GetSceneRequest>;
TYPED_TEST_SUITE(Garbage, Requests);

/// Calls visit(example, field, its name, bytes of the example).
template <class Request, class Visit>
void forEachField(const Visit& visit) {
  const std::vector<std::string> names = fieldNames<Request>();
  for (const Request& example : examples<Request>()) {
    const Bytes bytes = bytesOf(example);
    ASSERT_EQ(served<Request>(bytes), "");
    const std::vector<RecordedField> fields = fieldsOf(example);
    ASSERT_EQ(fields.back().top + 1, names.size()) << "every field is visited";
    for (const RecordedField& field : fields) {
      visit(example, field, names[field.top], bytes);
    }
  }
}

template <class Request>
bool isIgnored(const Request& /*request*/, const std::string& /*field*/) {
  return false;
}
bool isIgnored(const FindIntersectionsRequest& request, const std::string& field) {
  return field == (request.component == FindIntersectionsRequest::SEGMENT ? "direction" : "end");
}

TYPED_TEST(Garbage, InNumbersIsRefusedByTheNameOfTheField) {
  std::size_t refused = 0;
  forEachField<TypeParam>([&](const TypeParam& example, const RecordedField& field,
                              const std::string& name, const Bytes& bytes) {
    for (const double number : hostileDoubles()) {
      if (field.kind != Kind::kDouble) {
        continue;
      }
      const std::string sentence = served<TypeParam>(withValue(bytes, field, number));
      if (isIgnored(example, name) || isAccepted(name, number)) {
        EXPECT_EQ(sentence, "") << name << " " << number;
      } else {
        EXPECT_EQ(sentence.find(name), 0U) << name << " " << number << ": " << sentence;
        ++refused;
      }
    }
  });
  EXPECT_TRUE(refused > 0 || (std::is_same_v<TypeParam, GetSceneRequest>));
}

TYPED_TEST(Garbage, InIntegersIsRefusedByTheNameOfTheField) {
  forEachField<TypeParam>([&](const TypeParam& /*example*/, const RecordedField& field,
                              const std::string& name, const Bytes& bytes) {
    for (const std::uint64_t number : hostileIntegers()) {
      if (field.kind != Kind::kInteger) {
        continue;
      }
      Bytes spoilt = bytes;
      std::memcpy(&spoilt[field.at], &number, field.size);
      const std::string sentence = served<TypeParam>(spoilt);
      const auto byte = static_cast<std::uint8_t>(number);
      const bool is_choice = name == "mode" || name == "shape" || name == "component";
      const bool is_good = !is_choice || byte < (name == "component" ? 3 : 2);
      EXPECT_EQ(sentence.rfind(is_good ? "" : name + " is ", 0), 0U) << name << ": " << sentence;
      EXPECT_EQ(sentence.empty(), is_good) << name << " " << number << ": " << sentence;
    }
  });
}

TYPED_TEST(Garbage, InTimesIsRefusedByTheNameOfTheField) {
  std::size_t times = 0;
  forEachField<TypeParam>([&](const TypeParam& /*example*/, const RecordedField& field,
                              const std::string& name, const Bytes& bytes) {
    if (field.kind != Kind::kTime) {
      return;
    }
    ++times;
    EXPECT_EQ(served<TypeParam>(withValue(bytes, field, std::uint64_t{0xffffffff})), "") << name;
    const std::string sentence = served<TypeParam>(withValue(bytes, field, ~std::uint64_t{0}));
    EXPECT_EQ(sentence.find(name), 0U) << sentence;
    EXPECT_NE(sentence.find("4294967295 nanoseconds"), std::string::npos) << sentence;
  });
  EXPECT_GT(times, 0U);
}

TYPED_TEST(Garbage, InStringsIsRefusedByTheNameOfTheFieldOrIsNobodysName) {
  forEachField<TypeParam>([&](const TypeParam& /*example*/, const RecordedField& field,
                              const std::string& name, const Bytes& bytes) {
    for (const std::string& text : hostileStrings()) {
      if (field.kind != Kind::kString) {
        continue;
      }
      const std::string sentence = served<TypeParam>(withString(bytes, field, text));
      const bool is_good = text.size() <= 255 && !(name == "header" && text.empty());
      EXPECT_EQ(sentence.empty(), is_good) << name << " '" << text.substr(0, 9) << "'";
      EXPECT_EQ(sentence.find(is_good ? "" : name), 0U) << sentence;
      EXPECT_LT(sentence.size(), 300U) << "a sentence does not repeat garbage";
    }
  });
}

TYPED_TEST(Garbage, InLengthsIsRefused) {
  forEachField<TypeParam>([&](const TypeParam& /*example*/, const RecordedField& field,
                              const std::string& name, const Bytes& bytes) {
    if (field.kind != Kind::kString && field.kind != Kind::kCount) {
      return;
    }
    for (const std::uint32_t length : wrongLengths(field.size)) {
      const std::string sentence = served<TypeParam>(withValue(bytes, field, length));
      // One less or more may make a request of another meaning.
      EXPECT_TRUE(length <= field.size + 1000 || sentence.rfind("malformed request", 0) == 0 ||
                  sentence.rfind("too large a request", 0) == 0)
          << name << " " << length << ": " << sentence;
    }
  });
}

TEST(GarbageTransform, IsRefusedByTheNameOfItsFrame) {
  EXPECT_NO_THROW(checkFrame("robot", {1e7, -1e7, 5e-324}, Limits()));
  for (const double number : {1.1e7, -1e300, kNan, -kInf}) {
    try {
      checkFrame("robot", {0, number, 0}, Limits());
      ADD_FAILURE() << number;
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(std::string(error.what()).find("frame 'robot' is at (0, "), 0U) << error.what();
    }
  }
}

/// The sentence with which a batch is refused.
std::string refusalOfBatch(const Parameters& parameters, std::size_t rays, std::size_t names,
                           std::size_t name_length, double x) {
  CastRaysRequest request;
  request.header.frame_id = "map";
  request.origins.assign(rays, point(x, 0, 0));
  request.directions.assign(rays, vector(1, 0, 0));
  request.labels.assign(names, std::string(name_length, 'l'));
  try {
    check(request, Limits(parameters));
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(BoundsOfARequest, AreThoseOfTheParameters) {
  Parameters parameters;
  parameters.max_queries_per_call = 2;
  parameters.max_filter_names = 3;
  parameters.max_name_length = 4;
  parameters.max_coordinate = 5.0;
  EXPECT_EQ(refusalOfBatch(parameters, 2, 3, 4, 5.0), "");
  for (const auto& [refused, name] :
       {std::pair{refusalOfBatch(parameters, 3, 3, 4, 5.0), "~max_queries_per_call"},
        std::pair{refusalOfBatch(parameters, 2, 4, 4, 5.0), "~max_filter_names"},
        std::pair{refusalOfBatch(parameters, 2, 3, 5, 5.0), "~max_name_length"},
        std::pair{refusalOfBatch(parameters, 2, 3, 4, 5.5), "~max_coordinate"}}) {
    EXPECT_NE(refused.find(name), std::string::npos) << refused;
  }
}

TEST(GarbageFilters, AreNoLongerThanAllowed) {
  const auto with = [](std::size_t names, auto field) {
    GetSceneRequest request;
    (request.*field).resize(names);
    return refusal(request);
  };
  using Request = GetSceneRequest;
  for (const auto field : {&Request::topics, &Request::namespaces, &Request::labels,
                           &Request::ignore_topics, &Request::ignore_namespaces}) {
    EXPECT_EQ(with(10000, field), "");
    EXPECT_NE(with(10001, field).find(" has 10001 elements, at most 10000 are taken"),
              std::string::npos);
  }
  EXPECT_EQ(with(10001, &Request::ignore_ids),
            "ignore_ids has 10001 elements, at most 10000 are taken: split the request, or raise "
            "~max_filter_names");
}

}  // namespace
}  // namespace box_query::test
