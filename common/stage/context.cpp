// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/stage/context.hpp"

#include <algorithm>
#include <utility>

#include "common/stage/interrupt.hpp"
#include "common/stage/output_lock.hpp"

namespace talus {
namespace {

thread_local Context* bound_here = nullptr;

/// Control characters may stand in names of files, and a terminal would obey them.
std::string without_control_characters(std::string text) {
  for (char& c : text)
    if ((static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t') || c == 0x7f) c = '?';
  return text;
}

}  // namespace

Context& context() {
  // Never destroyed: threads to which no context is bound may outlive main().
  static Context* const of_other_threads = [] {
    auto* made = new Context;
    made->heed_signals();
    made->paths_ = &shown_paths_of_other_threads();
    return made;
  }();
  return bound_here != nullptr ? *bound_here : *of_other_threads;
}

BindContext::BindContext(Context& bound) : previous_(std::exchange(bound_here, &bound)), paths_(bound.paths()) {}
BindContext::~BindContext() { bound_here = previous_; }

RedirectLog::RedirectLog(LogSink sink)
    : context_(context()), previous_(std::exchange(context_.redirect_, std::move(sink))) {}
RedirectLog::~RedirectLog() { context_.redirect_ = std::move(previous_); }

bool Context::is_interrupted() const { return interrupted_ || (heeds_signals_ && signal_came()); }

void Context::log(LogLevel level, const std::string& text) {
  if (level == LogLevel::detail && verbosity != Verbosity::verbose) return;
  if (!redirect_ && verbosity == Verbosity::quiet && level != LogLevel::error) return;
  const std::string shown = without_control_characters(level == LogLevel::progress ? text : paths_->in_message(text));
  const LogSink& sink = redirect_ ? redirect_ : sink_;
  if (!sink) return write_to_stderr(level, shown);
  const std::lock_guard lock(mutex_);
  sink(level, shown);
}

void Context::note_checksum(const std::filesystem::path& file, std::string digest) {
  const std::lock_guard lock(mutex_);
  checksums_[file] = std::move(digest);
}

std::string Context::checksum_of(const std::filesystem::path& file) const {
  const std::lock_guard lock(mutex_);
  const auto found = checksums_.find(file);
  return found == checksums_.end() ? "" : found->second;
}

void Context::add_lock(const std::filesystem::path& file, bool held) {
  const std::lock_guard lock(mutex_);
  locks_.push_back({file, held});
}

void Context::remove_lock(const std::filesystem::path& file) {
  const std::lock_guard lock(mutex_);
  std::erase_if(locks_, [&](const Lock& one) { return one.file == file; });
}

bool Context::has_locked(const std::filesystem::path& folder) const {
  const std::lock_guard lock(mutex_);
  return std::any_of(locks_.begin(), locks_.end(), [&](const Lock& one) { return one.file == lock_file_of(folder); });
}

bool Context::holds_a_lock() const {
  const std::lock_guard lock(mutex_);
  return std::any_of(locks_.begin(), locks_.end(), [](const Lock& one) { return one.held; });
}

}  // namespace talus
