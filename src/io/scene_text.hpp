// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "resect/files.hpp"

namespace resect {

struct LiverSource {
    Lattice lattice = {};
};
struct KidneySource {
    Lattice lattice = {};
};
struct BlockSource {
    Vec3 size = {};
    std::array<Index, 3> cells = {};
    Split split = Split::six;
};
struct FileSource {
    std::string path = {}; // as the scene names it
};

/// What a scene file says, before any body is built.
struct SceneDescription {
    std::variant<LiverSource, KidneySource, BlockSource, FileSource> mesh = {};
    Vec3 initial_stretch = {1, 1, 1}; // about the origin
    std::string initial_displacement = {},
                initial_velocity = {}; // point arrays of the mesh file; empty: none
    Scene scene = {};                  // with no body and no initial motion yet
};

/// `name` begins the messages.
Result<SceneDescription> parse_scene(std::string_view text, const std::string& name,
                                     std::span<const std::string> overrides = {});

} // namespace resect
