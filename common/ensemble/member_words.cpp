// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/ensemble/member_words.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "common/run/hdf5.hpp"

namespace talus {

void add_in_order(std::vector<MemberWords>& list, MemberWords words) {
  const auto after = std::upper_bound(list.begin(), list.end(), words.member,
                                      [](std::int64_t k, const MemberWords& one) { return k < one.member; });
  list.insert(after, std::move(words));
}

void write_member_words(h5::File& file, const std::string& group, const std::vector<MemberWords>& list) {
  file.make_group(group);
  for (std::size_t n = 0; n < list.size(); ++n) {
    const auto one = fmt::format("{}/{:06}", group, n);
    file.make_group(one);
    file.set_integer(one, "member", list[n].member);
    file.set_text(one, "words", list[n].words);
  }
}

std::vector<MemberWords> read_member_words(const h5::File& file, const std::string& group) {
  std::vector<MemberWords> list;
  if (!file.exists(group)) return list;
  for (const std::string& name : file.children(group)) {
    const auto one = fmt::format("{}/{}", group, name);
    list.push_back({file.integer(one, "member"), file.text(one, "words")});
  }
  return list;
}

}  // namespace talus
