#include "spelunk/common/log.h"

#include <mutex>

namespace spelunk {
namespace {

struct Sink {
  std::mutex mutex;
  LogSink write;
};

Sink& sink() {
  static Sink the_sink;
  return the_sink;
}

}  // namespace

void setLogSink(LogSink write) {
  const std::lock_guard lock(sink().mutex);
  sink().write = std::move(write);
}

void log(LogLevel level, const std::string& text) {
  const std::lock_guard lock(sink().mutex);
  if (sink().write) sink().write(level, text);
}

bool Throttle::allows(const std::string& key, double now_s) {
  const auto [entry, is_new] = last_s_.try_emplace(key, now_s);
  if (is_new) return true;
  if (now_s >= entry->second && now_s - entry->second < period_s_) return false;
  entry->second = now_s;
  return true;
}

}  // namespace spelunk
