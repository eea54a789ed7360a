// What Pellucid uses of oneTBB, over std::thread, for builds under ThreadSanitizer: Debian's library is not
// instrumented, so the sanitizer sees none of its hand-overs between threads and takes every one of them for a race.
#pragma once
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <list>
#include <map>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace tbb {

namespace plain {

// Threads at work at once. More than this machine may have: what races does so on any.
inline std::atomic<int>& most() {
  static std::atomic<int> threads{4};
  return threads;
}

// A loop inside another runs on the thread that meets it.
inline bool& inside() {
  thread_local bool within = false;
  return within;
}

// run(i) for each i below `parts`. The first exception is thrown again once every thread is done.
template <class Run>
void each(std::size_t parts, const Run& run) {
  const std::size_t threads = std::min(parts, static_cast<std::size_t>(std::max(most().load(), 1)));
  if (threads < 2 || inside()) {
    for (std::size_t i = 0; i < parts; ++i) run(i);
    return;
  }
  std::atomic<std::size_t> next{0};
  std::exception_ptr failure;
  std::mutex failing;
  const auto work = [&] {
    inside() = true;
    try {
      for (std::size_t i = next++; i < parts; i = next++) run(i);
    } catch (...) {
      const std::lock_guard<std::mutex> lock(failing);
      if (!failure) failure = std::current_exception();
    }
    inside() = false;
  };
  std::vector<std::thread> others;
  for (std::size_t i = 1; i < threads; ++i) others.emplace_back(work);
  work();
  for (std::thread& other : others) other.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace plain

template <class Value>
class blocked_range {
 public:
  using const_iterator = Value;
  blocked_range(Value begin, Value end, std::size_t grain = 1) : begin_(begin), end_(end), grain_(grain) {}
  Value begin() const { return begin_; }
  Value end() const { return end_; }
  std::size_t size() const { return static_cast<std::size_t>(end_ - begin_); }
  std::size_t grainsize() const { return grain_; }
  bool empty() const { return !(begin_ < end_); }

 private:
  Value begin_, end_;
  std::size_t grain_;
};

template <class Value, class Body>
void parallel_for(const blocked_range<Value>& range, const Body& body) {
  if (range.empty()) return;
  constexpr std::size_t kPieces = 16;
  const std::size_t size = range.size(), grain = std::max<std::size_t>(range.grainsize(), 1);
  const std::size_t step = std::max(grain, (size + kPieces - 1) / kPieces);
  plain::each((size + step - 1) / step, [&](std::size_t i) {
    const auto from = static_cast<Value>(range.begin() + static_cast<Value>(i * step));
    const auto to = static_cast<Value>(range.begin() + static_cast<Value>(std::min(size, (i + 1) * step)));
    body(blocked_range<Value>(from, to, grain));
  });
}

template <class Index, class Body>
void parallel_for(Index first, Index last, const Body& body) {
  parallel_for(blocked_range<Index>(first, last), [&](const blocked_range<Index>& range) {
    for (Index i = range.begin(); i != range.end(); ++i) body(i);
  });
}

// Parts of a few pieces, put together in order.
template <class Value, class Sum, class Body, class Join>
Sum parallel_reduce(const blocked_range<Value>& range, const Sum& identity, const Body& body, const Join& join) {
  std::mutex adding;
  std::map<Value, Sum> parts;
  parallel_for(range, [&](const blocked_range<Value>& piece) {
    Sum sum = body(piece, identity);
    const std::lock_guard<std::mutex> lock(adding);
    parts.emplace(piece.begin(), std::move(sum));
  });
  Sum all = identity;
  for (const auto& [begin, sum] : parts) all = join(all, sum);
  return all;
}

template <class First, class Second>
void parallel_invoke(const First& first, const Second& second) {
  plain::each(2, [&](std::size_t i) { i == 0 ? static_cast<void>(first()) : static_cast<void>(second()); });
}

template <class Value>
class enumerable_thread_specific {
 public:
  enumerable_thread_specific() : make_([] { return Value(); }) {}
  template <class Make>
  explicit enumerable_thread_specific(Make make) : make_(std::move(make)) {}
  Value& local() {
    const std::lock_guard<std::mutex> lock(changing_);
    Value*& mine = own_[std::this_thread::get_id()];
    if (!mine) mine = &values_.emplace_back(make_());
    return *mine;
  }
  auto begin() { return values_.begin(); }
  auto end() { return values_.end(); }

 private:
  std::function<Value()> make_;
  std::mutex changing_;
  std::list<Value> values_;
  std::map<std::thread::id, Value*> own_;
};

class global_control {
 public:
  enum parameter { max_allowed_parallelism };
  global_control(parameter, std::size_t threads) : before_(plain::most().exchange(static_cast<int>(threads))) {}
  ~global_control() { plain::most() = before_; }
  static std::size_t active_value(parameter) { return static_cast<std::size_t>(plain::most().load()); }
  global_control(const global_control&) = delete;
  global_control& operator=(const global_control&) = delete;

 private:
  int before_;
};

namespace info {
inline int default_concurrency() {
  return plain::most();
}
}  // namespace info

}  // namespace tbb
