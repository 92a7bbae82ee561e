// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/accuracy.h"
#include "benchmark/methods.h"
#include "reference/oracle.h"

#include <algorithm>
#include <functional>
#include <memory>

namespace box_query::benchmark {
namespace {

constexpr std::size_t kBlock = 4096;

/// A method behind one type.
template <typename Component>
struct Contender {
  const char* name;
  const char* prepared;
  bool gives_t;
  std::function<Pass(const Pairs<Component>&)> bind;
  std::function<std::vector<Answer>(const Pairs<Component>&)> answers;
};

template <typename Method, typename Component>
Contender<Component> contender(const char* prepared) {
  const auto bind = [](const Pairs<Component>& pairs) -> Pass {
    using Boxes = std::vector<typename Method::Prepared>;
    const auto boxes = std::make_shared<const Boxes>(prepareAll<Method>(pairs.boxes));
    return [&pairs, boxes] { return passOver<Method>(pairs.components, *boxes); };
  };
  const auto answers = [](const Pairs<Component>& pairs) {
    std::vector<Answer> result;
    for (std::size_t i = 0; i < pairs.boxes.size(); ++i) {
      result.push_back(Method::ask(pairs.components[i], Method::prepare(pairs.boxes[i])));
    }
    return result;
  };
  return {Method::kName, prepared, Method::kGivesT, bind, answers};
}

template <typename Component, typename... Methods>
std::vector<Contender<Component>> contenders(MethodList<Methods...> /*prepared*/) {
  return {contender<Methods, Component>("box")...,
          contender<Lone<Methods>, Component>("nothing")...};
}

template <typename Component>
std::vector<oracle::Interval> truthOf(const Pairs<Component>& pairs) {
  std::vector<oracle::Interval> truth;
  for (std::size_t i = 0; i < pairs.boxes.size(); ++i) {
    truth.push_back(oracle::interval(pairs.components[i], pairs.boxes[i]));
  }
  return truth;
}

oracle::Bound boundOf(double t) {
  if (std::isinf(t)) {
    return {t < 0.0 ? -1 : 1, {}};
  }
  return {0, {t, 1.0}};
}

/// The error of t; of an enclosure that of its farther end. Infinite if it does not enclose.
double farthest(const Answer& answer, const oracle::Bound& exact) {
  const double error = oracle::ulpError(answer.t, exact);
  if (std::isnan(answer.t_above)) {
    return error;
  }
  const bool encloses =
      compare(boundOf(answer.t), exact) <= 0 && compare(exact, boundOf(answer.t_above)) <= 0;
  return encloses ? std::max(error, oracle::ulpError(answer.t_above, exact))
                  : std::numeric_limits<double>::infinity();
}

void compare(const std::vector<Answer>& answers, const std::vector<oracle::Interval>& truth,
             bool gives_t, Errors& errors) {
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const bool hit = truth[i].hit();
    ++errors.asked;
    errors.hits += hit ? 1 : 0;
    errors.false_hits += answers[i].hit && !hit ? 1 : 0;
    errors.false_misses += !answers[i].hit && hit ? 1 : 0;
    if (gives_t && hit && answers[i].hit) {
      errors.ulps.push_back(farthest(answers[i], truth[i].enter));
    }
  }
}

template <typename Component>
void measure(const char* table, Input input, const Options& options, std::vector<Row>& rows) {
  const auto methods = contenders<Component>(PairMethods());
  std::vector<Errors> errors(methods.size());
  for (std::size_t done = 0; done < options.pair_sample;) {
    const std::size_t count = std::min(kBlock, options.pair_sample - done);
    done += count;
    const auto pairs = makePairs<Component>(input, count, options.seed + done);
    const auto truth = truthOf(pairs);
    for (std::size_t m = 0; m < methods.size(); ++m) {
      compare(methods[m].answers(pairs), truth, methods[m].gives_t, errors[m]);
    }
  }

  const auto timed = makePairs<Component>(input, options.timed_pairs, options.seed);
  // A lone pair is compared with a lone double slab.
  for (const char* prepared : {"box", "nothing"}) {
    std::vector<Pass> passes;
    std::vector<std::size_t> chosen;
    std::size_t base = 0;
    for (std::size_t m = 0; m < methods.size(); ++m) {
      if (methods[m].prepared == std::string(prepared)) {
        base = methods[m].name == std::string(DoubleSlab::kName) ? passes.size() : base;
        passes.push_back(methods[m].bind(timed));
        chosen.push_back(m);
      }
    }
    const auto timings = timeSideBySide(passes, options.timed_pairs, options.rounds, base);
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      const std::size_t m = chosen[i];
      rows.push_back(
          {table, nameOf(input), prepared, methods[m].name, timings[i], std::move(errors[m])});
    }
  }
}

}  // namespace

std::vector<Row> measurePairs(const Options& options) {
  std::vector<Row> rows;
  for (const Input input : kInputs) {
    measure<Line>("line", input, options, rows);
    measure<Ray>("ray", input, options, rows);
    measure<Segment>("segment", input, options, rows);
  }
  return rows;
}

}  // namespace box_query::benchmark
