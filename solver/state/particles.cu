// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/state/particles.hpp"

#include <algorithm>

namespace talus {
namespace {

template <class T>
struct Gather {
  const int* order;
  const T* from;
  T* to;
  TALUS_HD void operator()(int p) const { to[p] = from[order[p]]; }
};

/// The arrays of one kind that go into another order together.
template <class T, std::size_t most>
struct GatherAll {
  const int* order = nullptr;
  int count = 0;  // of arrays
  const T* from[most] = {};
  T* to[most] = {};
  TALUS_HD void operator()(int p) const {
    const int q = order[p];
    for (int a = 0; a < count; ++a) to[a][p] = from[a][q];
  }
};

/// The one of two gatherings that takes arrays of these numbers.
template <class Real, std::size_t most_reals, std::size_t most_ints>
GatherAll<Real, most_reals>& gather_of(const Real*, GatherAll<Real, most_reals>& reals, GatherAll<int, most_ints>&) {
  return reals;
}
template <class Real, std::size_t most_reals, std::size_t most_ints>
GatherAll<int, most_ints>& gather_of(const int*, GatherAll<Real, most_reals>&, GatherAll<int, most_ints>& ints) {
  return ints;
}

template <class Number, class Device, class Value>
void upload_list(Buffer<Number, Device>& to, const std::vector<Value>& from) {
  if constexpr (std::is_same_v<Number, Value>) {
    to.upload(from);
  } else {
    upload_as(to, from);
  }
}

template <class T>
struct CopyOver {
  const T* from;
  T* to;
  TALUS_HD void operator()(int p) const { to[p] = from[p]; }
};

/// This function adds a list behind what an array holds. Where that has no room, it takes some for as many elements
/// again, so that what grows bit by bit is copied seldom.
template <class Number, class Device, class Value>
void append_list(Buffer<Number, Device>& to, const std::vector<Value>& list) {
  const std::size_t before = to.size(), all = before + list.size();
  if (all * sizeof(Number) > to.bytes()) {
    Buffer<Number, Device> larger(to.device(), std::max(all, 2 * before));
    for_each(to.device(), static_cast<int>(before), CopyOver<Number>{to.data(), larger.data()});
    to.swap(larger);
  }
  to.resize(all);
  const std::vector<Number> values(list.begin(), list.end());
  detail::upload(to.device(), to.data() + before, values.data(), values.size() * sizeof(Number));
}

/// This function downloads an array into a list in the numbers of the host.
template <class Number, class Device, class Value>
void download_list(const Buffer<Number, Device>& from, std::vector<Value>& to) {
  if constexpr (std::is_same_v<Number, Value>) {
    to = from.download();
  } else {
    const std::vector<Number> values = from.download();
    to.assign(values.begin(), values.end());
  }
}

}  // namespace

void ParticleState::resize(std::size_t count) {
  visit_particle_fields([&](const ParticleField& field, int, auto& list) { list.assign(count, field.initial); }, *this);
}

template <class Real, class Device>
Particles<Real, Device>::Particles(const Device& device, ParticleNeeds needs)
    : device_(device), needs_(needs), real_scratch_(device), int_scratch_(device) {
  const auto place = [&](const ParticleField&, int, auto& array, auto& twin) {
    array = std::decay_t<decltype(array)>(device);
    twin = std::decay_t<decltype(twin)>(device);
  };
  visit_particle_fields(place, arrays_, twins_);
}

template <class Real, class Device>
void Particles<Real, Device>::upload(const ParticleState& state) {
  count_ = static_cast<int>(state.size());
  const auto upload_one = [&](const ParticleField& field, int, auto& array, const auto& list) {
    if (!holds(field)) return;
    if (field.kept == Kept::within_step) {
      array.resize(state.size());
    } else {
      upload_list(array, list);
    }
  };
  visit_particle_fields(upload_one, arrays_, state);
}

template <class Real, class Device>
void Particles<Real, Device>::append(const ParticleState& more) {
  const auto before = static_cast<std::size_t>(count_), all = before + more.size();
  const auto append_one = [&](const ParticleField& field, int, auto& array, const auto& list) {
    if (!holds(field)) return;
    if (field.kept == Kept::within_step) {
      array.resize(all);
    } else {
      append_list(array, list);
    }
  };
  visit_particle_fields(append_one, arrays_, more);
  count_ = static_cast<int>(all);
}

template <class Real, class Device>
ParticleState Particles<Real, Device>::download(Kept least) const {
  ParticleState state;
  const auto download_one = [&](const ParticleField& field, int, const auto& array, auto& list) {
    if (field.kept < least) return;
    if (holds(field)) {
      download_list(array, list);
    } else {
      list.assign(static_cast<std::size_t>(count_), field.initial);
    }
  };
  visit_particle_fields(download_one, arrays_, state);
  return state;
}

template <class Real, class Device>
ParticleView<Real> Particles<Real, Device>::view() {
  ParticleView<Real> v;
  v.count = count_;
  visit_particle_fields([](const ParticleField&, int, auto& array, auto& pointer) { pointer = array.data(); }, arrays_,
                        v);
  return v;
}

template <class Real, class Device>
std::size_t Particles<Real, Device>::bytes() const {
  std::size_t total = real_scratch_.bytes() + int_scratch_.bytes();
  visit_particle_fields(
      [&](const ParticleField&, int, const auto& array, const auto& twin) { total += array.bytes() + twin.bytes(); },
      arrays_, twins_);
  return total;
}

/// The method puts every array at once into a second set of them, in the new order.
template <class Real, class Device>
void Particles<Real, Device>::reorder_together(const Buffer<int, Device>& order, int count) {
  GatherAll<Real, components_kept(false)> reals;
  GatherAll<int, components_kept(true)> ints;
  reals.order = ints.order = order.data();
  const auto add = [&](const ParticleField& field, int, auto& from, auto& to) {
    if (!sorts(field)) return;
    to.resize(static_cast<std::size_t>(count));
    auto& gather = gather_of(to.data(), reals, ints);
    gather.from[gather.count] = from.data();
    gather.to[gather.count++] = to.data();
  };
  visit_particle_fields(add, arrays_, twins_);
  for_each(device_, count, reals);
  for_each(device_, count, ints);
  const auto swap = [&](const ParticleField& field, int, auto& array, auto& twin) {
    if (sorts(field)) array.swap(twin);
  };
  visit_particle_fields(swap, arrays_, twins_);
  count_ = count;
}

template <class Real, class Device>
void Particles<Real, Device>::reorder(const Buffer<int, Device>& order, int count) {
  constexpr int few = 1 << 19;  // points whose state may be kept twice: thirty kernels take longer than what they do
  if (Device::is_gpu && count_ <= few) return reorder_together(order, count);
  const auto sort = [&](const ParticleField& field, auto& array, auto& scratch) {
    if (!sorts(field)) return;
    scratch.resize(static_cast<std::size_t>(count));
    using Number = std::remove_pointer_t<decltype(scratch.data())>;
    for_each(device_, count, Gather<Number>{order.data(), array.data(), scratch.data()});
    array.swap(scratch);
  };
  const auto sort_one = [&](const ParticleField& field, int, auto& array) {
    if constexpr (std::is_same_v<std::decay_t<decltype(array)>, Buffer<int, Device>>) {
      sort(field, array, int_scratch_);
    } else {
      sort(field, array, real_scratch_);
    }
  };
  visit_particle_fields(sort_one, arrays_);
  count_ = count;
}

template class Particles<float, CpuDevice>;
template class Particles<double, CpuDevice>;
#if TALUS_FOR_GPU
template class Particles<float, GpuDevice>;
template class Particles<double, GpuDevice>;
#endif

}  // namespace talus
