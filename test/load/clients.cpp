// SPDX-License-Identifier: BSD-3-Clause
#include "load/clients.h"

#include <thread>

namespace box_query::load {
namespace {

Answer askOne(std::uint64_t seed, bool persistent, Caller& caller) {
  Answer answer;
  answer.seed = seed;
  answer.persistent = persistent;
  answer.start = ros::Time::now();
  answer.asked = tickAt(answer.start);
  const Request request = questionOf(seed, answer.asked);
  answer.service = static_cast<std::uint8_t>(request.index());
  const Bytes bytes = bytesOf(request);
  answer.start = ros::Time::now();
  bool answered = caller.call(request.index(), bytes, answer.response);
  if (!answered && !persistent) {
    answer.first_try_failed = true;
    answered = caller.call(request.index(), bytes, answer.response);
  }
  answer.end = ros::Time::now();
  answer.lost = !answered;
  return answer;
}

}  // namespace

Said readSaid(const Bytes& response) {
  // The stream only reads.
  ros::serialization::IStream stream(const_cast<std::uint8_t*>(response.data.data()),
                                     static_cast<std::uint32_t>(response.data.size()));
  std::uint8_t success = 0;
  Said said;
  stream.next(success);
  stream.next(said.message);
  stream.next(said.scene_id);
  said.success = success != 0;
  return said;
}

std::vector<Answer> ask(double seconds, unsigned seed, SceneLog& scenes) {
  const ros::Time end = ros::Time::now() + ros::Duration(seconds);
  std::vector<std::vector<Answer>> answers(kClients);
  std::vector<std::thread> threads;
  for (std::size_t client = 0; client < kClients; ++client) {
    threads.emplace_back([&, client] {
      const bool persistent = client % 2 == 0;
      Caller caller(persistent);
      Caller learner(true);
      std::uint64_t number = (std::uint64_t{seed} * kClients + client) << 32;
      while (ros::Time::now() < end) {
        Answer answer = askOne(number++, persistent, caller);
        if (!answer.lost) {
          answer.scene_id = readSaid(answer.response).scene_id;
          scenes.learn(answer.scene_id, learner);
        }
        answers[client].push_back(std::move(answer));
      }
    });
  }
  std::vector<Answer> all;
  for (std::size_t client = 0; client < kClients; ++client) {
    threads[client].join();
    std::move(answers[client].begin(), answers[client].end(), std::back_inserter(all));
  }
  return all;
}

}  // namespace box_query::load
