// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/parallel/alone.hpp"

#include <utility>

namespace talus {
namespace {

thread_local bool works_alone = false;

}  // namespace

Alone::Alone() : before_(std::exchange(works_alone, true)) {}
Alone::~Alone() { works_alone = before_; }
bool Alone::here() { return works_alone; }

}  // namespace talus
