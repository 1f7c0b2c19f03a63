// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "resect/resect.hpp"

namespace server {

using resect::Index;

/// What a page asks for (docs/protocol.md, "From the page").
struct Tell {
    resect::Command command = {};
};
struct Pause {
    bool paused = false;
};
struct TakeSteps {
    Index steps = 0;
};
struct SetSpeed {
    double speed = 1;
};
struct StartScene {
    std::string name = {};
};
struct Reset {};
struct Show {
    bool stress = false, elements = false;

    bool operator==(const Show&) const = default;
};
struct Save {
    std::string what = {}; // "record", or the name of a file
};
struct AskHash {};
struct Drive {};
struct Seen {
    std::uint32_t frame = 0;
};
/// A body in the bytes of a mesh file, by the ending of its name.
struct Upload {
    std::string name = {}, bytes = {};
};

using Request = std::variant<Tell, Pause, TakeSteps, SetSpeed, StartScene, Reset, Show, Save, AskHash, Drive,
                             Seen, Upload>;

struct Message {
    Index id = 0; // of the page's choice; 0: none
    Request request = {};
};

/// A refusal and the id it answers.
struct Refusal {
    Index id = 0;
    std::string message = {};
};

using Parsed = std::variant<Message, Refusal>;

Parsed parse_text(const std::string& text);
/// An upload.
Parsed parse_binary(std::string_view bytes);

/// Whether a watcher may ask it, too.
bool is_for_watchers(const Request& request);

/// The last part of a path that a page has sent, if it can name a file: letters, digits, and ._- that do not
/// lead.
std::optional<std::string> safe_name(std::string_view path);

} // namespace server
