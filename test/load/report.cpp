// SPDX-License-Identifier: BSD-3-Clause
#include "load/report.h"

#include "benchmark/format.h"
#include "benchmark/timing.h"

#include <algorithm>
#include <string>

namespace box_query::load {
namespace {

using benchmark::Bar;
using benchmark::format;
using benchmark::quantile;

constexpr std::size_t kMostSentences = 10;

void printQuantiles(const std::string& name, const std::vector<double>& ms, std::ostream& out) {
  if (ms.empty()) {
    return;
  }
  out << format("%-32s %8zu", name.c_str(), ms.size());
  for (const double share : {0.5, 0.9, 0.99, 0.999, 1.0}) {
    out << format(" %8.2f", quantile(ms, share));
  }
  out << '\n';
}

std::vector<double> latencies(const std::vector<Answer>& answers, std::size_t service,
                              bool persistent) {
  std::vector<double> ms;
  for (const Answer& answer : answers) {
    if (!answer.lost && answer.persistent == persistent &&
        (service == kServices || answer.service == service)) {
      ms.push_back(answer.milliseconds());
    }
  }
  return ms;
}

void printSentences(const char* what, const std::vector<std::string>& sentences,
                    std::ostream& out) {
  for (std::size_t i = 0; i < std::min(kMostSentences, sentences.size()); ++i) {
    out << what << ": " << sentences[i] << '\n';
  }
}

}  // namespace

std::size_t Measured::lost() const {
  return static_cast<std::size_t>(
      std::count_if(answers.begin(), answers.end(), [](const Answer& each) { return each.lost; }));
}

std::size_t Measured::firstTriesFailed() const {
  return static_cast<std::size_t>(std::count_if(
      answers.begin(), answers.end(), [](const Answer& each) { return each.first_try_failed; }));
}

bool Measured::isFlawless() const {
  return verdict.rights() > 0 && verdict.rights() + verdict.refused.size() == answers.size();
}

void print(const Measured& measured, std::ostream& out) {
  const Verdict& verdict = measured.verdict;
  out << format("%-32s %8s %8s %8s %8s %8s %8s\n", "ms", "answers", "median", "90 %", "99 %",
                "99.9 %", "longest");
  for (const bool persistent : {true, false}) {
    const std::string connection = persistent ? ", kept connection" : ", new one";
    for (std::size_t service = 0; service < kServices; ++service) {
      printQuantiles(services()[service].name + connection,
                     latencies(measured.answers, service, persistent), out);
    }
    printQuantiles("all" + connection, latencies(measured.answers, kServices, persistent), out);
  }
  printQuantiles("age of the scene", verdict.ages, out);
  out << format(
      "\n%zu clients asked for %.0f s: %zu questions, %zu answered rightly from %zu "
      "scenes (%zu checked by the oracle too), %zu of which met a box in a complete "
      "scene and %zu in a moving frame; %zu wrong, %zu lost, %zu from scenes that were "
      "kept no more, %zu refused since a new transform was late; %zu first tries of new "
      "connections failed\n",
      kClients, measured.seconds, measured.answers.size(), verdict.rights(), measured.scenes.size(),
      verdict.by_oracle, verdict.complete, verdict.moved, verdict.wrong.size(), measured.lost(),
      verdict.unknown_scenes, verdict.refused.size(), measured.firstTriesFailed());
  printSentences("wrong", verdict.wrong, out);
  printSentences("refused", verdict.refused, out);
}

std::vector<Bar> barsOf(const Measured& measured) {
  const Verdict& verdict = measured.verdict;
  const QueriesBesideMessage& message = measured.beside_message;
  const MessagesBesideBatch& batch = measured.beside_batch;
  const auto count = [](std::size_t n) { return static_cast<double>(n); };
  return {
      {"wrong answers", count(verdict.wrong.size()), Bar::kAtMost, 0.0, "",
       format("of %zu, from %zu scenes", measured.answers.size(), measured.scenes.size())},
      {"lost answers", count(measured.lost() + verdict.unknown_scenes), Bar::kAtMost, 0.0, "",
       format("%zu of them from scenes that were kept no more; %zu first tries failed",
              verdict.unknown_scenes, measured.firstTriesFailed())},
      {"resident memory at the end over that at a third of the time",
       measured.late_memory / measured.early_memory, Bar::kAtMost, 1.02, "",
       format("%.1f MB after %.1f MB", measured.late_memory, measured.early_memory)},
      {"longest query beside a message of 1e6 boxes over the time that it takes to come in",
       message.share(), Bar::kAtMost, 0.1, "",
       format("%.1f ms of %.0f ms, %zu queries; before it %.1f ms", message.longest_ms,
              message.taken_in_ms, message.queries, message.quiet_ms)},
      {"oldest scene beside a batch of 1e6 rays over the time of the batch", batch.share(),
       Bar::kAtMost, 0.25, "",
       format("%.1f ms of %.0f ms, %zu queries; before it %.1f ms", batch.oldest_ms, batch.batch_ms,
              batch.queries, batch.quiet_ms)},
  };
}

}  // namespace box_query::load
