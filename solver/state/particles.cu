#include "solver/state/particles.hpp"

#include <type_traits>

namespace talus {
namespace {

template <class T>
struct Gather {
  const int* order;
  const T* from;
  T* to;
  TALUS_HD void operator()(int p) const { to[p] = from[order[p]]; }
};

/// Arrays of one kind that go into another order together.
template <class T, int most>
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

template <class Real, class Device>
std::vector<double> download_as(const Buffer<Real, Device>& from) {
  std::vector<Real> values = from.download();
  if constexpr (std::is_same_v<Real, double>) {
    return values;
  } else {
    return {values.begin(), values.end()};
  }
}

}  // namespace

template <class Real, class Device>
bool Particles<Real, Device>::in_use(int slot) const {
  if (slot >= move_slot) return fields_.move;
  if (slot >= shear_slot) return fields_.plastic_shear;
  if (slot >= extent_slot) return fields_.extent;
  if (slot >= acceleration_slot) return fields_.acceleration;
  if (slot >= affine_slot) return fields_.affine;
  return slot != plastic_slot || fields_.plastic_volume;
}

template <class Real, class Device>
void Particles<Real, Device>::upload(const ParticleState& state) {
  count_ = static_cast<int>(state.size());
  for (int a = 0; a < 3; ++a) {
    ints_[a].upload(state.cell[a]);
    upload_as(reals_[offset_slot + a], state.offset[a]);
    upload_as(reals_[velocity_slot + a], state.velocity[a]);
    if (fields_.extent) upload_as(reals_[extent_slot + a], state.extent[a]);
    if (fields_.move) reals_[move_slot + a].resize(state.size());
    if (fields_.acceleration) upload_as(reals_[acceleration_slot + a], state.acceleration[a]);
  }
  ints_[3].upload(state.id);
  ints_[4].upload(state.release);
  if (fields_.load) ints_[load_slot].upload(state.load);
  if (fields_.material) ints_[material_slot].upload(state.material);
  if (fields_.plastic_shear) upload_as(reals_[shear_slot], state.plastic_shear);
  for (int a = 0; a < 6; ++a) upload_as(reals_[elastic_slot + a], state.elastic[a]);
  for (int a = 0; fields_.affine && a < 9; ++a) upload_as(reals_[affine_slot + a], state.affine[a]);
  upload_as(reals_[log_slot], state.log_volume);
  upload_as(reals_[volume_slot], state.volume);
  if (fields_.plastic_volume) upload_as(reals_[plastic_slot], state.plastic_log_volume);
}

template <class Real, class Device>
ParticleState Particles<Real, Device>::download_shown() const {
  ParticleState state;
  const auto zeros = std::vector<double>(static_cast<std::size_t>(count_), 0.0);
  for (int a = 0; a < 3; ++a) {
    state.cell[a] = ints_[a].download();
    state.offset[a] = download_as(reals_[offset_slot + a]);
    state.velocity[a] = download_as(reals_[velocity_slot + a]);
  }
  state.id = ints_[3].download();
  state.release = ints_[4].download();
  state.material =
      fields_.material ? ints_[material_slot].download() : std::vector<int>(static_cast<std::size_t>(count_), 0);
  state.plastic_shear = fields_.plastic_shear ? download_as(reals_[shear_slot]) : zeros;
  for (int a = 0; a < 6; ++a) state.elastic[a] = download_as(reals_[elastic_slot + a]);
  state.log_volume = download_as(reals_[log_slot]);
  state.volume = download_as(reals_[volume_slot]);
  state.plastic_log_volume = fields_.plastic_volume ? download_as(reals_[plastic_slot]) : zeros;
  return state;
}

template <class Real, class Device>
ParticleState Particles<Real, Device>::download() const {
  ParticleState state = download_shown();
  const auto zeros = std::vector<double>(static_cast<std::size_t>(count_), 0.0);
  for (int a = 0; a < 3; ++a) {
    state.extent[a] = fields_.extent ? download_as(reals_[extent_slot + a]) : zeros;
    state.acceleration[a] = fields_.acceleration ? download_as(reals_[acceleration_slot + a]) : zeros;
  }
  for (int a = 0; a < 9; ++a) state.affine[a] = fields_.affine ? download_as(reals_[affine_slot + a]) : zeros;
  state.load = fields_.load ? ints_[load_slot].download() : std::vector<int>(static_cast<std::size_t>(count_), -1);
  return state;
}

template <class Real, class Device>
ParticleView<Real> Particles<Real, Device>::view() {
  ParticleView<Real> v;
  v.count = count_;
  v.cell_x = ints_[0].data();
  v.cell_y = ints_[1].data();
  v.cell_z = ints_[2].data();
  v.id = ints_[3].data();
  v.release = ints_[4].data();
  v.offset_x = reals_[offset_slot].data();
  v.offset_y = reals_[offset_slot + 1].data();
  v.offset_z = reals_[offset_slot + 2].data();
  for (int a = 0; a < 3; ++a) v.velocity[a] = reals_[velocity_slot + a].data();
  for (int a = 0; a < 3; ++a) v.extent[a] = reals_[extent_slot + a].data();
  for (int a = 0; a < 3; ++a) v.move[a] = reals_[move_slot + a].data();
  for (int a = 0; a < 3; ++a) v.acceleration[a] = reals_[acceleration_slot + a].data();
  v.load = ints_[load_slot].data();
  v.material = ints_[material_slot].data();
  v.plastic_shear = reals_[shear_slot].data();
  for (int a = 0; a < 6; ++a) v.elastic[a] = reals_[elastic_slot + a].data();
  for (int a = 0; a < 9; ++a) v.affine[a] = reals_[affine_slot + a].data();
  v.log_volume = reals_[log_slot].data();
  v.plastic_log_volume = reals_[plastic_slot].data();
  v.volume = reals_[volume_slot].data();
  return v;
}

template <class Real, class Device>
std::size_t Particles<Real, Device>::bytes() const {
  std::size_t total = real_scratch_.bytes() + int_scratch_.bytes();
  for (const auto& array : reals_) total += array.bytes();
  for (const auto& array : ints_) total += array.bytes();
  for (const auto& array : real_twins_) total += array.bytes();
  for (const auto& array : int_twins_) total += array.bytes();
  return total;
}

template <class Real, class Device>
bool Particles<Real, Device>::int_in_use(int slot) const {
  return (slot != load_slot || fields_.load) && (slot != material_slot || fields_.material);
}

/// Every array at once, into a second set of them.
template <class Real, class Device>
void Particles<Real, Device>::reorder_together(const Buffer<int, Device>& order, int count) {
  GatherAll<Real, move_slot> reals;
  reals.order = order.data();
  GatherAll<int, int_slots> ints;
  ints.order = order.data();
  const auto add = [&](auto& gather, auto& from, auto& to) {
    to.resize(static_cast<std::size_t>(count));
    gather.from[gather.count] = from.data();
    gather.to[gather.count++] = to.data();
  };
  for (int slot = 0; slot < move_slot; ++slot) {
    if (in_use(slot)) add(reals, reals_[slot], real_twins_[slot]);
  }
  for (int slot = 0; slot < int_slots; ++slot) {
    if (int_in_use(slot)) add(ints, ints_[slot], int_twins_[slot]);
  }
  for_each(device_, count, reals);
  for_each(device_, count, ints);
  for (int slot = 0; slot < move_slot; ++slot) {
    if (in_use(slot)) reals_[slot].swap(real_twins_[slot]);
  }
  for (int slot = 0; slot < int_slots; ++slot) {
    if (int_in_use(slot)) ints_[slot].swap(int_twins_[slot]);
  }
  count_ = count;
}

template <class Real, class Device>
void Particles<Real, Device>::reorder(const Buffer<int, Device>& order, int count) {
  constexpr int few = 1 << 19;  // points whose state may be kept twice: thirty kernels take longer than what they do
  if (Device::is_gpu && count_ <= few) return reorder_together(order, count);
  for (int slot = 0; slot < real_slots; ++slot) {
    if (!in_use(slot) || slot >= move_slot) continue;  // the displacement lives within one step only
    real_scratch_.resize(static_cast<std::size_t>(count));
    for_each(device_, count, Gather<Real>{order.data(), reals_[slot].data(), real_scratch_.data()});
    reals_[slot].swap(real_scratch_);
  }
  for (int slot = 0; slot < int_slots; ++slot) {
    if (!int_in_use(slot)) continue;
    auto& array = ints_[slot];
    int_scratch_.resize(static_cast<std::size_t>(count));
    for_each(device_, count, Gather<int>{order.data(), array.data(), int_scratch_.data()});
    array.swap(int_scratch_);
  }
  count_ = count;
}

template class Particles<float, CpuDevice>;
template class Particles<double, CpuDevice>;
#if TALUS_FOR_GPU
template class Particles<float, GpuDevice>;
template class Particles<double, GpuDevice>;
#endif

}  // namespace talus
