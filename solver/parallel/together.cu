// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/parallel/together.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <compare>
#include <condition_variable>
#include <cstddef>
#include <cstring>
#include <deque>
#include <exception>
#include <map>
#include <mutex>
#include <stdexcept>
#include <tuple>
#include <vector>

#include "solver/parallel/recording.hpp"

#if defined(__CUDACC__)
#include "solver/parallel/gpu_state.hpp"

namespace talus {
namespace {

/// What waits to be started, of one run.
struct Request {
  const SharedWork* work;
  int times;
  cudaEvent_t ready;  ///< after all that it builds on; null where all of that is done
  bool taken = false, done = false;
  std::exception_ptr failure{};
  std::condition_variable changed{};
};

/// What is started at once: requests of alike work.
using Group = std::vector<Request*>;

/// Rounds a number of blocks up, so that groups of about the same size can be started by the same graph.
int rounded_up(int blocks) {
  const int step = static_cast<int>(std::bit_ceil(static_cast<unsigned>(blocks)) / 8);
  return step > 1 ? (blocks + step - 1) / step * step : blocks;
}

/// The tables of a lane, filled on the host and copied to the GPU at once.
class Tables {
 public:
  Tables() = default;
  Tables(const Tables&) = delete;
  Tables& operator=(const Tables&) = delete;
  ~Tables() { drop(); }

  /// The method makes room for the tables of work; it returns whether they lie where they did before.
  bool fit(const SharedWork& work) {
    std::size_t needed = 0;
    for (const LaunchList* list : {&work.begin, &work.step, &work.end}) {
      for (const LaunchList::Launch& launch : list->launches()) needed += room_of(launch);
    }
    used_ = 0;
    if (needed <= size_) return true;
    drop();
    size_ = 2 * needed;
    void* host = nullptr;
    check_cuda(cudaMallocHost(&host, size_), "cudaMallocHost");
    host_ = static_cast<std::byte*>(host);
    void* on_gpu = nullptr;
    check_cuda(cudaMalloc(&on_gpu, size_), "cudaMalloc");
    on_gpu_ = static_cast<std::byte*>(on_gpu);
    return false;
  }

  /// The method fills the next table with kernel number k of a list of every request, and counts their blocks.
  LaunchTable add(const Group& group, LaunchList SharedWork::*list, std::size_t k, int& blocks) {
    const LaunchList::Launch& launch = (group.front()->work->*list).launches()[k];
    const std::size_t at = used_;
    used_ += room_of(launch);
    auto* const ends = reinterpret_cast<int*>(host_ + at);
    std::fill_n(ends, LaunchTable::most, no_block);
    blocks = 0;
    for (std::size_t m = 0; m < group.size(); ++m) {
      const LaunchList& own = group[m]->work->*list;
      blocks += own.launches()[k].blocks;
      ends[m] = blocks;
      std::memcpy(host_ + at + ends_bytes + m * launch.bytes, own.kernel(k), launch.bytes);
    }
    return {reinterpret_cast<const int*>(on_gpu_ + at), on_gpu_ + at + ends_bytes};
  }

  /// The method starts the copy of what was filled.
  void copy(cudaStream_t stream) const {
    check_cuda(cudaMemcpyAsync(on_gpu_, host_, used_, cudaMemcpyHostToDevice, stream), "upload");
  }

 private:
  static constexpr std::size_t ends_bytes = LaunchTable::most * sizeof(int);
  static std::size_t room_of(const LaunchList::Launch& launch) {
    constexpr std::size_t line = 128;
    return ends_bytes + (LaunchTable::most * launch.bytes + line - 1) / line * line;
  }
  void drop() {
    if (host_) (void)cudaFreeHost(host_);
    if (on_gpu_) (void)cudaFree(on_gpu_);
    host_ = on_gpu_ = nullptr;
    size_ = 0;
  }
  std::byte *host_ = nullptr, *on_gpu_ = nullptr;
  std::size_t size_ = 0, used_ = 0;
};

/// A stream on which the work of several runs is started as one.
class Lane {
 public:
  Lane() { check_cuda(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking), "stream"); }
  Lane(const Lane&) = delete;
  Lane& operator=(const Lane&) = delete;
  ~Lane() {
    forget();
    (void)cudaStreamDestroy(stream_);
  }

  /// The method does the work of a group, with as many steps as any of it asks for, and waits for it. `early`: a kernel
  /// may come onto the GPU while the one before it is ending.
  void run(const Group& group, bool early) {
    early_ = early;
    for (const Request* request : group) {
      if (request->ready) check_cuda(cudaStreamWaitEvent(stream_, request->ready), "wait");
    }
    if (!tables_.fit(*group.front()->work)) forget();
    const Starts begin = starts(group, &SharedWork::begin), step = starts(group, &SharedWork::step),
                 end = starts(group, &SharedWork::end);
    tables_.copy(stream_);
    start(begin);
    repeat(step, (*std::ranges::max_element(group, {}, &Request::times))->times);
    start(end);
    check_cuda(cudaStreamSynchronize(stream_), "kernels of several runs");
  }

  bool is_free = true;

 private:
  /// A start of one kernel, with its table.
  struct Start {
    StartSeveral start;
    LaunchTable table;
    int blocks, threads;
    auto operator<=>(const Start& o) const {
      return std::tie(start, table.ends, blocks, threads) <=> std::tie(o.start, o.table.ends, o.blocks, o.threads);
    }
  };
  using Starts = std::vector<Start>;

  Starts starts(const Group& group, LaunchList SharedWork::*list) {
    const std::vector<LaunchList::Launch>& launches = (group.front()->work->*list).launches();
    Starts all;
    for (std::size_t k = 0; k < launches.size(); ++k) {
      int blocks = 0;
      const LaunchTable table = tables_.add(group, list, k, blocks);
      all.push_back({launches[k].start, table, rounded_up(blocks), launches[k].threads});
    }
    return all;
  }

  void start(const Starts& all) const {
    for (const Start& one : all) one.start({stream_, one.blocks, one.threads, early_}, one.table);
    check_cuda(cudaGetLastError(), "kernels of several runs");
  }

  /// A step is started by its kernels once, and as a graph where it is repeated.
  void repeat(const Starts& step, int times) {
    if (times <= 1) {
      if (times == 1) start(step);
      return;
    }
    cudaGraphExec_t graph = graph_of(step);
    for (int time = 0; time < times; ++time) check_cuda(cudaGraphLaunch(graph, stream_), "graph");
  }

  cudaGraphExec_t graph_of(const Starts& step) {
    if (const auto known = graphs_.find(step); known != graphs_.end()) return known->second;
    if (graphs_.size() == most_graphs) forget();
    check_cuda(cudaStreamBeginCapture(stream_, cudaStreamCaptureModeRelaxed), "begin of a recording");
    start(step);
    cudaGraph_t graph = nullptr;
    check_cuda(cudaStreamEndCapture(stream_, &graph), "end of a recording");
    cudaGraphExec_t executable = nullptr;
    check_cuda(cudaGraphInstantiate(&executable, graph, 0), "graph");
    check_cuda(cudaGraphDestroy(graph), "graph");
    graphs_.emplace(step, executable);
    return executable;
  }

  void forget() {
    for (const auto& [step, graph] : graphs_) (void)cudaGraphExecDestroy(graph);
    graphs_.clear();
  }

  static constexpr std::size_t most_graphs = 256;
  cudaStream_t stream_ = nullptr;
  bool early_ = false;
  Tables tables_;
  std::map<Starts, cudaGraphExec_t> graphs_;  ///< of steps
};

}  // namespace

/// While one group is on the GPU another may be started, where enough runs wait: what they do on the host in between
/// takes as long as their steps.
struct Together::State {
  static constexpr int most_lanes = 3;

  State(int index, int devices) : gpu(index), least(std::max(devices / 4, 1)) {}

  /// Whether the first request that waits may be started, with those like it.
  bool may_start() const {
    return !waiting.empty() && (busy == 0 || (busy < most_lanes && waiting.size() >= static_cast<std::size_t>(least)));
  }

  /// The method takes the first request that waits, and those like it.
  Group take() {
    const SharedWork& first = *waiting.front()->work;
    constexpr std::size_t most = LaunchTable::most;
    Group group;
    for (auto at = waiting.begin(); at != waiting.end() && group.size() < most;) {
      if (!first.is_alike(*(*at)->work)) {
        ++at;
        continue;
      }
      (*at)->taken = true;
      group.push_back(*at);
      at = waiting.erase(at);
    }
    return group;
  }

  /// The method takes what waits, and lets go of the lock while the GPU is at it.
  void lead(std::unique_lock<std::mutex>& lock, bool early) {
    const Group group = take();
    Lane& lane = *std::ranges::find_if(lanes, &Lane::is_free);
    lane.is_free = false;
    ++busy;
    lock.unlock();
    std::exception_ptr failure;
    try {
      lane.run(group, early);
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    lane.is_free = true;
    --busy;
    for (Request* request : group) {
      request->failure = failure;
      request->done = true;
      request->changed.notify_one();
    }
    if (may_start()) waiting.front()->changed.notify_one();
  }

  int gpu, least;
  int busy = 0;
  std::array<Lane, most_lanes> lanes;
  std::deque<Request*> waiting;
  std::mutex mutex;
};

Together::Together(int gpu, int devices) {
  check_cuda(cudaSetDevice(gpu), "cudaSetDevice");
  state_ = std::make_unique<State>(gpu, devices);
}
Together::~Together() { (void)cudaSetDevice(state_->gpu); }

void Together::run(const GpuDevice& device, const SharedWork& work, int times) {
  GpuState& own = device.state();
  const bool waits = !own.is_idle;
  own.select();
  if (waits) check_cuda(cudaEventRecord(own.ready, own.stream), "event");
  Request request{.work = &work, .times = times, .ready = waits ? own.ready : nullptr};
  {
    std::unique_lock<std::mutex> lock(state_->mutex);
    state_->waiting.push_back(&request);
    while (!request.done) {
      if (!request.taken && state_->may_start()) {
        state_->lead(lock, own.starts_early);
      } else {
        request.changed.wait(lock);
      }
    }
  }
  own.is_idle = true;
  if (request.failure) std::rethrow_exception(request.failure);
}

void share_starts(const std::vector<AnyDevice>& devices) {
  std::map<int, std::vector<const GpuDevice*>> of_gpu;
  for (const AnyDevice& device : devices) {
    if (device.is_gpu()) of_gpu[device.gpu().index()].push_back(&device.gpu());
  }
  for (const auto& [gpu, sharing] : of_gpu) {
    if (sharing.size() < 2) continue;
    const auto together = std::make_shared<Together>(gpu, static_cast<int>(sharing.size()));
    for (const GpuDevice* device : sharing) device->state().together = together;
  }
}

namespace detail {
LaunchList* gpu_kept(const GpuDevice& device) { return device.state().kept; }

Together* gpu_together(const GpuDevice& device) { return device.state().together.get(); }

IntoList::IntoList(const GpuDevice& device, LaunchList& list) : device_(device) {
  list.clear();
  device.state().kept = &list;
}
IntoList::~IntoList() { device_.state().kept = nullptr; }
}  // namespace detail
}  // namespace talus

#else

namespace talus {
struct Together::State {};
Together::Together(int, int) { throw std::logic_error("this binary was built without CUDA"); }
Together::~Together() = default;
void Together::run(const GpuDevice&, const SharedWork&, int) {}
void share_starts(const std::vector<AnyDevice>&) {}
namespace detail {
Together* gpu_together(const GpuDevice&) { return nullptr; }
IntoList::IntoList(const GpuDevice& device, LaunchList&) : device_(device) {}
IntoList::~IntoList() = default;
}  // namespace detail
}  // namespace talus

#endif
