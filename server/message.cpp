// SPDX-License-Identifier: Apache-2.0
#include "message.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <utility>

#include "frame.hpp"

namespace server {

namespace {

using Json = nlohmann::ordered_json;
using resect::Error;
using resect::Result;

constexpr double least_speed = 0.01, most_speed = 4;
constexpr Index most_steps = 1000;
constexpr int deepest = 16; // brackets within brackets: what walks a value later calls itself

Result<double> read_number(const Json& value, double least, double most) {
    if (value.is_number()) {
        const auto number = value.get<double>();
        if (least <= number && number <= most) { return number; }
    }
    return Error{fmt::format("give a number from {:g} to {:g}", least, most)};
}

Result<std::int64_t> read_whole(const Json& value, std::int64_t least, std::int64_t most) {
    // A whole number that does not fit is read as unsigned, or as a float.
    const bool fits = value.is_number_integer() &&
                      (!value.is_number_unsigned() || value.get<std::uint64_t>() <= std::uint64_t{INT64_MAX});
    if (fits && least <= value.get<std::int64_t>() && value.get<std::int64_t>() <= most) {
        return value.get<std::int64_t>();
    }
    return Error{fmt::format("give a whole number from {} to {}", least, most)};
}

/// Answers `made` where the value is true.
Result<Request> ask(const Json& value, Request made) {
    if (value.is_boolean() && value.get<bool>()) { return made; }
    return Error{"give true"};
}

Result<Request> read_command(const Json& value) {
    Result<resect::Command> command = resect::parse_command(value.dump());
    if (!command) { return command.error(); }
    return Request{Tell{std::move(*command)}};
}

Result<Request> read_pause(const Json& value) {
    if (!value.is_boolean()) { return Error{"give true or false"}; }
    return Request{Pause{value.get<bool>()}};
}

Result<Request> read_step(const Json& value) {
    const Result<std::int64_t> steps = read_whole(value, 1, most_steps);
    if (!steps) { return steps.error(); }
    return Request{TakeSteps{static_cast<Index>(*steps)}};
}

Result<Request> read_speed(const Json& value) {
    const Result<double> speed = read_number(value, least_speed, most_speed);
    if (!speed) { return speed.error(); }
    return Request{SetSpeed{*speed}};
}

Result<Request> read_scene(const Json& value) {
    if (!value.is_string()) { return Error{"give the name of a scene"}; }
    return Request{StartScene{value.get<std::string>()}};
}

Result<Request> read_reset(const Json& value) { return ask(value, Reset{}); }

Result<Request> read_show(const Json& value) {
    Show show;
    if (!value.is_object()) { return Error{R"(give an object, as in {"stress": true})"}; }
    for (const auto& [key, wanted] : value.items()) {
        if (!wanted.is_boolean() || (key != "stress" && key != "elements")) {
            return Error{"give stress and elements, true or false"};
        }
        (key == "stress" ? show.stress : show.elements) = wanted.get<bool>();
    }
    return Request{show};
}

Result<Request> read_save(const Json& value) {
    static constexpr std::array<const char*, 5> endings = {".obj", ".stl", ".ply", ".vtp", ".vtu"};
    const std::string what = value.is_string() ? value.get<std::string>() : "";
    const bool is_file =
        safe_name(what) == what && std::any_of(endings.begin(), endings.end(),
                                               [&](const char* ending) { return what.ends_with(ending); });
    if (what == "record" || is_file) { return Request{Save{what}}; }
    return Error{R"(give "record", or a file name that ends in .obj .stl .ply .vtp or .vtu)"};
}

Result<Request> read_hash(const Json& value) { return ask(value, AskHash{}); }

Result<Request> read_drive(const Json& value) { return ask(value, Drive{}); }

Result<Request> read_seen(const Json& value) {
    const Result<std::int64_t> frame = read_whole(value, 0, UINT32_MAX);
    if (!frame) { return frame.error(); }
    return Request{Seen{static_cast<std::uint32_t>(*frame)}};
}

struct Key {
    const char* name = nullptr;
    Result<Request> (*read)(const Json& value) = nullptr;
};
constexpr std::array<Key, 11> keys = {{{"command", read_command},
                                       {"pause", read_pause},
                                       {"step", read_step},
                                       {"speed", read_speed},
                                       {"scene", read_scene},
                                       {"reset", read_reset},
                                       {"show", read_show},
                                       {"save", read_save},
                                       {"hash", read_hash},
                                       {"drive", read_drive},
                                       {"seen", read_seen}}};

/// Counts brackets in names and texts, too, where no command has any.
bool is_deep(const std::string& text) {
    int depth = 0;
    for (const char c : text) {
        depth += c == '[' || c == '{' ? 1 : 0;
        depth -= c == ']' || c == '}' ? 1 : 0;
        if (depth > deepest) { return true; }
    }
    return false;
}

/// What the page sent, where it is to be quoted: short, and without what a terminal would obey.
std::string quote(const std::string& name) {
    std::string shown;
    for (const char c : name.substr(0, 40)) {
        shown += std::isprint(static_cast<unsigned char>(c)) != 0 ? c : '?';
    }
    return shown;
}

Parsed read_request(Index id, const std::string& name, const Json& value) {
    const auto* key =
        std::find_if(keys.begin(), keys.end(), [&](const Key& one) { return name == one.name; });
    if (key == keys.end()) {
        std::string known;
        for (const Key& one : keys) {
            known += fmt::format("{}{}", known.empty() ? "" : ", ", one.name);
        }
        return Refusal{id, fmt::format("'{}' is unknown; give one of {}", quote(name), known)};
    }
    Result<Request> request = key->read(value);
    if (!request) { return Refusal{id, fmt::format("{}: {}", key->name, request.error().message)}; }
    return Message{id, std::move(*request)};
}

} // namespace

Parsed parse_text(const std::string& text) {
    if (is_deep(text)) { return Refusal{0, "a message has few brackets within brackets; this has many"}; }
    const Json value = Json::parse(text, nullptr, false);
    if (!value.is_object()) { return Refusal{0, "a message is one JSON object; this is none"}; }
    Index id = 0;
    const auto told = value.find("id");
    if (told != value.end()) {
        const Result<std::int64_t> whole = read_whole(*told, 1, INT32_MAX);
        if (!whole) { return Refusal{0, fmt::format("id: {}", whole.error().message)}; }
        id = static_cast<Index>(*whole);
    }
    if (value.size() != (id == 0 ? 1U : 2U)) {
        return Refusal{id, "a message has an id and one other key, as in {\"id\": 1, \"pause\": true}"};
    }
    const auto asked = std::find_if(value.items().begin(), value.items().end(),
                                    [](const auto& item) { return item.key() != "id"; });
    if (asked == value.items().end()) { return Refusal{id, "a message has a key beside its id"}; }
    Parsed parsed = read_request(id, asked.key(), asked.value());
    const auto* message = std::get_if<Message>(&parsed);
    if (message != nullptr && id == 0 && !std::holds_alternative<Seen>(message->request)) {
        return Refusal{0, "a message has an id, a whole number from 1"};
    }
    return parsed;
}

Parsed parse_binary(std::string_view bytes) {
    Result<Upload> upload = parse_upload(bytes);
    if (!upload) { return Refusal{0, upload.error().message}; }
    const std::optional<std::string> name = safe_name(upload->name);
    if (!name) { return Refusal{0, "the file's name has no letter or digit; rename it"}; }
    upload->name = *name;
    return Message{0, std::move(*upload)};
}

bool is_for_watchers(const Request& request) {
    return std::holds_alternative<Seen>(request) || std::holds_alternative<Show>(request) ||
           std::holds_alternative<AskHash>(request) || std::holds_alternative<Drive>(request);
}

std::optional<std::string> safe_name(std::string_view path) {
    constexpr std::size_t longest = 100;
    const std::size_t slash = path.find_last_of("/\\");
    if (slash != std::string_view::npos) { path.remove_prefix(slash + 1); }
    std::string name;
    for (const char c : path.substr(path.size() > longest ? path.size() - longest : 0)) {
        const bool is_plain = std::isalnum(static_cast<unsigned char>(c)) != 0;
        if (is_plain || (!name.empty() && (c == '.' || c == '-' || c == '_'))) {
            name += c;
        } else if (!name.empty()) {
            name += '_';
        }
    }
    if (name.empty()) { return {}; }
    return name;
}

} // namespace server
