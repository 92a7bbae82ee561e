// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What most things of a kind do not have.
#pragma once

#include <memory>

namespace box_query {

/// A T or none, in the memory of a pointer. A copy has a T of its own.
template <class T>
class Rare {
 public:
  Rare() = default;
  Rare(const Rare& other) : thing_(other ? std::make_unique<T>(*other.thing_) : nullptr) {}
  Rare(Rare&& other) noexcept = default;
  Rare& operator=(const Rare& other) {
    thing_ = Rare(other).thing_;
    return *this;
  }
  Rare& operator=(Rare&& other) noexcept = default;
  ~Rare() = default;

  explicit operator bool() const { return thing_ != nullptr; }
  const T* operator->() const { return thing_.get(); }
  /// Makes it where there is none.
  T& make() {
    if (!thing_) {
      thing_ = std::make_unique<T>();
    }
    return *thing_;
  }

 private:
  std::unique_ptr<T> thing_;
};

}  // namespace box_query
