// SPDX-License-Identifier: BSD-3-Clause
#include "load/run.h"

#include "load/memory.h"

#include <chrono>
#include <stdexcept>
#include <thread>

#include <ros/service.h>

namespace box_query::load {
namespace {

constexpr std::chrono::seconds kPatience(30);

/// Until every topic is heard, and tf goes back as far as clients ask.
void waitForScene() {
  using Clock = std::chrono::steady_clock;
  if (!ros::service::waitForService("/box_query/get_scene", ros::Duration(kPatience.count()))) {
    throw std::runtime_error("there is no node /box_query");
  }
  const Clock::time_point deadline = Clock::now() + kPatience;
  GetScene scene;
  do {
    if (Clock::now() > deadline) {
      throw std::runtime_error("the scene does not become complete: " + scene.response.reason);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    scene.request.namespaces = witnessNamespaces();
  } while (!ros::service::call("/box_query/get_scene", scene) || !scene.response.complete);
  std::this_thread::sleep_for(std::chrono::seconds(2));
}

}  // namespace

Measured askAndCheck(double seconds, std::size_t oracle_step) {
  waitForScene();
  Measured measured;
  measured.seconds = seconds;
  SceneLog scenes;
  MemoryWatch memory(processOf("/box_query"));
  measured.answers = ask(seconds, 1, scenes);
  memory.stop();
  measured.early_memory = memory.at(seconds / 3.0);
  measured.late_memory = memory.at(seconds);
  measured.scenes = scenes.facts();
  measured.verdict = check(measured.answers, measured.scenes, oracle_step,
                           std::max(1U, std::thread::hardware_concurrency()));
  return measured;
}

}  // namespace box_query::load
