// SPDX-License-Identifier: BSD-3-Clause
// Two threads change the same number: ThreadSanitizer must find that, though it does not see into
// roscpp and TBB, which start them.
//
//   PROGRAM callback|batch [guarded]    guarded: with a mutex, where there is nothing to be found
#include <box_query/batch.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include <ros/init.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <std_msgs/Empty.h>
#include <tbb/global_control.h>

namespace {

constexpr int kNoSecondThread = 3;

class Boxes {
 public:
  explicit Boxes(bool guarded) : guarded_(guarded) {}

  void count() {
    std::unique_lock<std::mutex> lock(mutex_, std::defer_lock);
    if (guarded_) {
      lock.lock();
    }
    ++count_;
  }

 private:
  const bool guarded_;
  std::mutex mutex_;
  int count_ = 0;
};

/// Threads that have come. It does not order what they did before.
class Arrivals {
 public:
  void add() { number_.fetch_add(1, std::memory_order_relaxed); }

  /// Whether so many come within 30 s.
  bool become(int number) const {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (number_.load(std::memory_order_relaxed) < number) {
      if (std::chrono::steady_clock::now() > deadline) {
        return false;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return true;
  }

 private:
  std::atomic<int> number_{0};
};

/// A callback of ROS, and the main thread after it.
int countInCallback(Boxes& boxes) {
  ros::NodeHandle node;
  Arrivals callbacks;
  const ros::Subscriber subscriber = node.subscribe<std_msgs::Empty>(
      "planted_race", 1, [&](const std_msgs::Empty::ConstPtr& /*message*/) {
        boxes.count();
        callbacks.add();
      });
  const ros::Publisher publisher = node.advertise<std_msgs::Empty>("planted_race", 1, true);
  ros::AsyncSpinner spinner(1);
  spinner.start();
  publisher.publish(std_msgs::Empty());
  if (!callbacks.become(1)) {
    return kNoSecondThread;
  }
  boxes.count();
  return 0;
}

/// Two threads of a batch, each once.
int countInBatch(Boxes& boxes) {
  using Limit = tbb::global_control;
  const Limit limit(Limit::max_allowed_parallelism, 2);  // even on one core
  Arrivals threads;
  std::atomic<int> alone{0};
  box_query::forEachPart(100000, 2, [&](std::size_t /*begin*/, std::size_t /*end*/) {
    thread_local bool came = false;
    if (!came) {
      came = true;
      boxes.count();
      threads.add();
      alone += !threads.become(2);
    }
  });
  return alone == 0 ? 0 : kNoSecondThread;
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "planted_race", ros::init_options::AnonymousName);
  const std::string where = argc > 1 ? argv[1] : "";
  Boxes boxes(argc > 2 && argv[2] == std::string("guarded"));
  return where == "callback" ? countInCallback(boxes) : countInBatch(boxes);
}
