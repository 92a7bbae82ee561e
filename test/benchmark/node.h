// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What the node costs beside the library that it puts services in front of: round trips, and
/// boxes from the wire to an answer.
#pragma once

#include "benchmark/timing.h"

#include <cstddef>
#include <functional>
#include <regex>
#include <string>
#include <vector>

namespace box_query::benchmark {

struct NodeClient;

/// A request to a batch service, beside the same bytes to and from a service that does nothing, and
/// the library's own call. In microseconds: of each connection the lower quartile.
struct CallRow {
  std::string service;  ///< "cast_rays", "check_segments"
  std::string asks;     ///< what the request asks for
  std::size_t boxes = 0;
  std::size_t queries = 0;
  int threads = 0;        ///< that work on the batch, of the node and of the library; 0: all
  std::size_t bytes = 0;  ///< of request and response
  Spread node;
  Spread empty;
  Spread library;
  Spread ratio;  ///< of node to empty plus library, connection by connection
  std::size_t asked = 0;
  std::size_t wrong = 0;  ///< answers that are not the library's to the last bit
};

struct CallOptions {
  std::regex only{".*"};  ///< "SERVICE ASKS BOXES QUERIES THREADS"
  int threads = 1;        ///< ~batch_threads of the node, and the library's
  std::vector<std::size_t> boxes = {32, 1000};
  std::vector<std::size_t> queries = {1, 100, 10000};
  int connections = 15;
  int rounds =
      60;  ///< calls of each contender a connection; a quarter where there are many queries
};

/// Calls `print` with every row as it is measured.
/// @throws std::runtime_error if a service cannot be reached or does not answer.
void measureCalls(NodeClient& client, const CallOptions& options,
                  const std::function<void(const CallRow&)>& print);

/// A message with boxes, from when it is on the wire to the first answer from the scene of it;
/// beside a plain node that roscpp decodes for, and that builds a new scene of every message. In
/// microseconds.
struct BoxesRow {
  /// Over all messages. The worst of hundreds is mostly that of another program, or of the host of
  /// a virtual machine, which took a core away for milliseconds: of the rest says most what 95 of
  /// 100 do not exceed.
  struct Times {
    double median = 0.0;
    double most = 0.0;  ///< quantile 0.95
    double worst = 0.0;
  };

  std::size_t boxes = 0;
  double rate = 0.0;  ///< [Hz]
  std::size_t messages = 0;
  std::size_t late = 0;  ///< messages that were published after their time
  Times node;
  Times plain;
  double decode = 0.0;    ///< by roscpp, without any node, between messages: median
  double build = 0.0;     ///< of the scene, as well
  std::size_t asked = 0;  ///< answers of both
  std::size_t wrong = 0;  ///< that are not those of the scene that they name
};

struct BoxesOptions {
  std::regex only{".*"};  ///< "boxes BOXES HZ"
  std::vector<std::size_t> boxes = {100, 1000, 10000};
  std::vector<double> rates = {10.0, 30.0};
  double seconds = 10.0;  ///< a row
};

/// The same for boxes.
void measureBoxes(NodeClient& client, const BoxesOptions& options,
                  const std::function<void(const BoxesRow&)>& print);

}  // namespace box_query::benchmark
