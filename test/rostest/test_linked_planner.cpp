// SPDX-License-Identifier: BSD-3-Clause
// A planner that links the library and casts 1e6 rays while boxes stream in. Its thread locks no
// mutex, and what that costs beside a Scene alone is printed.
#include "rostest/monitor_fixture.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <iostream>
#include <random>
#include <set>

#include <dlfcn.h>
#include <pthread.h>
#include <ros/init.h>

namespace {
thread_local std::uint64_t locked_mutexes = 0;
}  // namespace

/// In front of the C library's, for every library of this process.
extern "C" int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  using Lock = int (*)(pthread_mutex_t*);
  static const auto lock = reinterpret_cast<Lock>(dlsym(RTLD_NEXT, "pthread_mutex_lock"));
  ++locked_mutexes;
  return lock(mutex);
}

namespace box_query {
namespace {

using std::chrono::steady_clock;

constexpr std::size_t kRaysPerPlan = 1000;
#ifdef __SANITIZE_THREAD__
constexpr std::size_t kPlans = 50;  // each takes twenty times as long
#else
constexpr std::size_t kPlans = 1000;
#endif

/// A wall of 32 x 32 cubes, its front `distance` ahead of the planner.
visualization_msgs::MarkerArray wallAt(double distance) {
  std::vector<visualization_msgs::Marker> cubes;
  for (int id = 0; id < 1024; ++id) {
    cubes.push_back(cube("map", id, distance + 0.5, id / 32 - 15.5, id % 32 - 15.5));
  }
  return array(cubes);
}

/// Rays that meet the wall, with the distance of its front as their parameter there.
std::vector<Ray> raysAhead() {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> sideways(-0.8, 0.8);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < kRaysPerPlan; ++i) {
    rays.push_back({Vector3::Zero(), Vector3(1.0, sideways(random), sideways(random))});
  }
  return rays;
}

/// Calls `say(n)` for n = 1, 2, ... thirty times a second, from a thread of its own.
class Stream {
 public:
  explicit Stream(const std::function<void(int)>& say)
      : thread_([this, say] {
          auto next = steady_clock::now();
          for (int n = 1; !stop_; ++n) {
            say(n);
            std::this_thread::sleep_until(next += std::chrono::microseconds(33333));
          }
        }) {}
  ~Stream() {
    stop_ = true;
    thread_.join();
  }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

 private:
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

/// [ns] a ray that `plan` takes; its locks are added to `locks`.
template <class Plan>
double timed(const Plan& plan, std::uint64_t& locks) {
  const std::uint64_t locked_before = locked_mutexes;
  const auto start = steady_clock::now();
  plan();
  const std::chrono::duration<double, std::nano> time = steady_clock::now() - start;
  locks += locked_mutexes - locked_before;
  return time.count() / kRaysPerPlan;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

class LinkedPlanner : public MonitorOfOneTopic {
 protected:
  void SetUp() override {
    start();
    talker_->say(wallAt(8.0));
    ASSERT_TRUE(eventually([this] { return monitor_->scene()->scene.size() == 1024; }))
        << "scene() must be enough to have scenes built";
  }

  const std::vector<Ray> rays_ = raysAhead();
};

TEST_F(LinkedPlanner, LocksNothingAndSeesEveryMessageWhole) {
  const Scene bare = monitor_->scene()->scene;
  std::set<std::uint64_t> scenes;
  std::size_t hits = 0;
  std::size_t torn = 0;
  std::uint64_t locks = 0;
  std::array<std::vector<double>, 3> ns;  // the bare scene, one snapshot a plan, one a ray

  const Stream stream([this](int n) { talker_->say(wallAt(8.0 + n % 8)); });
  const auto deadline = steady_clock::now() + std::chrono::seconds(60);
  for (std::size_t plan = 0; plan < kPlans || scenes.size() < 5; ++plan) {
    ASSERT_LT(steady_clock::now(), deadline) << "the wall does not move";
    ns[0].push_back(timed(
        [&] {
          for (const Ray& ray : rays_) {
            hits += bare.cast(ray).t == 8.0;
          }
        },
        locks));
    ns[1].push_back(timed(
        [&] {
          const SnapshotPtr snapshot = monitor_->scene();
          scenes.insert(snapshot->id);
          const double front = snapshot->scene.cast(rays_[0]).t;
          for (const Ray& ray : rays_) {
            const double t = snapshot->scene.cast(ray).t;
            torn += t != front;
            hits += t >= 8.0 && t <= 15.0;
          }
        },
        locks));
    ns[2].push_back(timed(
        [&] {
          for (const Ray& ray : rays_) {
            const double t = monitor_->scene()->scene.cast(ray).t;
            hits += t >= 8.0 && t <= 15.0;
          }
        },
        locks));
  }
  EXPECT_EQ(hits, 3 * ns[0].size() * kRaysPerPlan);
  EXPECT_EQ(torn, 0U);
  EXPECT_EQ(locks, 0U);
  std::cout << ns[0].size() * kRaysPerPlan << " rays each, " << scenes.size()
            << " scenes of 1024 boxes; median ns a ray: the bare Scene " << median(ns[0])
            << ", scene() once a plan of 1000 " << median(ns[1]) << ", scene() for every ray "
            << median(ns[2]) << std::endl;
}

TEST_F(LinkedPlanner, WouldBeSeenToLock) {
  std::uint64_t locks = 0;
  timed([this] { monitor_->currentScene(); }, locks);
  EXPECT_GT(locks, 0U);
}

}  // namespace
}  // namespace box_query

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_linked_planner");
  const ros::NodeHandle keeps_ros_alive;
  return RUN_ALL_TESTS();
}
