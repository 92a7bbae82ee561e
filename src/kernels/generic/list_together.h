// SPDX-License-Identifier: BSD-3-Clause
// Sixteen rays in lanes, against the boxes of a short list one by one.

template <typename What>
class ListSearch : LaneSearch<What> {
  using Base = LaneSearch<What>;
  using Base::begun_;
  using Base::lanes_;
  using Base::to_;
  using Base::view_;
  using Base::visit;

 public:
  using Base::Base;

  void run(std::size_t first, int count) {
    const std::uint32_t fit = Base::takeUp(first, count);
    if (view_.levels[0].nodes == 1) {
      searchNode(fit);
    } else {
      searchNodes(fit);
    }
    for (std::uint32_t bits = begun_; bits != 0; bits &= bits - 1) {
      Base::deliver(lowestBit(bits));
    }
    Base::askEachAlone(((1U << count) - 1) & ~fit);
  }

 private:
  /// Against each of up to sixteen boxes.
  void searchNode(std::uint32_t fit) {
    constexpr int kBoxes = 64 / kSlots;  // a word
    alignas(64) float nears[kSlots][kSlots];
    std::uint64_t words[kSlots / kBoxes] = {};
    const Bounds& node = view_.levels[0].bounds[0];
    const auto boxes = static_cast<int>(view_.num_records);
    for (int k = 0; k < boxes; ++k) {
      Float16 near;
      const std::uint64_t bits = meets(OneBound(node, k), lanes_, near) & fit;
      store16(nears[k], near);
      words[k / kBoxes] |= bits << (k % kBoxes * kSlots);
    }
    to_.work.nodes += static_cast<std::uint64_t>(boxes);
    for (int w = 0; w * kBoxes < boxes; ++w) {
      for (std::uint64_t bits = words[w]; bits != 0; bits &= bits - 1) {
        const int bit = __builtin_ctzll(bits);
        const int box = w * kBoxes + bit / kSlots;
        visit(bit % kSlots, static_cast<std::uint32_t>(box), nears[box][bit % kSlots]);
      }
    }
  }

  void searchNodes(std::uint32_t fit) {
    const Level& list = view_.levels[0];
    const RaysOfLanes rays(lanes_);
    alignas(64) std::uint32_t nodes[kMostRootNodes * kSlots + kSlots];
    int count = 0;
    for (std::uint32_t n = 0; n < list.nodes; ++n) {
      Float16 near;
      const std::uint32_t bits =
          meets(OneBound(*view_.around_nodes, static_cast<int>(n)), lanes_, near) & fit;
      count = append(bits, n * kSlots, nodes, count);
    }
    constexpr int kMost = kMostRootNodes * kSlots * kSlots;
    alignas(64) std::uint32_t entries[kMost + kSlots];
    alignas(64) float nears[kMost + kSlots];
    int listed = 0;
    for (int k = 0; k < count; ++k) {
      const std::uint32_t ray = nodes[k] % kSlots;
      const std::uint32_t n = nodes[k] / kSlots;
      Float16 near;
      const std::uint32_t bits = meets(list.bounds[n], rays, ray, near);
      listed = append(bits, n * kSlots | ray << kNumberBits, near, entries, nears, listed);
    }
    to_.work.nodes += list.nodes + static_cast<std::uint64_t>(count);
    for (int i = 0; i < listed; ++i) {
      visit(static_cast<int>(entries[i] >> kNumberBits), entries[i] & kLargestNumber, nears[i]);
    }
  }
};

template <typename What>
static void searchListTogether(const SceneView& view, const RayQueries& queries,
                               const Delivery& to) {
  ListSearch<What> search(view, queries, to);
  for (std::size_t first = 0; first < queries.count; first += kSlots) {
    const std::size_t left = queries.count - first;
    search.run(first, left < kSlots ? static_cast<int>(left) : kSlots);
  }
}
