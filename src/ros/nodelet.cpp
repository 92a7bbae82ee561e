// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The node as a nodelet: boxes of publishers in the same manager come without a socket between.
#include "ros/node.h"

#include <memory>
#include <stdexcept>

#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.hpp>

namespace box_query {

/// Callbacks run on the node's own threads, not on those of the manager: a batch of minutes keeps
/// no other nodelet waiting, nor the manager from unloading this one.
class BoxQueryNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    try {
      node_ = std::make_unique<Node>(getNodeHandle(), getPrivateNodeHandle());
    } catch (const std::exception& error) {
      NODELET_FATAL_STREAM(error.what());
      throw;  // the manager says that loading failed, and not why
    }
  }

  std::unique_ptr<Node> node_;
};

}  // namespace box_query

PLUGINLIB_EXPORT_CLASS(box_query::BoxQueryNodelet, nodelet::Nodelet)
