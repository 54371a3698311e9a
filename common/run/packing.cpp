// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/run/packing.hpp"

#include "common/deflate.hpp"

namespace talus::h5 {

std::string packed(std::span<const char> values, std::size_t bytes, std::size_t width) {
  std::string shuffled(bytes, '\0');
  const std::size_t count = bytes / width;
  for (std::size_t b = 0; b < width; ++b)
    for (std::size_t n = 0; n < values.size() / width; ++n) shuffled[b * count + n] = values[n * width + b];
  return deflated(shuffled, effort);
}

bool unpacked(std::span<const char> stored, std::size_t bytes, std::size_t width, std::size_t skip,
              std::span<char> values) {
  std::string shuffled(bytes, '\0');
  if (!inflate_to(shuffled, stored)) return false;
  const std::size_t count = bytes / width, first = skip / width;
  for (std::size_t n = 0; n < values.size() / width; ++n)
    for (std::size_t b = 0; b < width; ++b) values[n * width + b] = shuffled[b * count + first + n];
  return true;
}

PackingQueue::~PackingQueue() {
  packing_.cancel();
  try {
    wait();
  } catch (...) {  // of a file that nobody closes any more
  }
}

void PackingQueue::add(PackingChunk chunk) {
  Entry& own = entries_.emplace_back();  // which stays where it is
  own.chunk = std::move(chunk);
  arena_.execute([&] {
    packing_.run([&own] {
      own.chunk.stored = packed(own.chunk.values, own.chunk.bytes, own.chunk.width);
      own.chunk.values = {};
      own.done = true;
    });
  });
}

void PackingQueue::wait() {
  arena_.execute([&] { packing_.wait(); });
}

void PackingQueue::write(bool all, const std::function<void(const PackingChunk&)>& write) {
  constexpr std::size_t most = 128;
  if (all || entries_.size() > most) wait();
  for (; !entries_.empty() && entries_.front().done; entries_.pop_front()) write(entries_.front().chunk);
}

}  // namespace talus::h5
