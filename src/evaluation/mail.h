#pragma once

#include <deque>
#include <utility>
#include <vector>

namespace spelunk::evaluation {

/// What arrives a fixed time after it was sent, in the order of sending.
template <class Item>
class Mail {
 public:
  explicit Mail(double delay_s) : delay_s_(delay_s) {}

  void send(Item item, double now_s) {
    on_the_way_.emplace_back(now_s + delay_s_, std::move(item));
  }

  /// What has arrived by now; each once.
  [[nodiscard]] std::vector<Item> take(double now_s) {
    constexpr double kTolerance_s = 1e-9;
    std::vector<Item> arrived;
    while (!on_the_way_.empty() && on_the_way_.front().first <= now_s + kTolerance_s) {
      arrived.push_back(std::move(on_the_way_.front().second));
      on_the_way_.pop_front();
    }
    return arrived;
  }

  [[nodiscard]] bool isEmpty() const { return on_the_way_.empty(); }

 private:
  double delay_s_;
  std::deque<std::pair<double, Item>> on_the_way_;
};

}  // namespace spelunk::evaluation
