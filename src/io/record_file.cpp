// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "resect/files.hpp"
#include "resect/version.hpp"

#include "io/command_text.hpp"
#include "io/file.hpp"
#include "io/refuse.hpp"

namespace resect {

namespace {

using Json = nlohmann::ordered_json;

template <class T>
T member(const Json& value, const char* key, bool (Json::*is_right)() const noexcept, const char* words) {
    const auto found = value.find(key);
    if (found == value.end() || !((*found).*is_right)()) {
        refuse(fmt::format("{} is missing or no {}", key, words));
    }
    return found->get<T>();
}

std::int64_t step_of(const Json& value, const char* key) {
    const auto step = member<std::int64_t>(value, key, &Json::is_number_integer, "whole number");
    if (step < 0) { refuse(fmt::format("{} is {}; steps count from 0", key, step)); }
    return step;
}

Json json_of(const Recorded& recorded) {
    Json json = {{"step", recorded.step}, {"until", recorded.until}};
    json.update(json_of(recorded.command));
    return json;
}

Recorded recorded_of(Json value) {
    Recorded recorded;
    recorded.step = step_of(value, "step");
    recorded.until = step_of(value, "until");
    value.erase("step");
    value.erase("until");
    recorded.command = command_of(value);
    return recorded;
}

std::vector<Recorded> commands_of(const Json& value) {
    std::vector<Recorded> commands;
    for (const Json& item : value) {
        const Result<Recorded> read = read_or_refuse([&] { return recorded_of(item); });
        if (!read) { refuse(fmt::format("commands[{}]: {}", commands.size(), read.error().message)); }
        commands.push_back(*read);
    }
    return commands;
}

Record record_of(const Json& value) {
    if (!value.is_object()) { refuse("a record is one JSON object"); }
    Record record;
    record.scene = member<std::string>(value, "scene", &Json::is_string, "path");
    for (const Json& change : member<Json>(value, "overrides", &Json::is_array, "array")) {
        if (!change.is_string()) { refuse("overrides: give texts, as in \"tissue.damping=1\""); }
        record.overrides.push_back(change.get<std::string>());
    }
    record.commands = commands_of(member<Json>(value, "commands", &Json::is_array, "array"));
    record.steps = step_of(value, "steps");
    const auto hash = member<std::string>(value, "state_hash", &Json::is_string, "text");
    char* end = nullptr;
    record.hash = std::strtoull(hash.c_str(), &end, 16);
    if (hash.empty() || *end != '\0') { refuse("state_hash must be 16 hexadecimal digits"); }
    return record;
}

} // namespace

Result<void> write_record(const std::string& path, const Record& record) {
    std::string text =
        fmt::format("{{\n\"resect_version\": {},\n\"scene\": {},\n\"overrides\": {},\n\"commands\": [",
                    Json(version).dump(), Json(record.scene).dump(), Json(record.overrides).dump());
    for (std::size_t i = 0; i < record.commands.size(); ++i) { // a line each, for people and diffs
        text += fmt::format("{}\n{}", i > 0 ? "," : "", json_of(record.commands[i]).dump());
    }
    text += fmt::format("\n],\n\"steps\": {},\n\"state_hash\": \"{:016x}\"\n}}\n", record.steps, record.hash);
    return write_file(path, text);
}

/// The scene's path counts from the record's folder, so that both may move together.
Result<void> write_record(const std::string& path, const std::string& scene,
                          std::span<const std::string> overrides, const Simulation& simulation) {
    const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
    const std::span<const Recorded> commands = simulation.record();
    return write_record(
        path, {.scene = std::filesystem::absolute(scene).lexically_relative(folder).generic_string(),
               .overrides = {overrides.begin(), overrides.end()},
               .commands = {commands.begin(), commands.end()},
               .steps = simulation.steps(),
               .hash = simulation.hash()});
}

Result<Record> load_record(const std::string& path) {
    return read_or_refuse([&] {
        const Json value = Json::parse(read_file(path), nullptr, false);
        if (value.is_discarded()) { refuse(path + ": not JSON; give a record that resect has written"); }
        Result<Record> record = read_or_refuse([&] { return record_of(value); });
        if (!record) { refuse(path + ": " + record.error().message); }
        record->scene = beside(path, record->scene);
        return std::move(*record);
    });
}

} // namespace resect
