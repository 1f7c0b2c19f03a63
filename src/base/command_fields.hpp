// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <variant>

#include "resect/commands.hpp"

// What commands consist of, once for texts and for snapshots.
namespace resect {

/// In the order of Command.
inline constexpr std::array<const char*, std::variant_size_v<Command>> command_names = {
    "move_blade", "lift_blade", "prescribe", "set_gravity", "undo",
    "grasp",      "move_grasp", "release",   "set_material"};

enum class Need { must, may };

// The fields of each command, once for reading and writing.
template <class Visit>
void each_field(MoveBlade& move, Visit visit) {
    visit("blade", move.blade, Need::may);
    visit("heel", move.to.heel, Need::must);
    visit("tip", move.to.tip, Need::must);
}
template <class Visit>
void each_field(LiftBlade& lift, Visit visit) {
    visit("blade", lift.blade, Need::may);
    visit("complete", lift.complete, Need::may);
}
template <class Visit>
void each_field(Prescribe& told, Visit visit) {
    visit("nodes", told.nodes, Need::must);
    visit("displacement", told.displacement, Need::may);
}
template <class Visit>
void each_field(SetGravity& set, Visit visit) {
    visit("gravity", set.gravity, Need::must);
}
template <class Visit>
void each_field(Undo&, Visit) {}
template <class Visit>
void each_field(Grasp& told, Visit visit) {
    visit("grasp", told.grasp, Need::may);
    visit("at", told.at, Need::must);
    visit("radius", told.radius, Need::must);
}
template <class Visit>
void each_field(MoveGrasp& move, Visit visit) {
    visit("grasp", move.grasp, Need::may);
    visit("to", move.to, Need::must);
}
template <class Visit>
void each_field(Release& told, Visit visit) {
    visit("grasp", told.grasp, Need::may);
}

template <class Visit>
void each_field(SetMaterial& set, Visit visit) {
    visit("region", set.region, Need::may);
    visit("young", set.material.young, Need::must);
    visit("poisson", set.material.poisson, Need::must);
    visit("density", set.material.density, Need::must);
    visit("viscous_time", set.material.viscous_time, Need::may);
}

/// The command of a row of `command_names`, with its defaults; Undo for any other.
template <std::size_t Kind = 0>
Command make_command(std::size_t kind) {
    if constexpr (Kind == std::variant_size_v<Command>) {
        return Undo{};
    } else {
        return kind == Kind ? Command(std::in_place_index<Kind>) : make_command<Kind + 1>(kind);
    }
}

} // namespace resect
