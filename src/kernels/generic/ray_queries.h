// SPDX-License-Identifier: BSD-3-Clause
// The queries of kernels.h.

/// Compares the ray with a record.
/// @return false if its box is not looked at, or certainly not entered at a parameter up to `bound`
[[gnu::always_inline]] static inline bool mayEnter(const SceneView& view, const RayQuery& query,
                                                   const Ray& ray, double bound,
                                                   std::uint32_t record, Work& work,
                                                   Candidate& candidate) {
  const std::uint32_t box = view.box_of_record[record];
  if (query.mask != nullptr && ((query.mask[box / 64] >> (box % 64)) & 1U) == 0) {
    return false;
  }
  ++work.boxes;
  work.turned_boxes += view.records[record].isAligned() ? 0 : 1;
  const Times t = timesOf(view.records[record], ray);
  candidate = {box, t.enter_hi <= t.exit_lo, t.enter_lo, t.enter_hi, t.exit_hi};
  return t.enter_lo <= t.exit_hi && t.enter_lo <= bound;
}

/// A search for the closest box, as it goes from record to record.
struct ClosestVisit {
  const SceneView* view;
  const RayQuery* query;
  Ray* ray;
  Found* found;
  Take take;
  void* context;
  double bound;     ///< a box that is entered later is not the first
  float bound_s;    ///< in s, rounded up
  double earliest;  ///< smallest enter_lo of the candidates

  float end() const { return bound_s; }

  bool operator()(std::uint32_t record) {
    Candidate c;
    if (!mayEnter(*view, *query, *ray, bound, record, found->work, c)) {
      return true;
    }
    if (c.certain && c.enter_hi < bound) {
      shorten(c.enter_hi);
      if (c.enter_hi < earliest) {
        found->count = 0;  // all others are later
        earliest = c.enter_lo;
      }
    }
    if (found->count == Found::kCapacity) {
      makeRoom();
    }
    earliest = earliest < c.enter_lo ? earliest : c.enter_lo;
    found->candidates[found->count++] = c;
    return true;
  }

  void shorten(double t) {
    bound = t;
    FloatRay& f = ray->in_float;
    bound_s = f.roundedUp(t);
    if (bound_s < f.end_s) {
      f.end_s = bound_s;
    }
  }

  void dropLater() const {
    int kept = 0;
    for (int i = 0; i < found->count; ++i) {
      if (found->candidates[i].enter_lo <= bound) {
        if (kept != i) {
          found->candidates[kept] = found->candidates[i];
        }
        ++kept;
      }
    }
    found->count = kept;
  }

  void makeRoom() {
    dropLater();
    if (found->count > Found::kCapacity / 2) {
      const double known = take(context, *found);
      found->count = 0;
      earliest = std::numeric_limits<double>::infinity();
      if (known < bound) {
        shorten(known);
      }
    }
  }
};

/// Prepares a query. (Inlined: a tenth of the time of a ray among few boxes.)
/// @return kReady if there is anything to search
[[gnu::always_inline]] static inline Outcome begin(const SceneView& view, const RayQuery& query,
                                                   Found& found, Ray& ray, bool in_stretches) {
  found.count = 0;
  found.work = Work();
  const Outcome outcome = prepare(view, query, ray, in_stretches);
  found.t_inside = ray.t_inside;
  return outcome == Outcome::kReady && view.depth == 0 ? Outcome::kMiss : outcome;
}

static inline ClosestVisit closestVisit(const SceneView& view, const RayQuery& query, Ray& ray,
                                        Found& found, Take take, void* context) {
  return {&view,
          &query,
          &ray,
          &found,
          take,
          context,
          ray.t_end,
          ray.in_float.end_s,
          std::numeric_limits<double>::infinity()};
}

static bool closest(const SceneView& view, const RayQuery& query, Found& found, Take take,
                    void* context) {
  Ray ray;
  const Outcome outcome = begin(view, query, found, ray, view.depth > 2);
  if (outcome == Outcome::kReady) {
    ClosestVisit visit = closestVisit(view, query, ray, found, take, context);
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
  const SceneView* view;
  const RayQuery* query;
  const Ray* ray;
  Found* found;
  Take take;
  void* context;
  float end_s;
  bool is_met;

  float end() const { return end_s; }

  bool operator()(std::uint32_t record) {
    Candidate c;
    if (!mayEnter(*view, *query, *ray, ray->t_end, record, found->work, c)) {
      return true;
    }
    if (c.certain && c.enter_hi <= ray->t_inside) {
      is_met = true;
      return false;
    }
    return leaveToCaller(*found, c, take, context);
  }
};

static inline AnyVisit anyVisit(const SceneView& view, const RayQuery& query, const Ray& ray,
                                Found& found, Take take, void* context) {
  return {&view, &query, &ray, &found, take, context, ray.in_float.end_s, false};
}

static Answer any(const SceneView& view, const RayQuery& query, Found& found, Take take,
                  void* context) {
  Ray ray;
  const Outcome outcome = begin(view, query, found, ray, view.depth > 2);
  if (outcome != Outcome::kReady) {
    return outcome == Outcome::kMiss ? Answer::kUndecided : Answer::kNotTaken;
  }
  AnyVisit visit = anyVisit(view, query, ray, found, take, context);
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
    Candidate c;
    return !mayEnter(view, query, ray, ray.t_end, record, found.work, c) ||
           leaveToCaller(found, c, take, context);
  }
};

static bool all(const SceneView& view, const RayQuery& query, Found& found, Take take,
                void* context) {
  Ray ray;
  const Outcome outcome = begin(view, query, found, ray, view.depth > 2);
  if (outcome == Outcome::kReady) {
    AllVisit visit{view, query, ray, found, take, context};
    descend(view, ray.in_float, found.work, visit);
  }
  return outcome != Outcome::kNotTaken;
}
