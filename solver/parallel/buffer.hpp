// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Arrays in the memory of a device.
#pragma once

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "solver/parallel/device.hpp"

namespace talus {

/// An array in memory of one device, which owns it and on whose stream it is filled and copied. It grows and never
/// shrinks; contents are lost on growth. At first it is as large as asked for: what never grows takes no more.
template <class T, class Device>
class Buffer {
 public:
  /// An empty array of no device; one that was made on a device is to take its place before it is used.
  Buffer() = default;
  explicit Buffer(Device device) : device_(std::move(device)) {}
  Buffer(Device device, std::size_t size) : device_(std::move(device)) { resize(size); }
  /// Both go on with the device, hence its copy.
  // NOLINTNEXTLINE(cert-oop11-cpp,performance-move-constructor-init)
  Buffer(Buffer&& other) noexcept : device_(other.device_) { swap(other); }
  Buffer& operator=(Buffer&& other) noexcept {
    std::swap(device_, other.device_);
    swap(other);
    return *this;
  }
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;
  ~Buffer() { release(); }

  const Device& device() const { return device_; }  ///< device that owns the memory
  /// The address of the first element, in the memory of the device; null while nothing has been taken.
  T* data() { return data_; }
  const T* data() const { return data_; }
  std::size_t size() const { return size_; }  ///< number of elements in use
  /// The memory taken [bytes], of which the elements in use may be a part.
  std::size_t bytes() const { return capacity_ * sizeof(T); }

  /// Sets the number of elements; contents are undefined. Throws NumericalError: too little memory on the device.
  void resize(std::size_t size) {
    if (size > capacity_) {
      const std::size_t capacity = capacity_ == 0 ? size : size + size / 8;
      release();
      data_ = static_cast<T*>(detail::allocate(device_, capacity * sizeof(T)));
      capacity_ = capacity;
    }
    size_ = size;
  }
  /// The method makes the buffer a copy of `values`, of their size.
  void upload(const std::vector<T>& values) {
    resize(values.size());
    if (!values.empty()) detail::upload(device_, data_, values.data(), values.size() * sizeof(T));
  }
  /// The method returns a copy of all elements, once all work that was started on the device is done.
  std::vector<T> download() const {
    std::vector<T> values;
    download(values);
    return values;
  }
  /// The same into a list, whose memory it keeps where that is enough.
  void download(std::vector<T>& to) const {
    to.resize(size_);
    if (!to.empty()) detail::download(device_, to.data(), data_, size_ * sizeof(T));
  }
  /// The method sets every byte in use to zero.
  void fill_zero() {
    if (size_ > 0) detail::fill_zero(device_, data_, size_ * sizeof(T));
  }
  /// The method sets the number of elements, and every byte of them to zero.
  void resize_zeroed(std::size_t size) {
    resize(size);
    fill_zero();
  }
  /// The method gives the memory back; the size becomes 0.
  void drop() noexcept {
    release();
    size_ = 0;
  }
  /// The method exchanges the memory of two buffers of one device.
  void swap(Buffer& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    std::swap(capacity_, other.capacity_);
  }

 private:
  void release() noexcept {
    if (!data_) return;
    detail::free(device_, data_, bytes());
    data_ = nullptr;
    capacity_ = 0;
  }
  Device device_;
  T* data_ = nullptr;
  std::size_t size_ = 0, capacity_ = 0;
};

/// A few arrays of one device, by number.
template <class T, class Device, std::size_t number>
class Buffers {
 public:
  explicit Buffers(const Device& device) : Buffers(device, std::make_index_sequence<number>()) {}
  template <class Index>
  Buffer<T, Device>& operator[](Index n) {
    return all_[static_cast<std::size_t>(n)];
  }
  template <class Index>
  const Buffer<T, Device>& operator[](Index n) const {
    return all_[static_cast<std::size_t>(n)];
  }
  auto begin() { return all_.begin(); }  ///< first buffer
  auto end() { return all_.end(); }      ///< end of the buffers
  auto begin() const { return all_.begin(); }
  auto end() const { return all_.end(); }

 private:
  template <std::size_t... n>
  Buffers(const Device& device, std::index_sequence<n...>)
      : all_{(static_cast<void>(n), Buffer<T, Device>(device))...} {}
  std::array<Buffer<T, Device>, number> all_;
};

/// This function uploads values that are kept in double on the host, rounded to `Real`.
template <class Real, class Device>
void upload_as(Buffer<Real, Device>& to, const std::vector<double>& from) {
  to.upload(std::vector<Real>(from.begin(), from.end()));
}

/// The memory that buffers, and what else has bytes(), take together [bytes].
template <class... Owners>
std::size_t bytes_of(const Owners&... owners) {
  return (owners.bytes() + ...);
}

}  // namespace talus
