// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ros/periodic.h"

#include <string>
#include <vector>

#include <xmlrpcpp/XmlRpcValue.h>

namespace box_query {

/// Keeps what the master knows of this process true where it is restarted: the new one knows
/// nobody, and roscpp does not notice. Looks four times a second, from a thread of its own.
///
/// Nothing is subscribed or advertised anew: connections stay, and with them the messages of
/// publishers that do not register again themselves.
class Registration {
 public:
  /// Of all topics of the process, those that come later too, and of what services roscpp has.
  Registration();
  /// Of all topics and these services, and of the parameters that are set in the namespace `ns`
  /// now: they are set again where the new master has no others.
  Registration(std::vector<std::string> services, std::string ns);

 private:
  void renew();
  /// Whether the master is there and does not know the first service, which nobody else would tell
  /// it of; not where another node has taken the name of this one.
  bool isMissing() const;
  bool tellMaster() const;

  std::vector<std::string> services_;
  std::string service_address_;
  std::string ns_;
  XmlRpc::XmlRpcValue parameters_;  ///< a struct, or invalid if there are none
  bool broken_off_ = false;         ///< the master went again before it knew all
  Periodic watch_;                  // last: it uses the others
};

}  // namespace box_query
