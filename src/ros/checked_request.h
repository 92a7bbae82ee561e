// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Service requests that are decoded with every length checked before anything is allocated.
///
/// roscpp allocates what a length prefix claims: a request of a few bytes can make a server touch
/// gigabytes before its handler runs, and what does not fit ends as an exception that no client
/// ever reads. A CheckedRequest is what the generated code reads from a stream of our own instead.
/// It has the service's own md5, decodes the same bytes, and hands a refusal to the handler as a
/// sentence.
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include <boost/function.hpp>
#include <boost/make_shared.hpp>
#include <ros/advertise_service_options.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/serialization.h>

namespace box_query {

template <class Request>
struct CheckedRequest {
  /// An array with more elements is refused.
  std::uint32_t max_array_length = 0;
  Request request;
  /// Why the request could not be decoded; it is then empty. Empty if it could.
  std::string problem;
};

/// What the generated serializers read from: ros::serialization::IStream with checked lengths.
class CheckedStream {
 public:
  CheckedStream(std::uint8_t* data, std::uint32_t size, std::uint32_t max_array_length)
      : data_(data), end_(data + size), max_array_length_(max_array_length) {}

  std::uint8_t* advance(std::uint32_t size) {
    if (size > left()) {
      throwCutShort(size);
    }
    std::uint8_t* const begin = data_;
    data_ += size;
    return begin;
  }

  template <class T>
  void next(T& value) {
    ros::serialization::deserialize(*this, value);
  }

  template <class T, class Allocator>
  void next(std::vector<T, Allocator>& values) {
    CheckedStream ahead = *this;
    std::uint32_t length = 0;
    ahead.next(length);
    // A default-constructed element is the shortest one.
    const std::uint64_t element_size = ros::serialization::serializationLength(T());
    if (length > max_array_length_ || length * element_size > ahead.left()) {
      ahead.throwTooLong(length);
    }
    ros::serialization::deserialize(*this, values);
  }

  /// @throws std::runtime_error if something is left.
  void expectEnd() const;

 private:
  std::size_t left() const { return static_cast<std::size_t>(end_ - data_); }
  [[noreturn]] void throwCutShort(std::uint32_t size) const;
  [[noreturn]] void throwTooLong(std::uint32_t length) const;

  std::uint8_t* data_;
  std::uint8_t* end_;  ///< not how much is left: one number less to keep for each that is read
  std::uint32_t max_array_length_;
};

/// Advertises a service whose handler gets checked requests, and is called on `queue`. roscpp may
/// still be handing over a request when the service has been shut down: the queue lives until that
/// is done. Disable and clear it then, so that nothing keeps it for good.
template <class Service>
ros::ServiceServer advertiseChecked(
    ros::NodeHandle& nh, const std::string& name, std::uint32_t max_array_length,
    const std::shared_ptr<ros::CallbackQueue>& queue,
    const boost::function<bool(CheckedRequest<typename Service::Request>&,
                               typename Service::Response&)>& handler) {
  using Request = CheckedRequest<typename Service::Request>;
  using Response = typename Service::Response;
  ros::AdvertiseServiceOptions options;
  options.service = name;
  options.md5sum = ros::service_traits::md5sum<Service>();
  options.datatype = ros::service_traits::datatype<Service>();
  options.req_datatype = ros::message_traits::datatype<typename Service::Request>();
  options.res_datatype = ros::message_traits::datatype<Response>();
  options.callback_queue = queue.get();
  options.helper =
      boost::make_shared<ros::ServiceCallbackHelperT<ros::ServiceSpec<Request, Response>>>(
          handler, [max_array_length, queue] {
            auto request = boost::make_shared<Request>();
            request->max_array_length = max_array_length;
            return request;
          });
  return nh.advertiseService(options);
}

}  // namespace box_query

namespace ros::serialization {

template <class Request>
struct Serializer<box_query::CheckedRequest<Request>> {
  static void read(IStream& stream, box_query::CheckedRequest<Request>& checked) {
    try {
      box_query::CheckedStream bytes(stream.getData(), stream.getLength(),
                                     checked.max_array_length);
      bytes.next(checked.request);
      bytes.expectEnd();
    } catch (const std::exception& error) {
      checked.request = Request();
      checked.problem = error.what();
    }
  }
};

}  // namespace ros::serialization
