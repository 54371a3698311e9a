// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/state/particles.hpp"

#include <algorithm>

#include "solver/parallel/algorithms.hpp"
#include "solver/state/sides.hpp"

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

/// The arrays of all fields that go into another order together: thirty kernels take longer than what they do.
template <class Real>
struct GatherFields {
  GatherAll<Real, components_kept(false)> reals;
  GatherAll<int, components_kept(true)> ints;
  void add(const Real* from, Real* to) { add_to(reals, from, to); }
  void add(const int* from, int* to) { add_to(ints, from, to); }
  TALUS_HD void operator()(int p) const {
    reals(p);
    ints(p);
  }

 private:
  template <class T, std::size_t most>
  static void add_to(GatherAll<T, most>& all, const T* from, T* to) {
    all.from[all.count] = from;
    all.to[all.count++] = to;
  }
};

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

/// This function makes an array longer and keeps what it holds. Where that has no room, it takes some for as many
/// elements again, so that what grows bit by bit is copied seldom.
template <class Number, class Device>
void grow(Buffer<Number, Device>& array, std::size_t all) {
  const std::size_t before = array.size();
  if (all * sizeof(Number) > array.bytes()) {
    Buffer<Number, Device> larger(array.device(), std::max(all, 2 * before));
    for_each(array.device(), static_cast<int>(before), CopyOver<Number>{array.data(), larger.data()});
    array.swap(larger);
  }
  array.resize(all);
}

/// This function adds a list behind what an array holds.
template <class Number, class Device, class Value>
void append_list(Buffer<Number, Device>& to, const std::vector<Value>& list) {
  const std::size_t before = to.size();
  grow(to, before + list.size());
  const std::vector<Number> values(list.begin(), list.end());
  detail::upload(to.device(), to.data() + before, values.data(), values.size() * sizeof(Number));
}

/// This function downloads an array into a list in the numbers of the host.
template <class Number, class Device, class Value>
void download_list(const Buffer<Number, Device>& from, std::vector<Value>& to) {
  if constexpr (std::is_same_v<Number, Value>) {
    from.download(to);
  } else {
    const std::vector<Number> values = from.download();
    to.assign(values.begin(), values.end());
  }
}

/// Between sides in metres and in cells, at the ground below a point.
template <class Real>
struct CellFrame {
  Real spacing, layer_height, slope_x = 0, slope_y = 0;

  TALUS_HD CellFrame(const GridView<Real>& grid, const ParticleView<Real>& points, int p)
      : spacing(grid.spacing), layer_height(grid.layer_height) {
    if (grid.mapping != Mapping::terrain_following) return;
    const int column = grid.column(points.cell[0][p], points.cell[1][p]);
    slope_x = grid.slope_x[column];
    slope_y = grid.slope_y[column];
  }
  TALUS_HD Vec3<Real> in_cells(const Vec3<Real>& e) const {
    return {e.x / spacing, e.y / spacing, (e.z - slope_x * e.x - slope_y * e.y) / layer_height};
  }
  TALUS_HD Vec3<Real> in_metres(const Vec3<Real>& e) const {
    return {e.x * spacing, e.y * spacing, e.z * layer_height + (slope_x * e.x + slope_y * e.y) * spacing};
  }
  /// The sides of point p in cells, shear taken off.
  TALUS_HD Sides<Real> sides_of(const ParticleView<Real>& points, int p) const {
    Sides<Real> s{in_cells(points.side_of(p, 0)), in_cells(points.side_of(p, 1))};
    s.reduce();
    return s;
  }
};

/// One thread: one point. It is to be halved where its longer side exceeds a cell, the reach of its functions, and
/// where one of the columns that the side lies over holds few points: beyond there would be a gap between it and the
/// next. Not in a spray, whose mass has come apart, nor once too often.
template <class Real>
struct MarkLong {
  static constexpr int enough = 8;      // points in a column, over three layers: two along each side of a cell
  static constexpr double spray = 0.7;  // ln of the volume over the initial one
  static constexpr double lost = 100;   // a side in cells that no flow has
  GridView<Real> grid;
  ParticleView<Real> points;
  const std::uint64_t* keys;
  int* marks;

  TALUS_HD void operator()(int p) const { marks[p] = is_long(p) ? 1 : 0; }

 private:
  TALUS_HD bool is_long(int p) const {
    if (points.cell[0][p] < 0 || points.piece[p] >= smallest_parts || points.log_volume[p] > Real(spray)) return false;
    const Vec3<Real> side = CellFrame<Real>(grid, points, p).sides_of(points, p).longer;
    const Real square = dot(side, side);
    if (!(square > Real(1)) || !(square < Real(lost * lost))) return false;
    return few(p, Real(0), Real(0)) || few(p, side.x, side.y) || few(p, -side.x, -side.y);
  }
  /// Whether the column at the end of half a side (x, y) from point p holds few points near its layer.
  TALUS_HD bool few(int p, Real x, Real y) const {
    const int i = points.cell[0][p] + static_cast<int>(floor(points.offset[0][p] + Real(0.5) * x + Real(0.5)));
    const int j = points.cell[1][p] + static_cast<int>(floor(points.offset[1][p] + Real(0.5) * y + Real(0.5)));
    if (i < 0 || j < 0 || i >= grid.columns || j >= grid.rows) return false;
    const int k = points.cell[2][p];
    const int last = before(home_key(grid.block_columns_x, i, j, k > 0 ? k - 1 : 0)) + enough - 1;
    return last >= points.count || keys[last] >= home_key(grid.block_columns_x, i, j, k + 2);
  }
  /// The points that come before a key.
  TALUS_HD int before(std::uint64_t key) const {
    int low = 0, high = points.count;
    while (low < high) {
      const int middle = low + (high - low) / 2;
      if (keys[middle] < key)
        low = middle + 1;
      else
        high = middle;
    }
    return low;
  }
};

/// One thread: one point. The order of the points as they are, and behind them the marked ones once more.
struct NameTwice {
  const int* upto;  ///< marked points up to each
  int count;
  int* order;
  TALUS_HD void operator()(int p) const {
    order[p] = p;
    if (upto[p] > (p > 0 ? upto[p - 1] : 0)) order[count + upto[p] - 1] = p;
  }
};

/// One thread: one of the points that stand twice. It and its copy become halves, whose middles lie a quarter of the
/// side from its own, and at most half a cell: further away its velocity gradient says nothing, and would make energy
/// of a side that grew in flight.
template <class Real>
struct Halve {
  GridView<Real> grid;
  ParticleView<Real> points;
  const int* marked;  ///< their places
  int copies;         ///< place of the first one
  bool affine;

  TALUS_HD void operator()(int n) const {
    const int p = marked[n], copy = copies + n;
    const CellFrame<Real> frame(grid, points, p);
    Sides<Real> s = frame.sides_of(points, p);
    const Real length = Real(sqrt(dot(s.longer, s.longer)));
    const Vec3<Real> way = s.longer * (length > Real(2) ? Real(0.5) / length : Real(0.25));
    s.longer = s.longer * Real(0.5);
    for (const int q : {p, copy}) {
      points.volume[q] *= Real(0.5);
      points.piece[q] *= 2;
      points.set_side(q, 0, frame.in_metres(s.shorter));
      points.set_side(q, 1, frame.in_metres(s.longer));
    }
    ++points.piece[copy];
    carry(p, way);
    carry(copy, way * Real(-1));
  }

 private:
  /// Moves a half by `way` [cells], to the velocity there.
  TALUS_HD void carry(int p, const Vec3<Real>& way) const {
    if (affine) {
      const Mat3<Real> c = points.affine_of(p);
      points.set_velocity(p, points.velocity_of(p) + c.a * way.x + c.b * way.y + c.c * way.z);
    }
    const int from[3] = {points.cell[0][p], points.cell[1][p], points.cell[2][p]};
    const Real offset[3] = {points.offset[0][p], points.offset[1][p], points.offset[2][p]};
    points.move_by(p, way, grid.walls);
    const int i = points.cell[0][p], j = points.cell[1][p];
    if (i >= 0 && j >= 0 && i < grid.columns && j < grid.rows && grid.open[grid.column(i, j)]) return;
    for (int a = 0; a < 3; ++a) {  // not out of the domain
      points.cell[a][p] = from[a];
      points.offset[a][p] = offset[a];
    }
  }
};

}  // namespace

void ParticleState::resize(std::size_t count) {
  const auto resize_one = [&](const ParticleField& field, int, auto& list) {
    list.assign(may_be_empty(field) ? 0 : count, field.initial);
  };
  visit_particle_fields(resize_one, *this);
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
    } else if (list.empty() && field.initial == 0) {
      array.resize_zeroed(state.size());
    } else if (may_be_empty(field) && list.empty()) {
      upload_list(array, std::decay_t<decltype(list)>(state.size(), field.initial));
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
    } else if (may_be_empty(field) && list.empty()) {
      append_list(array, std::decay_t<decltype(list)>(more.size(), field.initial));
    } else {
      append_list(array, list);
    }
  };
  visit_particle_fields(append_one, arrays_, more);
  count_ = static_cast<int>(all);
}

template <class Real, class Device>
void Particles<Real, Device>::download(Kept least, ParticleState& to) const {
  const auto download_one = [&](const ParticleField& field, int, const auto& array, auto& list) {
    if (field.kept >= least && holds(field)) download_list(array, list);
  };
  visit_particle_fields(download_one, arrays_, to);
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
  GatherFields<Real> gather;
  gather.reals.order = gather.ints.order = order.data();
  const auto add = [&](const ParticleField& field, int, auto& from, auto& to) {
    if (!sorts(field)) return;
    to.resize(static_cast<std::size_t>(count));
    gather.add(from.data(), to.data());
  };
  visit_particle_fields(add, arrays_, twins_);
  for_each(device_, count, gather);
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

template <class Real, class Device>
bool Particles<Real, Device>::split(const GridView<Real>& grid, const std::uint64_t* keys) {
  if (!needs_.spreads) return false;
  const int before = count_;
  Buffer<int, Device>& marks = int_scratch_;
  marks.resize(static_cast<std::size_t>(before));
  for_each(device_, before, MarkLong<Real>{grid, view(), keys, marks.data()});
  const int more = inclusive_sum(device_, marks.data(), marks.data(), before);
  if (more == 0) return false;
  Buffer<int, Device> order(device_, static_cast<std::size_t>(before + more));
  for_each(device_, before, NameTwice{marks.data(), before, order.data()});
  reorder(order, before + more);
  const auto fit = [&](const ParticleField& field, int, auto& array) {
    if (holds(field) && !sorts(field)) array.resize(static_cast<std::size_t>(count_));
  };
  visit_particle_fields(fit, arrays_);
  for_each(device_, more, Halve<Real>{grid, view(), order.data() + before, before, needs_.affine_transfer});
  return true;
}

template class Particles<float, CpuDevice>;
template class Particles<double, CpuDevice>;
#if TALUS_FOR_GPU
template class Particles<float, GpuDevice>;
template class Particles<double, GpuDevice>;
#endif

}  // namespace talus
