// SPDX-License-Identifier: Apache-2.0
#include "cut/transaction.hpp"

namespace resect {
namespace {

/// Calls visit for everything that an increment changes.
template <class Visit>
void each_container(CutterState& state, Visit visit) {
    each_rows(state, visit);
    for (Blade& blade : state.blades) {
        if (!blade.placed) { continue; }
        visit(blade.pending);
        visit(blade.sheet);
    }
}

} // namespace
void open_state(CutterState& state) {
    each_container(state, [](auto& container) { container.open(); });
}

void close_state(CutterState& state) {
    each_container(state, [](auto& container) { container.close(); });
}

void take_back_state(CutterState& state) {
    each_container(state, [](auto& container) { container.take_back(); });
}

} // namespace resect
