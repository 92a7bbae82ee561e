// SPDX-License-Identifier: BSD-3-Clause
// The queries of kernels.h.

static inline bool isLookedAt(const RayQuery& query, std::uint32_t box) {
  return query.mask == nullptr || ((query.mask[box / 64] >> (box % 64)) & 1U) != 0;
}

struct ClosestVisit {
  const SceneView& view;
  const RayQuery& query;
  Ray& ray;
  Found& found;
  Take take;
  void* context;
  double bound;     ///< a box that is entered later is not the first
  float bound_s;    ///< in s, rounded up
  double earliest;  ///< smallest enter_lo of the candidates

  float end() const { return bound_s; }

  bool operator()(std::uint32_t record) {
    const std::uint32_t box = view.box_of_record[record];
    if (!isLookedAt(query, box)) {
      return true;
    }
    ++found.work.boxes;
    const Times t = timesOf(view.records[record], ray);
    if (t.enter_lo > t.exit_hi || t.enter_lo > bound) {
      return true;
    }
    const bool certain = t.enter_hi <= t.exit_lo;
    if (certain && t.enter_hi < bound) {
      shorten(t.enter_hi);
      if (t.enter_hi < earliest) {
        found.count = 0;  // all others are later
        earliest = t.enter_lo;
      }
    }
    if (found.count == Found::kCapacity) {
      makeRoom();
    }
    earliest = earliest < t.enter_lo ? earliest : t.enter_lo;
    found.candidates[found.count++] = {box, certain, t.enter_lo, t.enter_hi, t.exit_hi};
    return true;
  }

  void shorten(double t) {
    bound = t;
    FloatRay& f = ray.in_float;
    bound_s = f.roundedUp(t);
    if (bound_s < f.end_s) {
      f.end_s = bound_s;
    }
  }

  void dropLater() {
    int kept = 0;
    for (int i = 0; i < found.count; ++i) {
      if (found.candidates[i].enter_lo <= bound) {
        found.candidates[kept++] = found.candidates[i];
      }
    }
    found.count = kept;
  }

  void makeRoom() {
    dropLater();
    if (found.count > Found::kCapacity / 2) {
      const double known = take(context, found);
      found.count = 0;
      earliest = std::numeric_limits<double>::infinity();
      if (known < bound) {
        shorten(known);
      }
    }
  }
};

/// Prepares a query.
/// @return kReady if there is anything to search
static inline Outcome begin(const SceneView& view, const RayQuery& query, Found& found, Ray& ray) {
  found.count = 0;
  found.work = Work();
  const Outcome outcome = prepare(view, query, ray);
  found.t_inside = ray.t_inside;
  return outcome == Outcome::kReady && view.depth == 0 ? Outcome::kMiss : outcome;
}

static bool closest(const SceneView& view, const RayQuery& query, Found& found, Take take,
                    void* context) {
  Ray ray;
  const Outcome outcome = begin(view, query, found, ray);
  if (outcome == Outcome::kReady) {
    ClosestVisit visit{view,
                       query,
                       ray,
                       found,
                       take,
                       context,
                       ray.t_end,
                       ray.in_float.end_s,
                       std::numeric_limits<double>::infinity()};
    descendInStretches(view, ray.in_float, found.work, visit);
    visit.dropLater();
  }
  return outcome != Outcome::kNotTaken;
}

/// Adds a candidate to those that the caller decides.
/// @return false if the caller ends the query
static inline bool leaveToCaller(Found& found, const Candidate& candidate, Take take,
                                 void* context) {
  if (found.count == Found::kCapacity) {
    const bool ends = take(context, found) < 0.0;
    found.count = 0;
    if (ends) {
      return false;
    }
  }
  found.candidates[found.count++] = candidate;
  return true;
}

struct AnyVisit {
  const SceneView& view;
  const RayQuery& query;
  const Ray& ray;
  Found& found;
  Take take;
  void* context;
  float end_s;
  bool is_met;

  float end() const { return end_s; }

  bool operator()(std::uint32_t record) {
    const std::uint32_t box = view.box_of_record[record];
    if (!isLookedAt(query, box)) {
      return true;
    }
    ++found.work.boxes;
    const Times t = timesOf(view.records[record], ray);
    if (t.enter_lo > t.exit_hi || t.enter_lo > ray.t_end) {
      return true;
    }
    const bool certain = t.enter_hi <= t.exit_lo;
    if (certain && t.enter_hi <= ray.t_inside) {
      is_met = true;
      return false;
    }
    return leaveToCaller(found, {box, certain, t.enter_lo, t.enter_hi, t.exit_hi}, take, context);
  }
};

static Answer any(const SceneView& view, const RayQuery& query, Found& found, Take take,
                  void* context) {
  Ray ray;
  const Outcome outcome = begin(view, query, found, ray);
  if (outcome != Outcome::kReady) {
    return outcome == Outcome::kMiss ? Answer::kUndecided : Answer::kNotTaken;
  }
  AnyVisit visit{view, query, ray, found, take, context, ray.in_float.end_s, false};
  descendInStretches(view, ray.in_float, found.work, visit);
  return visit.is_met ? Answer::kYes : Answer::kUndecided;
}

struct AllVisit {
  const SceneView& view;
  const RayQuery& query;
  const Ray& ray;
  Found& found;
  Take take;
  void* context;

  bool operator()(std::uint32_t record) {
    const std::uint32_t box = view.box_of_record[record];
    if (!isLookedAt(query, box)) {
      return true;
    }
    ++found.work.boxes;
    const Times t = timesOf(view.records[record], ray);
    if (t.enter_lo > t.exit_hi || t.enter_lo > ray.t_end) {
      return true;
    }
    return leaveToCaller(found, {box, t.enter_hi <= t.exit_lo, t.enter_lo, t.enter_hi, t.exit_hi},
                         take, context);
  }
};

static bool all(const SceneView& view, const RayQuery& query, Found& found, Take take,
                void* context) {
  Ray ray;
  const Outcome outcome = begin(view, query, found, ray);
  if (outcome == Outcome::kReady) {
    AllVisit visit{view, query, ray, found, take, context};
    descend(view, ray.in_float, found.work, visit);
  }
  return outcome != Outcome::kNotTaken;
}
