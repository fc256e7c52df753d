#pragma once

#include <chrono>
#include <mutex>
#include <utility>

namespace spelunk::bridge {

/// Data that can only be touched while its lock is held. Keep what runs inside short, and never
/// take a second lock there.
template <class T>
class Guarded {
 public:
  template <class... Args>
  explicit Guarded(Args&&... args) : value_(std::forward<Args>(args)...) {}

  template <class F>
  auto with(F&& f) {
    const std::lock_guard lock(mutex_);
    return std::forward<F>(f)(value_);
  }

  /// Runs `f` if the lock becomes free in time; tells whether it ran.
  template <class F>
  bool tryWithFor(double seconds, F&& f) {
    const std::unique_lock lock(mutex_, std::chrono::duration<double>(seconds));
    if (!lock) return false;
    std::forward<F>(f)(value_);
    return true;
  }

  /// Runs `f` if the lock is free at once; tells whether it ran.
  template <class F>
  bool tryWith(F&& f) {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock) return false;
    std::forward<F>(f)(value_);
    return true;
  }

 private:
  std::timed_mutex mutex_;
  T value_;
};

}  // namespace spelunk::bridge
