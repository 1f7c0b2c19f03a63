// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "sim/engine.hpp"

// What strokes began with, to go back to.
namespace resect {

namespace {

constexpr std::size_t strokes_at_most = 32;
constexpr std::size_t bytes_at_most = std::size_t{1} << 28U;

std::size_t bytes_of(const SavedEngine& saved) {
    return bytes_of(*saved.cutter) + sizeof(ElementBlock) * saved.state.elements.blocks.size() +
           bytes_of(saved.state.packing) + 120 * saved.state.nodes.mass.size();
}

} // namespace

SavedEngine save_engine(const Engine& engine) {
    return {static_cast<const EngineState&>(engine), save_state(*engine.cutter)};
}

void restore_engine(Engine& engine, const SavedEngine& saved) {
    static_cast<EngineState&>(engine) = saved.state;
    restore_state(*engine.cutter, *saved.cutter);
}

void remember_stroke(Engine& engine) {
    engine.strokes.push_back(save_engine(engine));
    std::size_t bytes = 0;
    std::size_t kept = 0;
    while (kept < engine.strokes.size() && kept < strokes_at_most) {
        bytes += bytes_of(engine.strokes[engine.strokes.size() - 1 - kept]);
        if (kept > 0 && bytes > bytes_at_most) { break; }
        ++kept;
    }
    engine.strokes.erase(engine.strokes.begin(), engine.strokes.end() - static_cast<std::ptrdiff_t>(kept));
}

bool undo_stroke(Engine& engine) {
    if (engine.strokes.empty()) { return false; }
    restore_engine(engine, engine.strokes.back());
    engine.strokes.pop_back();
    return true;
}

} // namespace resect
