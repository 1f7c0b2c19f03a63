// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "base/archive.hpp"
#include "cut/cutter.hpp"

// What cuts have changed, as a value that can be kept, written and put back.
namespace resect {

struct CutterState;

std::shared_ptr<const CutterState> save_state(const Cutter& cutter);
/// Puts a state of the same cutter, or of one made from the same body, back.
void restore_state(Cutter& cutter, const CutterState& saved);
std::size_t bytes_of(const CutterState& saved); // about

void write_state(ByteWriter& writer, const CutterState& saved);
std::shared_ptr<const CutterState> read_state(ByteReader& reader);

} // namespace resect
