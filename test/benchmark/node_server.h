// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The other side of the benchmark of the node: a process that has both the node and what it is
/// compared with.
#pragma once

namespace box_query::benchmark {

constexpr const char* kServerArgument = "--serve";

/// Names of services and topics are those of the node, as in its namespace.
constexpr const char* kNode = "/box_query/";
constexpr const char* kPlain = "/plain/";
constexpr const char* kNodeBoxes = "/boxes";
constexpr const char* kPlainBoxes = "/plain_boxes";
constexpr const char* kFrame = "map";

/// Runs the node /box_query, which hears kNodeBoxes, and beside it, plain roscpp:
/// - cast_rays and check_segments that do nothing but say what the node has said to the first
///   request with the same header.seq;
/// - cast_ray that is answered from a Scene, built of each message on kPlainBoxes as it comes.
/// Returns at SIGTERM.
int serve(int argc, char** argv);

}  // namespace box_query::benchmark
