// SPDX-License-Identifier: Apache-2.0
#include "io/command_text.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <nlohmann/json.hpp>

#include "resect/files.hpp"

#include "base/command_fields.hpp"
#include "io/nearest_name.hpp"
#include "io/refuse.hpp"

namespace resect {

namespace {

using Json = nlohmann::ordered_json;

// ---- reading: what a value must be, in words, and whether it is

const char* words_for(Index) { return "a whole number"; }
const char* words_for(double) { return "a number"; }
const char* words_for(bool) { return "true or false"; }
const char* words_for(const Vec3&) { return "three numbers"; }
const char* words_for(const std::vector<Index>&) { return "whole numbers"; }
const char* words_for(const std::vector<Vec3>&) { return "rows of three numbers"; }

bool read(const Json& from, Index& to) {
    if (!from.is_number_integer()) { return false; }
    constexpr std::int64_t most = std::numeric_limits<Index>::max();
    const bool is_huge = from.is_number_unsigned() && from.get<std::uint64_t>() > std::uint64_t{most};
    const auto value = from.get<std::int64_t>();
    to = static_cast<Index>(value);
    return !is_huge && -most <= value && value <= most;
}
bool read(const Json& from, double& to) {
    if (from.is_number()) { to = from.get<double>(); }
    return from.is_number();
}
bool read(const Json& from, bool& to) {
    if (from.is_boolean()) { to = from.get<bool>(); }
    return from.is_boolean();
}
bool read(const Json& from, Vec3& to) {
    if (!from.is_array() || from.size() != 3) { return false; }
    return read(from[0], to[0]) && read(from[1], to[1]) && read(from[2], to[2]);
}
template <class T>
bool read(const Json& from, std::vector<T>& to) {
    if (!from.is_array()) { return false; }
    to.resize(from.size());
    for (std::size_t i = 0; i < to.size(); ++i) {
        if (!read(from[i], to[i])) { return false; }
    }
    return true;
}

[[noreturn]] void refuse_name(const std::string& where, const std::string& name,
                              const std::vector<std::string>& known) {
    const std::string near = nearest_name(name, known);
    refuse(fmt::format("{}'{}' is unknown; {}", where, name,
                       near.empty() ? fmt::format("give one of {}", fmt::join(known, ", "))
                                    : fmt::format("did you mean {}?", near)));
}

template <class One>
void read_fields(const std::string& name, const Json& value, One& one) {
    if (!value.is_object()) { refuse(fmt::format("{}: give an object of its fields", name)); }
    std::vector<std::string> known;
    each_field(one, [&](const char* field, auto& to, Need need) {
        known.emplace_back(field);
        const auto found = value.find(field);
        if (found == value.end() && need == Need::must) {
            refuse(fmt::format("{}: {} is missing; give {}", name, field, words_for(to)));
        }
        if (found != value.end() && !read(*found, to)) {
            refuse(fmt::format("{}: {} must be {}", name, field, words_for(to)));
        }
    });
    for (const auto& [field, ignored] : value.items()) {
        if (std::find(known.begin(), known.end(), field) == known.end()) {
            refuse_name(name + ": ", field, known);
        }
    }
}

} // namespace

Json json_of(const Command& command) {
    Json fields = Json::object();
    std::visit(
        [&](auto one) { // a copy: reading and writing share each_field()
            each_field(one, [&](const char* field, const auto& from, Need) { fields[field] = from; });
        },
        command);
    return {{command_names[command.index()], fields}};
}

Command command_of(const Json& value) {
    if (!value.is_object() || value.size() != 1) {
        refuse(R"(a command is an object with one name, as in {"undo": {}})");
    }
    const auto found = std::find(command_names.begin(), command_names.end(), value.begin().key());
    if (found == command_names.end()) {
        refuse_name("command ", value.begin().key(), {command_names.begin(), command_names.end()});
    }
    Command command = make_command(static_cast<std::size_t>(found - command_names.begin()));
    std::visit([&](auto& one) { read_fields(*found, value.begin().value(), one); }, command);
    return command;
}

std::string format_command(const Command& command) { return json_of(command).dump(); }

Result<Command> parse_command(const std::string& text) {
    return read_or_refuse([&] {
        const Json value = Json::parse(text, nullptr, false);
        if (value.is_discarded()) { refuse("a command is one JSON object; this is no JSON"); }
        return command_of(value);
    });
}

} // namespace resect
