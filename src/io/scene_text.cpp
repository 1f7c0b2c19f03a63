// SPDX-License-Identifier: Apache-2.0
#include "io/scene_text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <set>

#include "io/nearest_name.hpp"
#include "io/refuse.hpp"
#include "io/scene_schema.hpp"

// The schema drives the reading: it completes the scene with its defaults and checks keys, types and ranges;
// only what a schema cannot say is checked here by hand.
namespace resect {

namespace {

using nlohmann::json;

/// A value of the scene, by the words that a person would use to point at it.
struct Place {
    std::string_view file = {};
    std::string path = {};

    Place key(const std::string& name) const { return {file, path.empty() ? name : path + "." + name}; }
    Place item(std::size_t index) const { return {file, fmt::format("{}[{}]", path, index)}; }
    [[noreturn]] void refuse(const std::string& why) const {
        resect::refuse(path.empty() ? fmt::format("{}: {}", file, why)
                                    : fmt::format("{}: {}: {}", file, path, why));
    }
};

// ---- text to JSON

/// "line:column" of a byte.
std::string position_in(std::string_view text, std::size_t byte) {
    const std::string_view before = text.substr(0, std::min(byte > 0 ? byte - 1 : 0, text.size()));
    const auto lines = std::count(before.begin(), before.end(), '\n');
    const std::size_t line_start = before.rfind('\n') + 1; // npos + 1 is 0
    return fmt::format("{}:{}", lines + 1, before.size() - line_start + 1);
}

/// What the parser says, without its own names and positions.
std::string plain_words(std::string_view what) {
    const std::size_t name_end = what.find("] ");
    if (name_end != std::string_view::npos) { what.remove_prefix(name_end + 2); }
    const std::size_t position_end = what.find("column ");
    const std::size_t colon = what.find(": ", position_end == std::string_view::npos ? 0 : position_end);
    if (position_end != std::string_view::npos && colon != std::string_view::npos) {
        what.remove_prefix(colon + 2);
    }
    std::string words;
    for (const char c : what) {
        words += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
    }
    return words;
}

/// Refuses an object that says a key twice, which a reader of JSON would take from either place.
json parse_once_each(std::string_view text, const Place& place) {
    std::vector<std::set<std::string>> seen;
    const auto watch = [&](int, json::parse_event_t event, json& value) {
        if (event == json::parse_event_t::object_start) { seen.emplace_back(); }
        if (event == json::parse_event_t::object_end) { seen.pop_back(); }
        if (event == json::parse_event_t::key && !seen.back().insert(value.get<std::string>()).second) {
            place.refuse(fmt::format("the key {} stands twice in one object; keep one", value.dump()));
        }
        return true;
    };
    return json::parse(text.begin(), text.end(), watch);
}

json parse_text(std::string_view text, const Place& place) {
    try {
        return parse_once_each(text, place);
    } catch (const json::parse_error& error) {
        refuse(fmt::format("{}:{}: not JSON: {}", place.file, position_in(text, error.byte),
                           plain_words(error.what())));
    } catch (const json::exception& error) { place.refuse("not JSON: " + plain_words(error.what())); }
}

// ---- overrides

struct Override {
    std::vector<std::string> steps = {}; // keys and indices from the root
    std::string value = {};
};

/// "a.b[2].c=v" and "a.b.2.c=v" alike.
Override parse_override(const std::string& text, const Place& place) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0) {
        place.refuse(fmt::format("override '{}': write key=value, as in tissue.damping=1", text));
    }
    Override result{{}, text.substr(equals + 1)};
    std::string step;
    for (const char c : text.substr(0, equals) + '.') {
        const bool ends = c == '.' || c == '[' || c == ']';
        if (!ends) { step += c; }
        if (ends && !step.empty()) { result.steps.push_back(std::exchange(step, {})); }
    }
    return result;
}

json& item_of(json& array, const std::string& step, const Place& place) {
    std::size_t index = 0;
    const auto [end, failure] = std::from_chars(step.data(), step.data() + step.size(), index);
    if (failure != std::errc{} || end != step.data() + step.size() || index >= array.size()) {
        place.refuse(fmt::format("an override asks for item '{}' of {}; count from 0", step, array.size()));
    }
    return array[index];
}

void apply_override(json& scene, const std::string& text, const Place& root) {
    const Override change = parse_override(text, root);
    json* target = &scene;
    Place place = root;
    for (const std::string& step : change.steps) {
        if (target->is_array()) {
            target = &item_of(*target, step, place);
            place.path += "[" + step + "]";
            continue;
        }
        if (target->is_null() || target->is_boolean()) { *target = json::object(); }
        if (!target->is_object()) {
            place.refuse("an override asks for '" + step + "' inside a plain value");
        }
        target = &(*target)[step];
        place = place.key(step);
    }
    json value = json::parse(change.value, nullptr, false);
    *target = value.is_discarded() ? json(change.value) : std::move(value);
}

// ---- the schema at work

void fill_defaults(json& value, const json& schema) {
    if (value.is_object() && schema.contains("properties")) {
        for (const auto& [key, property] : schema["properties"].items()) {
            if (!value.contains(key) && property.contains("default")) { value[key] = property["default"]; }
            if (value.contains(key)) { fill_defaults(value[key], property); }
        }
    }
    if (value.is_array() && schema.contains("items")) {
        for (json& item : value) {
            fill_defaults(item, schema["items"]);
        }
    }
}

/// As a person would say it.
std::string list_of(const json& names, std::string_view last_link) {
    std::string list;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (i > 0) { list += i + 1 == names.size() ? fmt::format(" {} ", last_link) : ", "; }
        list += names[i].is_string() ? names[i].get<std::string>() : names[i].dump();
    }
    return list;
}

std::string shown(const json& value) {
    constexpr std::size_t most = 40;
    const std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
    return text.size() <= most ? text : text.substr(0, most) + "...";
}

bool is_of_type(const json& value, const std::string& type) {
    if (type == "integer") {
        return value.is_number_integer() ||
               (value.is_number_float() && std::trunc(value.get<double>()) == value);
    }
    return type == "number" ? value.is_number() : type == value.type_name();
}

void check_type(const json& value, const json& schema, const Place& place) {
    if (!schema.contains("type")) { return; }
    const json types = schema["type"].is_array() ? schema["type"] : json::array({schema["type"]});
    for (const json& type : types) {
        if (is_of_type(value, type.get<std::string>())) { return; }
    }
    place.refuse(fmt::format("is {}; give {}", shown(value), list_of(types, "or")));
}

void check_range(const json& value, const json& schema, const Place& place) {
    const double number = value.get<double>();
    const auto must = [&](const char* key, const char* words, auto holds) {
        if (schema.contains(key) && !holds(number, schema[key].get<double>())) {
            place.refuse(fmt::format("is {}; it must be {} {}", shown(value), words, schema[key].dump()));
        }
    };
    must("minimum", "at least", [](double x, double bound) { return x >= bound; });
    must("maximum", "at most", [](double x, double bound) { return x <= bound; });
    must("exclusiveMinimum", "above", [](double x, double bound) { return x > bound; });
    must("exclusiveMaximum", "below", [](double x, double bound) { return x < bound; });
}

void check_enum(const json& value, const json& schema, const Place& place) {
    if (!schema.contains("enum")) { return; }
    const json& choices = schema["enum"];
    if (std::find(choices.begin(), choices.end(), value) == choices.end()) {
        place.refuse(fmt::format("is {}; choose {}", shown(value), list_of(choices, "or")));
    }
}

void check_size(const json& value, const json& schema, const Place& place) {
    const std::size_t least = schema.value("minItems", std::size_t{0});
    const std::size_t most = schema.value("maxItems", value.size());
    if (least <= value.size() && value.size() <= most) { return; }
    place.refuse(
        fmt::format("has {} items; give {}{}", value.size(), least == most ? "" : "at least ", least));
}

void check_keys_known(const json& value, const json& schema, const Place& place) {
    std::vector<std::string> known;
    for (const auto& [key, property] : schema["properties"].items()) {
        known.push_back(key);
    }
    for (const auto& [key, item] : value.items()) {
        if (std::find(known.begin(), known.end(), key) != known.end()) { continue; }
        const std::string near = nearest_name(key, known);
        place.key(key).refuse(near.empty() ? "unknown; known here: " + list_of(known, "and")
                                           : fmt::format("unknown; did you mean {}?", near));
    }
}

void check_keys_present(const json& value, const json& schema, const Place& place) {
    for (const json& key : schema.value("required", json::array())) {
        if (!value.contains(key.get<std::string>())) {
            place.refuse(fmt::format("{} is missing; add it", key.get<std::string>()));
        }
    }
    json alternatives = json::array();
    if (schema.contains("oneOf")) {
        for (const json& choice : schema["oneOf"]) {
            alternatives.push_back(choice["required"][0]);
        }
    } else if (schema.contains("maxProperties")) {
        for (const auto& [key, property] : schema["properties"].items()) {
            alternatives.push_back(key);
        }
    }
    const auto given = std::count_if(alternatives.begin(), alternatives.end(),
                                     [&](const json& key) { return value.contains(key.get<std::string>()); });
    if (!alternatives.empty() && given != 1) {
        place.refuse(fmt::format("holds {} of {}; give exactly one", given == 0 ? "none" : "several",
                                 list_of(alternatives, "and")));
    }
}

void check(const json& value, const json& schema, const Place& place) {
    check_type(value, schema, place);
    check_enum(value, schema, place);
    if (value.is_number()) { check_range(value, schema, place); }
    if (value.is_object()) {
        check_keys_known(value, schema, place);
        check_keys_present(value, schema, place);
        for (const auto& [key, item] : value.items()) {
            check(item, schema["properties"][key], place.key(key));
        }
    }
    if (value.is_array()) {
        check_size(value, schema, place);
        for (std::size_t i = 0; i < value.size(); ++i) {
            check(value[i], schema["items"], place.item(i));
        }
    }
}

// ---- JSON that has been checked to structs

Edge edge_of(const json& key) { return {key["heel"].get<Vec3>(), key["tip"].get<Vec3>()}; }

std::vector<BladeKey> blade_of(const json& path, const Place& place) {
    std::vector<BladeKey> keys;
    for (const json& key : path) {
        const Place here = place.item(keys.size());
        keys.push_back({key["time"].get<double>(), edge_of(key)});
        if (keys.back().edge.heel == keys.back().edge.tip) {
            here.refuse("heel and tip are one point; a blade needs an edge between them");
        }
        if (keys.size() > 1 && !(keys[keys.size() - 2].time < keys.back().time)) {
            here.key("time").refuse(fmt::format("is {} after {}; times must increase", keys.back().time,
                                                keys[keys.size() - 2].time));
        }
    }
    return keys;
}

Box box_of(const json& value, const Place& place) {
    const Box box{value["lo"].get<Vec3>(), value["hi"].get<Vec3>()};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (box.lo[axis] > box.hi[axis]) {
            place.refuse(fmt::format("lo {} lies above hi {} along {}; exchange them", box.lo[axis],
                                     box.hi[axis], "xyz"[axis]));
        }
    }
    return box;
}

Material material_of(const json& value) {
    return {.law = Law::neo_hookean,
            .young = value["young"].get<double>(),
            .poisson = value["poisson"].get<double>(),
            .density = value["density"].get<double>(),
            .viscous_time = value.value("viscous_time", automatic)};
}

Lattice lattice_of(const json& value) {
    return {value.value("elements", Index{0}), value.value("spacing", 0.0), value["refine"].get<int>()};
}

decltype(SceneDescription::mesh) mesh_of(const json& mesh) {
    if (mesh.contains("liver")) { return LiverSource{lattice_of(mesh["liver"])}; }
    if (mesh.contains("kidney")) { return KidneySource{lattice_of(mesh["kidney"])}; }
    if (mesh.contains("block")) {
        const json& block = mesh["block"];
        return BlockSource{block["size"].get<Vec3>(), block["cells"].get<std::array<Index, 3>>(),
                           block["split"] == "bcc" ? Split::bcc : Split::six};
    }
    return FileSource{mesh["file"].get<std::string>()};
}

void read_tissue(const json& tissue, const Place& place, SceneDescription& description) {
    Setup& setup = description.scene.setup;
    description.mesh = mesh_of(tissue["mesh"]);
    setup.materials.clear();
    for (const json& material : tissue["materials"]) {
        setup.materials.push_back(material_of(material));
    }
    setup.damping = tissue["damping"].get<double>();
    for (const json& fixed : tissue["fixed"]) {
        const Place here = place.key("fixed").item(setup.fixed.size()).key("box");
        setup.fixed.push_back({fixed.value("node_set", std::string()),
                               fixed.contains("box") ? box_of(fixed["box"], here) : Box{}});
        if (fixed.contains("node_set") && setup.fixed.back().node_set.empty()) {
            place.key("fixed").item(setup.fixed.size() - 1).refuse("node_set is empty; name a node set");
        }
    }
    for (const json& load : tissue["loads"]) {
        setup.loads.emplace_back(load["node"].get<Index>(), load["force"].get<Vec3>());
    }
    description.initial_stretch = tissue["initial"]["stretch"].get<Vec3>();
    description.initial_displacement = tissue["initial"]["displacement"].get<std::string>();
    description.initial_velocity = tissue["initial"]["velocity"].get<std::string>();
    const bool moves = !description.initial_displacement.empty() || !description.initial_velocity.empty();
    if (moves && !std::holds_alternative<FileSource>(description.mesh)) {
        place.key("initial").refuse("names arrays of a mesh file, but the mesh is no file; take it out");
    }
    if (description.initial_stretch != Vec3{1, 1, 1} && !description.initial_displacement.empty()) {
        place.key("initial").refuse("has both stretch and displacement; give one");
    }
}

CutOptions cut_of(const json& value) {
    CutOptions cut;
    cut.weights = value["weights"] == "copy" ? Weights::copy : Weights::fraction;
    cut.quantities = value["quantities"] == "recompute"       ? Quantities::recompute
                     : value["quantities"] == "recompute_all" ? Quantities::recompute_all
                                                              : Quantities::copy;
    cut.front = value["front"] == "hold" ? Front::hold : Front::soft;
    cut.refine = value["refine"].get<int>();
    cut.verify = value["verify"].get<bool>();
    return cut;
}

SceneDescription description_of(const json& value, const Place& root) {
    SceneDescription description;
    Scene& scene = description.scene;
    scene.name = value["name"].get<std::string>();
    scene.description = value["description"].get<std::string>();
    read_tissue(value["tissue"], root.key("tissue"), description);
    scene.setup.gravity = value["gravity"].get<Vec3>();
    scene.setup.cut = cut_of(value["cut"]);
    scene.setup.time_step = value["time_step"].get<double>();
    scene.setup.allow_unstable_step = value["allow_unstable_step"].get<bool>();
    scene.settle = value["settle"] != false;
    if (value["settle"].is_object()) {
        scene.settling = {value["settle"]["residual"].get<double>(),
                          value["settle"]["at_most"].get<double>()};
    }
    for (const json& blade : value["blades"]) {
        const Place here = root.key("blades").item(scene.blades.size()).key("path");
        scene.blades.push_back(blade_of(blade["path"], here));
    }
    scene.duration = value["duration"].get<double>();
    scene.output_every = value["out"]["every"].get<double>();
    return description;
}

} // namespace

Result<SceneDescription> parse_scene(std::string_view text, const std::string& name,
                                     std::span<const std::string> overrides) {
    return read_or_refuse([&] {
        const Place root{name};
        const json schema = json::parse(scene_schema);
        json scene = parse_text(text, root);
        fill_defaults(scene, schema);
        for (const std::string& change : overrides) {
            apply_override(scene, change, root);
        }
        fill_defaults(scene, schema);
        check(scene, schema, root);
        return description_of(scene, root);
    });
}

} // namespace resect
