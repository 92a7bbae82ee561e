// SPDX-License-Identifier: BSD-3-Clause
// The queries of kernels.h, as visits of what a ray may meet: begin() comes before the first
// record, then one record after the other until there is no more or one of them ends the query.

/// What all of them have in common.
class RayVisit {
 public:
  RayVisit() = default;
  RayVisit(const SceneView& view, const RayQuery& query, Found& into, FloatRay& ray)
      : found(&into), view_(&view), query_(&query), in_float_(&ray), end_s_(ray.end_s) {}

  /// What lies beyond it [s] need not be looked at.
  float end() const { return end_s_; }

  /// Prepares what is compared in double, unless it is.
  /// @return whether the ray is taken
  [[gnu::always_inline]] bool begin() {
    if (!is_begun_) {
      is_begun_ = true;
      is_taken_ = prepare(*query_, view_->has_aligned, ray_);
    }
    return is_taken_;
  }

  /// Whether nothing was found so far.
  bool isEmpty() const { return found->count == 0; }

  /// Sets what begin() prepares, where GCC does not see that nothing uses it before and warns.
  void clear() { ray_ = RayInDouble{}; }

  Found* found = nullptr;

 protected:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  /// Compares the ray with a record.
  /// @return false if its box is not looked at, or certainly not entered at a parameter up to
  /// `bound`
  [[gnu::always_inline]] bool mayEnter(std::uint32_t record, double bound,
                                       Candidate& candidate) const {
    const std::uint32_t box = view_->box_of_record[record];
    if (!isLookedAt(record)) {
      return false;
    }
    const Times t = timesOf(view_->records[record], ray_);
    candidate = {box, t.enter_hi <= t.exit_lo, t.enter_lo, t.enter_hi, t.exit_hi};
    return t.enter_lo <= t.exit_hi && t.enter_lo <= bound;
  }

  /// Whether the box of a record is looked at, which is counted.
  [[gnu::always_inline]] bool isLookedAt(std::uint32_t record) const {
    const std::uint32_t box = view_->box_of_record[record];
    if (query_->mask != nullptr && ((query_->mask[box / 64] >> (box % 64)) & 1U) == 0) {
      return false;
    }
    ++found->work->boxes;
    found->work->turned_boxes += view_->records[record].isAligned() ? 0 : 1;
    return true;
  }

  bool isFull() const { return found->count == Found::kCapacity; }
  void add(const Candidate& candidate) const { found->candidates[found->count++] = candidate; }

  /// Adds a candidate to those that the caller decides.
  /// @return false if the caller ends the query
  bool leaveToCaller(const Candidate& candidate) {
    if (isFull() && takeAll() < 0.0) {
      return false;
    }
    add(candidate);
    return true;
  }

  /// Makes room for candidates.
  /// @return what Take returned, or -inf
  double takeAll() {
    double known = -kInfinity;
    if (found->take != nullptr) {
      known = found->take(found->context, *found);
      is_left_ = true;
    } else {
      is_taken_ = false;
    }
    found->count = 0;
    return known;
  }

  Answer answerOfFound() const {
    if (is_begun_ && !is_taken_) {
      return Answer::kNotTaken;
    }
    return found->count > 0 || is_left_ ? Answer::kUndecided : Answer::kNone;
  }

  const SceneView* view_ = nullptr;
  const RayQuery* query_ = nullptr;
  FloatRay* in_float_ = nullptr;
  float end_s_ = 0.0F;
  RayInDouble ray_;
  bool is_begun_ = false;
  bool is_taken_ = false;
  bool is_left_ = false;  ///< candidates were taken
};

/// A search for the closest box.
class ClosestVisit : public RayVisit {
 public:
  static constexpr bool kAnyWillDo = false;
  static constexpr bool kWithin = false;

  using RayVisit::RayVisit;

  [[gnu::always_inline]] bool operator()(std::uint32_t record) {
    Candidate c;
    if (!mayEnter(record, bound_, c)) {
      return true;
    }
    if (c.certain && c.enter_hi < bound_) {
      shorten(c.enter_hi);
      if (c.enter_hi < earliest_) {
        found->count = 0;  // all others are later
        earliest_ = c.enter_lo;
      }
    } else if (bound_ <= 0.0 && startsIn(c) && isAnotherAtStart(c.box)) {
      return true;
    }
    if (isFull()) {
      makeRoom();
    }
    earliest_ = earliest_ < c.enter_lo ? earliest_ : c.enter_lo;
    add(c);
    return true;
  }

  Answer answer() {
    dropLater();
    found->t_inside = in_float_->certain_end;
    if (bound_ > found->t_inside && found->count > 0) {
      const Reach reach = reachOf(*query_);
      found->t_inside = reach.inside;
      bound_ = bound_ < reach.outside ? bound_ : reach.outside;
      dropLater();
    }
    return answerOfFound();
  }

 private:
  static bool startsIn(const Candidate& c) { return c.certain && c.enter_hi <= 0.0; }

  /// Of the boxes that the ray starts in, all of which are entered there, that of the lowest number
  /// stands for all.
  /// @return whether there is another
  bool isAnotherAtStart(std::uint32_t box) {
    for (int i = 0; i < found->count; ++i) {
      Candidate& other = found->candidates[i];
      if (startsIn(other)) {
        other.box = box < other.box ? box : other.box;
        return true;
      }
    }
    return false;
  }

  void shorten(double t) {
    bound_ = t;
    const float s = in_float_->roundedUp(t);
    end_s_ = s < end_s_ ? s : end_s_;
    if (s < in_float_->end_s) {
      in_float_->end_s = s;
    }
  }

  void dropLater() {
    int kept = 0;
    for (int i = 0; i < found->count; ++i) {
      if (found->candidates[i].enter_lo <= bound_) {
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
      const double known = takeAll();
      earliest_ = kInfinity;
      if (known < bound_) {
        shorten(known);
      }
    }
  }

  double bound_ = kInfinity;     ///< a box that is entered later is not the first; end() above it
  double earliest_ = kInfinity;  ///< smallest enter_lo of the candidates
};

/// A search for any box.
class AnyVisit : public RayVisit {
 public:
  static constexpr bool kAnyWillDo = true;
  static constexpr bool kWithin = false;

  using RayVisit::RayVisit;

  [[gnu::always_inline]] bool operator()(std::uint32_t record) {
    Candidate c;
    if (!mayEnter(record, kInfinity, c)) {
      return true;
    }
    double inside = in_float_->certain_end;
    if (c.enter_hi > inside) {
      const Reach reach = reachOf(*query_);
      inside = reach.inside;
      if (c.enter_lo > reach.outside) {
        return true;
      }
    }
    if (c.certain && c.enter_hi <= inside) {
      is_met_ = true;
      return false;
    }
    return leaveToCaller(c);
  }

  Answer answer() const { return is_met_ ? Answer::kYes : answerOfFound(); }

 private:
  bool is_met_ = false;
};

/// A search for any box within the radius of a segment. Bounds that are moved outward by the radius
/// have corners that are farther away than it: where it is large, and boxes are many, the corners
/// may hold most of them. So a search that looks at some in vain is left to the caller, whose
/// search by distances leaves corners out.
class WithinVisit : public RayVisit {
 public:
  static constexpr bool kAnyWillDo = true;
  static constexpr bool kWithin = true;

  using RayVisit::RayVisit;

  static bool begin() { return true; }
  bool isEmpty() const { return !is_open_; }

  [[gnu::always_inline]] bool operator()(std::uint32_t record) {
    if (isLookedAt(record)) {
      const double* p = query_->origin;
      const double* q = query_->direction;
      const SegmentQuery segment = {{p[0], p[1], p[2]}, {q[0], q[1], q[2]}, 0.0, false, nullptr};
      NearBox near;
      estimate(view_->records[record], segment, near);
      is_within_ = near.upper <= query_->radius;
      is_open_ = is_open_ || near.lower <= query_->radius;
    }
    if (!is_within_ && ++in_vain_ == kMostInVain) {
      is_open_ = true;
      return false;
    }
    return !is_within_;
  }

  Answer answer() const {
    return is_within_ ? Answer::kYes : is_open_ ? Answer::kNotTaken : Answer::kNone;
  }

 private:
  static constexpr int kMostInVain = 8;  // measured

  bool is_within_ = false;
  bool is_open_ = false;  ///< floats and doubles do not say of some box whether it is
  int in_vain_ = 0;       ///< boxes that were looked at, and are not certainly within
};

/// A search for all boxes.
class AllVisit : public RayVisit {
 public:
  static constexpr bool kWithin = false;

  using RayVisit::RayVisit;

  [[gnu::always_inline]] bool operator()(std::uint32_t record) {
    Candidate c;
    return !mayEnter(record, kInfinity, c) ||
           (c.enter_lo > in_float_->certain_end && c.enter_lo > reachOf(*query_).outside) ||
           leaveToCaller(c);
  }

  Answer answer() const { return answerOfFound(); }
};

/// Prepares a ray for bounds: ask(ray) answers, where it is to be compared with any.
template <typename Visit, typename Ask>
[[gnu::always_inline]] static inline Answer askPrepared(const SceneView& view,
                                                        const RayQuery& query, bool in_stretches,
                                                        const Ask& ask) {
  FloatRay ray;
  const Outcome outcome = prepare<Visit::kWithin>(view, query, ray, in_stretches);
  if (outcome != Outcome::kReady) {
    return outcome == Outcome::kMiss ? Answer::kNone : Answer::kNotTaken;
  }
  return ask(ray);
}

// One function for each kind of tree, in which a ray is prepared too: little goes through memory,
// and none makes room for what another needs.

template <typename Visit>
[[gnu::noinline]] static Answer searchList(const SceneView& view, const RayQuery& query,
                                           Found& found) {
  return askPrepared<Visit>(view, query, false, [&](FloatRay& ray) {
    return searchList<Visit>(view, query, found, ray);
  });
}

template <typename Visit>
[[gnu::noinline]] static Answer searchTwoLevels(const SceneView& view, const RayQuery& query,
                                                Found& found) {
  return askPrepared<Visit>(view, query, false, [&](FloatRay& ray) {
    Visit visit(view, query, found, ray);
    visit.clear();
    visitTwoLevels(view, ray, visit);
    return visit.answer();
  });
}

template <typename Visit>
[[gnu::noinline]] static Answer searchTree(const SceneView& view, const RayQuery& query,
                                           Found& found) {
  return askPrepared<Visit>(view, query, true, [&](FloatRay& ray) {
    Visit visit(view, query, found, ray);
    descendInStretches(view, ray, visit);
    return visit.answer();
  });
}

/// (Each with little of its own, so that most rays among few boxes need no more.)
template <typename Visit>
static Answer search(const SceneView& view, const RayQuery& query, Found& found) {
  if (view.boxes_in_blocks > 0) {
    BlockRay ray;
    if (prepare<Visit::kWithin>(view, query, ray)) {
      return searchBlocks<Visit>(view, query, found, ray);
    }
  }
  switch (view.depth) {
    case 0:
      return Answer::kNone;
    case 1:
      return searchList<Visit>(view, query, found);
    case 2:
      return searchTwoLevels<Visit>(view, query, found);
    default:
      return searchTree<Visit>(view, query, found);
  }
}

static Answer closest(const SceneView& view, const RayQuery& query, Found& found) {
  return search<ClosestVisit>(view, query, found);
}

static Answer any(const SceneView& view, const RayQuery& query, Found& found) {
  return search<AnyVisit>(view, query, found);
}

static Answer anyWithin(const SceneView& view, const RayQuery& query, Found& found) {
  return search<WithinVisit>(view, query, found);
}

static Answer all(const SceneView& view, const RayQuery& query, Found& found) {
  if (view.depth == 0) {
    return Answer::kNone;
  }
  return askPrepared<AllVisit>(view, query, false, [&](FloatRay& ray) {
    AllVisit visit(view, query, found, ray);
    descend(view, ray, visit);
    return visit.answer();
  });
}
