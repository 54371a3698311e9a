// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a library does with a broken file stays in the process that reads it.
#include "common/stage/child_reading.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <string>

#include "common/error.hpp"
#include "tests/common/scratch.hpp"

namespace talus {
namespace {

const KnownChildReading child_echo("test echo", [](const std::vector<std::string>& words) {
  return words.at(1) + std::string(200000, '.') + (std::to_string(::getppid()) == words.at(2) ? "child" : "same");
});
const KnownChildReading child_fault("test fault", [](const std::vector<std::string>& words) -> std::string {
  throw DataError({words.at(0) + ": what", "why", "mend"});
});
const KnownChildReading child_crash("test crash", [](const std::vector<std::string>&) -> std::string {
  std::signal(SIGSEGV, SIG_DFL);  // a sanitizer would report it
  ::raise(SIGSEGV);
  return "";
});
const KnownChildReading child_memory("test memory",
                                     [](const std::vector<std::string>&) -> std::string { throw std::bad_alloc(); });
const KnownChildReading child_other("test other", [](const std::vector<std::string>&) -> std::string {
  throw std::out_of_range("an index of the library's");
});

std::string child_fault_of(const std::string& name) {
  return test::fault_of<DataError>(
      [&] { read_in_child({.name = name, .words = {}, .file = "/no/file.vdb", .mend = "Write it again"}); });
}

TEST(ChildReading, bytes_come_from_a_process_of_its_own) {
  const std::string answer = read_in_child(
      {.name = "test echo", .words = {std::string("a word"), std::to_string(::getpid())}, .file = "f", .mend = ""});
  EXPECT_EQ(answer.size(), 200011u);
  EXPECT_TRUE(answer.starts_with("a word."));
  EXPECT_TRUE(answer.ends_with(".child")) << "the reading was done here";
}

TEST(ChildReading, faults_come_back_in_their_parts) {
  EXPECT_EQ(child_fault_of("test fault"), "/no/file.vdb: what (why). mend");
}

TEST(ChildReading, a_crash_is_a_fault_of_the_file) {
  EXPECT_EQ(child_fault_of("test crash"),
            "/no/file.vdb: cannot be read (it is damaged: the library that reads it crashed on it (Segmentation "
            "fault)). Write it again");
  EXPECT_NE(child_fault_of("test memory").find("it asks for more than 2048 MiB of memory"), std::string::npos);
  EXPECT_EQ(child_fault_of("test other"),
            "/no/file.vdb: cannot be read (it is damaged: an index of the library's). Write it again");
}

}  // namespace
}  // namespace talus
